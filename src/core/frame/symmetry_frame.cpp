#include "pcl_symmetry/core/symmetry_frame.h"

#include <algorithm>

#include "core/base/check.h"
#include "core/base/constants.h"
#include "core/base/options.h"
#include "core/base/parallel.h"
#include "core/base/stopwatch.h"
#include "core/frame/canonical_frame.h"
#include "core/frame/frame_evidence.h"
#include "core/frame/frame_fit.h"
#include "core/frame/frame_search.h"
#include "core/frame/probable_frames.h"
#include "core/geometry/directions.h"
#include "core/geometry/point_samples.h"
#include "core/rotation/scan_axes.h"
#include "core/transform/sampled_transform.h"
#include "pcl_symmetry/core/planar_transform.h"
#include "pcl_symmetry/core/published_planes.h"

namespace pcl_symmetry {

namespace {

/// An offset from the center of the grid, input units, and D of the plane there.
struct OffsetAndScore {
  double offset = 0.0, score = 0.0;
};

/// Section 5.1 as written: each axis is the normal of the plane of greatest D among the remaining ones.
SymmetryFrame publishedFrame(const PointsRef& points, const FrameOptions& options) {
  const GaussianEdt edt(points, options.edtOptions());
  const SymmetryMap map = publishedMap(points, edt, TransformMethod::Convolution, options.seed, options.num_threads);
  const PlaneGrid& grid = map.grid;
  const PlaneProfiles profiles(edt, {}, kFrame.num_profile_samples, options.seed, options.num_threads);
  const Eigen::Vector3d middle = middleOf(edt);
  const auto bestOffset = [&](const Eigen::Vector3d& normal) -> OffsetAndScore {
    const double first = (normal.dot(grid.center() - middle) + grid.offset(0)) / edt.cellSize();
    const std::vector<float> s =
        profiles.scores(normal.cast<float>(), static_cast<float>(first),
                        static_cast<float>(grid.radiusStep() / edt.cellSize()), grid.numRadius());
    const auto at = std::max_element(s.begin(), s.end()) - s.begin();
    return {grid.offset(static_cast<int>(at)), s[at]};
  };

  // First: the plane of greatest D among the strongest refined maxima. Maxima that leave their cell are kept, because
  // the method works best that way.
  auto published = optionsWith<PublishedOptions>(options.seed, options.num_threads);
  published.discard_unstable = false;
  published.max_maxima = 8;
  const std::vector<SymmetryPlane> maxima = publishedPlanes(points, edt, map, published);
  const ReflectionPlane first =
      maxima.empty() ? grid.plane(grid.bin(map.strongest())) : ReflectionPlane(maxima.front());
  SymmetryFrame frame;
  frame.axes.col(0) = first.normal();

  // Second: the plane of greatest D among those perpendicular to the first.
  const auto across = [&](std::size_t i) {
    return directionAcross(first.normal(), kPi * static_cast<double>(i) / grid.numPhi());
  };
  std::vector<OffsetAndScore> perpendicular(grid.numPhi());
  parallelBlocks(perpendicular.size(), options.num_threads,
                 [&](std::size_t i) { perpendicular[i] = bestOffset(across(i)); });
  const auto second =
      std::max_element(perpendicular.begin(), perpendicular.end(),
                       [](const OffsetAndScore& a, const OffsetAndScore& b) { return a.score < b.score; });
  frame.axes.col(1) = across(static_cast<std::size_t>(second - perpendicular.begin()));

  // Third: the plane of greatest D among those perpendicular to both.
  frame.axes.col(2) = frame.axes.col(0).cross(frame.axes.col(1));
  const OffsetAndScore third = bestOffset(frame.axes.col(2));

  // The center of symmetry is where the three meet.
  frame.center =
      grid.center() + frame.axes * Eigen::Vector3d(-first.signedDistance(grid.center()), second->offset, third.offset);
  frame.scores << (maxima.empty() ? map[map.strongest()] : maxima.front().score), second->score, third.score;
  frame.T_canonical_input = canonicalPose(frame.axes, frame.center);
  addWithSigns(frame.axes, frame.center, frame.equivalent);
  frame.num_maxima = frame.equivalent.size();
  return frame;
}

/// Adds the rotations of a scan, whose center and axis of revolution replace those of the planes. The axes of the frame
/// are tried first.
void addRotations(const PointsRef& points, const GaussianEdt& edt, const FrameOptions& options,
                  const Visibility& visibility, const MakeSearch& make_search, SymmetryFrame& frame) {
  const auto detection = optionsWith<DetectionOptions>(options.seed, options.num_threads);
  std::vector<SymmetryAxis> axes;
  for (int k = 0; k < 3; ++k) axes.push_back({frame.center, frame.axes.col(k)});
  Detection found = rotationsOfScan(points, edt, visibility, axes, detection, make_search);
  frame.rotations = std::move(found.rotations);
  if (!found.centers.empty()) {
    frame.center = found.centers.front().point;
    frame.revolution_axis = 3;
  }
  for (const SymmetryRotation& rotation : frame.rotations)
    if (rotation.fold == 0 && frame.revolution_axis < 0) frame.revolution_axis = axisAlong(rotation, frame);
}

/// The frame itself, then the others by decreasing probability.
/// \param centers centers of the frames of the search.
std::vector<ProbableFrame> probableFrames(const FrameEvidence& evidence, const SymmetryFrame& frame,
                                          const std::vector<FrameChoice>& choices,
                                          const std::vector<Eigen::Vector3d>& centers) {
  const auto& weights = evidence.scanned ? kFrameFit.scan : kFrameFit.whole;
  const std::vector<double> probabilities = frameProbabilities(choices, Eigen::Map<const FrameTerms>(weights.data()));
  std::vector<ProbableFrame> probable;
  for (std::size_t i = 0; i < choices.size(); ++i) {
    const FrameChoice& choice = choices[i];
    ProbableFrame entry{
        frame.center, frame.axes, i == 0 ? frame.revolution_axis : choice.revolution_axis, probabilities[i], {}};
    if (i > 0) {
      entry.center = choice.found_as < 0 ? centerOfSymmetry(evidence, choice.frame) : centers[choice.found_as];
      entry.axes = principalSymmetryAxes(evidence.points, choice.frame.axes);
    }
    std::copy(choice.terms.data(), choice.terms.data() + choice.terms.size(), entry.evidence.begin());
    probable.push_back(entry);
  }
  if (!probable.empty())
    std::stable_sort(probable.begin() + 1, probable.end(),
                     [](const ProbableFrame& a, const ProbableFrame& b) { return a.probability > b.probability; });
  return probable;
}

/// Equally good frames: first the maxima, then the angles between them where the second plane hardly matters.
/// \param frames,centers the maxima, best first, and their centers.
/// \param rotated frames at all angles.
void listEquivalents(const std::vector<FrameCandidate>& frames, const std::vector<Eigen::Vector3d>& centers,
                     const std::vector<FrameCandidate>& rotated, SymmetryFrame& frame) {
  const auto& scores = frames.front().scores;
  addWithSigns(frame.axes, frame.center, frame.equivalent);
  for (std::size_t i = 0; i < frames.size(); ++i)
    addTied(frames[i], scores, i == 0 ? frame.center : centers[i], frame.equivalent);
  frame.num_maxima = frame.equivalent.size();
  for (const FrameCandidate& other : rotated)
    if (!isRotatedAboutRevolution(frame.axes.cast<float>(), frame.revolution_axis, other.axes))
      addTied(other, scores, frame.center, frame.equivalent);
}

}  // namespace

void FrameOptions::validate() const {
  edtOptions().validate();
  MapSize::validate();
  check(num_samples >= 1, "num_samples", num_samples, ">= 1");
  checkNumThreads(num_threads);
}

SymmetryFrame symmetryFrame(const PointsRef& all, const FrameOptions& options, const Visibility* visibility,
                            const MakeSearch& make_search) {
  options.validate();
  if (options.as_published) return publishedFrame(all, options);
  SymmetryFrame frame;
  const Points bulk = withoutStrayPoints(all);
  const PointsRef points(bulk);
  frame.num_stray_points = static_cast<int>(all.cols() - points.cols());
  StageTimes done(frame.timing_ms);

  const FrameEvidence evidence(points, options, visibility);
  done("surface");
  const GaussianEdt& edt = evidence.edt;
  const PlaneGrid grid(options, edt.center(), edt.radius());
  SymmetryMap map =
      sampledTransform(edt, grid, {options.num_samples, options.seed, options.num_threads}, evidence.free_space);
  map.center_of_mass = centerOfMass(points);
  done("transform");

  // First plane: several candidates, because the best one depends on the resulting frame.
  const std::vector<CellPlane> candidates = firstPlaneCandidates(evidence, map, options.num_threads);
  done("candidates");

  // Second and third plane: perpendicular to the first, at all angles, on the completed cloud of a scan. The best
  // frames are refined as a whole.
  const std::vector<FrameCandidate> rotated =
      framesAbout(evidence, bestFirstPlanes(evidence, candidates), options.num_threads);
  const std::vector<FrameCandidate> frames =
      leveledFirst(evidence, refinedFrames(evidence, frameMaxima(rotated), options.num_threads));
  done("frames");

  // Principal symmetry axes, center of symmetry and axis of revolution of the best frame.
  const FrameCandidate& best = frames.front();
  frame.axes = principalSymmetryAxes(points, best.axes);
  std::vector<Eigen::Vector3d> centers;
  for (const FrameCandidate& other : frames) centers.push_back(centerOfSymmetry(evidence, other));
  frame.center = meanCenter(centers, frames);
  frame.scores = best.scores.cast<double>().cwiseMin(1.0);
  frame.revolution_axis = revolutionAxis(evidence, best);
  done("center");
  if (visibility && options.rotations) {
    addRotations(points, edt, options, *visibility, make_search, frame);
    done("rotations");
  }
  frame.T_canonical_input = canonicalPose(frame.axes, frame.center);

  listEquivalents(frames, centers, rotated, frame);
  done("equivalent");
  if (options.refined) {
    refineOnPoints(points, visibility, options, frame);
    done("refined");
  }
  if (options.probabilities) {
    frame.probable = probableFrames(evidence, frame, frameChoices(evidence, frames, options.num_threads), centers);
    done("probabilities");
  }
  return frame;
}

}  // namespace pcl_symmetry
