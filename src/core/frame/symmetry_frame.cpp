#include "pcl_symmetry/core/symmetry_frame.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/base/check.h"
#include "core/base/constants.h"
#include "core/base/parallel.h"
#include "core/base/stopwatch.h"
#include "core/detection/scan_axes.h"
#include "core/frame/canonical_frame.h"
#include "core/frame/frame_evidence.h"
#include "core/frame/frame_search.h"
#include "core/frame/leveled_frames.h"
#include "core/frame/probable_frames.h"
#include "pcl_symmetry/core/planar_transform.h"

namespace pcl_symmetry {

namespace {

/// Axes of rotation of a scan; the axes of its frame are tried first.
std::vector<SymmetryTurn> turnsAlong(const SymmetryFrame& frame, const PointsRef& points, const GaussianEdt& edt,
                                     const FrameOptions& options, const Visibility& visibility,
                                     const MakeSearch& make_search) {
  DetectionOptions detection;
  detection.seed = options.seed;
  detection.num_threads = options.num_threads;
  std::vector<SymmetryAxis> axes(3);
  for (int k = 0; k < 3; ++k) {
    axes[static_cast<std::size_t>(k)].point = frame.center;
    axes[static_cast<std::size_t>(k)].direction = frame.axes.col(k);
  }
  return turnsOfScan(points, edt, visibility, axes, detection, make_search);
}

/// The frame itself, then the others by falling probability.
std::vector<ProbableFrame> probableFrames(const FrameEvidence& evidence, const SymmetryFrame& frame,
                                          const std::vector<FrameChoice>& choices) {
  const std::vector<double> probabilities = frameProbabilities(choices, frameWeights(evidence.scanned()));
  std::vector<ProbableFrame> probable;
  for (std::size_t i = 0; i < choices.size(); ++i) {
    const FrameChoice& choice = choices[i];
    ProbableFrame entry{frame.center, frame.axes, choice.revolution_axis, probabilities[i], {}};
    if (i > 0) {
      entry.center = centerOfSymmetry(evidence, choice.frame);
      entry.axes = principalSymmetryAxes(evidence.points(), choice.frame.axes);
    }
    std::copy(choice.terms.data(), choice.terms.data() + choice.terms.size(), entry.evidence.begin());
    probable.push_back(entry);
  }
  if (!probable.empty())
    std::stable_sort(probable.begin() + 1, probable.end(),
                     [](const ProbableFrame& a, const ProbableFrame& b) { return a.probability > b.probability; });
  return probable;
}

}  // namespace

void FrameOptions::validate() const {
  edtOptionsOf(*this).validate();
  check(num_theta >= 1, "num_theta", num_theta, ">= 1");
  check(num_phi >= 2 && num_phi % 2 == 0, "num_phi", num_phi, "even and >= 2");
  check(num_radius >= 1, "num_radius", num_radius, ">= 1");
  check(num_samples >= 1, "num_samples", num_samples, ">= 1");
  check(tie >= 0.0, "tie", tie, ">= 0");
  checkNumThreads(num_threads);
}

FoundFrames findFrames(const FrameEvidence& evidence, const FrameOptions& options,
                       const std::function<void(const char*)>& done) {
  const GaussianEdt& edt = evidence.edt();
  const PlaneGrid grid(options.num_theta, options.num_phi, options.num_radius, edt.center(), edt.radius());
  SampledTransformOptions sampling;
  sampling.num_samples = options.num_samples;
  sampling.seed = options.seed;
  sampling.num_threads = options.num_threads;
  SymmetryMap map = sampledTransform(edt, grid, sampling, evidence.freeSpace());
  map.center_of_mass = centerOfMass(evidence.points());
  done("transform");

  // First plane: several candidates, as the best one depends on the frame that it leads to.
  const std::vector<CellPlane> candidates = firstPlaneCandidates(evidence, map, options.num_threads);
  done("candidates");

  // Second and third plane: perpendicular to the first, at all angles, on the completed cloud of a scan. The best
  // frames are refined as a whole.
  FoundFrames found;
  found.rotated = framesAbout(evidence, bestFirstPlanes(evidence, candidates), options.num_threads);
  found.refined = refinedFrames(evidence, frameMaxima(found.rotated), options.tie, options.num_threads);
  found.refined = leveledFirst(evidence, std::move(found.refined), options.tie);
  done("frames");
  return found;
}

SymmetryFrame symmetryFrame(const PointsRef& points, const FrameOptions& options, const Visibility* visibility,
                            const MakeSearch& make_search) {
  options.validate();
  SymmetryFrame frame;
  Stopwatch watch;
  const auto done = [&](const char* stage) { frame.timing_ms.emplace_back(stage, watch.lap()); };

  const FrameEvidence evidence(points, options, visibility);
  done("surface");
  const auto [rotated, frames] = findFrames(evidence, options, done);

  // Principal symmetry axes, center of symmetry and axis of revolution of the best frame.
  const FrameCandidate& best = frames.front();
  frame.axes = principalSymmetryAxes(points, best.axes);
  std::vector<Eigen::Vector3d> centers;
  for (const FrameCandidate& other : frames) centers.push_back(centerOfSymmetry(evidence, other));
  frame.center = meanCenter(centers, frames);
  frame.scores = best.scores.cast<double>().cwiseMin(1.0);
  frame.revolution_axis = revolutionAxis(evidence, best, options.tie);
  frame.T_canonical_input = canonicalPose(frame.axes, frame.center);

  // Equally good frames: first the maxima, then the angles between them where the second plane hardly matters.
  EquivalentFrames equivalent;
  equivalent.addWithSigns(frame.axes, frame.center);
  for (std::size_t i = 0; i < frames.size(); ++i)
    equivalent.addTied(frames[i], best.scores, options.tie, i == 0 ? frame.center : centers[i]);
  frame.num_maxima = equivalent.poses().size();
  for (const FrameCandidate& other : rotated)
    if (!isRotatedAboutRevolution(frame, other)) equivalent.addTied(other, best.scores, options.tie, frame.center);
  frame.equivalent = equivalent.poses();
  done("equivalent");
  if (visibility && options.turns) {
    frame.turns = turnsAlong(frame, points, evidence.edt(), options, *visibility, make_search);
    done("turns");
  }
  if (options.probabilities) {
    frame.probable = probableFrames(evidence, frame, frameChoices(evidence, frames, options.tie, options.num_threads));
    done("probabilities");
  }
  return frame;
}

}  // namespace pcl_symmetry
