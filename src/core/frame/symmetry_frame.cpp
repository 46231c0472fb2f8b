#include "pcl_symmetry/core/frame/symmetry_frame.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "core/base/check.h"
#include "core/base/constants.h"
#include "core/base/parallel.h"
#include "core/base/stopwatch.h"
#include "core/distance_transform/free_space.h"
#include "core/frame/plane_profiles.h"
#include "core/frame/surface_directions.h"
#include "core/geometry/principal_axes.h"
#include "pcl_symmetry/core/detection/local_maxima.h"
#include "pcl_symmetry/core/transform/planar_transform.h"

namespace pcl_symmetry {

namespace {

// Cells. Of a scan a wide Gaussian keeps planes whose other side was hardly seen; the whole can afford a narrow one.
constexpr double kWholeSigma = 1.5, kScanSigma = 2.25;
constexpr double kSigmaInSpacings = 1.5;           // at least: a sparse cloud is not a surface otherwise
constexpr double kCubeSide = 2.2;                  // radii, nearly: of the grid of the distance transform
constexpr int kNumSamples = 256;                   // of the profiles: D within about 1 %
constexpr double kCandidateAngle = 9.0 * kDegree;  // maxima of closer normals share one basin
constexpr int kMaxCandidates = 24, kMaxPeaks = 6;
constexpr int kMaxPrimaries = 6;         // candidates for the first plane that are completed to frames
constexpr int kNumAngles = 60;           // of the second plane, in the half-turn about the first normal
constexpr std::size_t kMaxFrames = 6;    // that are refined
constexpr double kSame = 5.0 * kDegree;  // frames closer than this are one
constexpr double kSharpness = 15.0;      // of the weights exp(kSharpness s) of offsets
constexpr double kOffsetWidth = 0.07;    // radii, standard deviation of weak planes about the middle of the extent
constexpr double kTail = 0.005;          // of the points beyond either end of the extent
constexpr int kRevolutionAngles = 8;
// Of a scan, of the plane half-way between the first and another about the same axis: of bodies of revolution half is
// hidden from each plane, but none is in conflict with what was seen.
constexpr double kRevolution = 0.15;

/// What a frame is worth: the score of its first plane, and a share of the scores of the others and of the agreement of
/// the surface with its axes. The latter two break ties, as between the planes across the faces and across the edges of
/// a box with square sides.
struct Weights {
  double others, agreement;
};
constexpr Weights kWholeWeights{0.6, 0.6}, kScanWeights{0.3, 0.3};

/// Lengths in cells from the middle of the grid.
struct Hypothesis {
  Eigen::Matrix3f axes;     ///< columns
  Eigen::Vector3f offsets;  ///< of the planes across them
  Eigen::Vector3f scores;
  int about = -1;                ///< the axis that planes turn about best, 1 or 2; -1: of a whole
  float diagonal_offset = 0.0f;  ///< of the plane half-way between the first and the other about it
  double value = 0.0;
};

/// A pose whose axes are the columns.
Eigen::Isometry3d poseOf(const Eigen::Matrix3d& axes, const Eigen::Vector3d& center) {
  Eigen::Isometry3d T_canonical_input = Eigen::Isometry3d::Identity();
  T_canonical_input.linear() = axes.transpose();
  T_canonical_input.translation() = -axes.transpose() * center;
  return T_canonical_input;
}

/// Adds the frame with all signs that make it a rotation, as far as they are not there.
void addWithSigns(std::vector<Eigen::Isometry3d>& frames, const Eigen::Matrix3d& axes, const Eigen::Vector3d& center) {
  for (int kept = -1; kept < 3; ++kept) {
    Eigen::Vector3d signs = Eigen::Vector3d::Constant(kept < 0 ? 1.0 : -1.0);
    if (kept >= 0) signs[kept] = 1.0;
    const Eigen::Isometry3d T = poseOf(axes * signs.asDiagonal(), center);
    const bool known = std::any_of(frames.begin(), frames.end(), [&](const Eigen::Isometry3d& other) {
      return Eigen::AngleAxisd(T.linear() * other.linear().transpose()).angle() < kSame;
    });
    if (!known) frames.push_back(T);
  }
}

SymmetryMap mapOf(const GaussianEdt& edt, const std::vector<float>& free_space, const FrameOptions& options) {
  const PlaneGrid grid(options.num_theta, options.num_phi, options.num_radius, edt.center(), edt.radius());
  SampledTransformOptions sampling;
  sampling.num_samples = options.num_samples;
  sampling.seed = options.seed;
  sampling.num_threads = options.num_threads;
  return sampledTransform(edt, grid, sampling, free_space);
}

/// Principal symmetry axes in four steps: candidates for the first plane; for the best of them the planes perpendicular
/// to it at all angles, of a scan on what it is known to be on both sides of the first; refinement of the best frames
/// as a whole; offsets.
///
/// The paper picks greedily by D. Here free space counts (a scan), the surface has a say, and the first plane is chosen
/// with regard to the frame that it leads to.
class FrameSearch {
public:
  FrameSearch(const PointsRef& points, const FrameOptions& options, const Visibility* visibility)
      : points_(points),
        options_(options),
        scanned_(visibility != nullptr),
        weights_(scanned_ ? kScanWeights : kWholeWeights),
        edt_(points, edtOptions()),
        free_(visibility ? freeSpace(edt_, *visibility, options.num_threads) : std::vector<float>()),
        profiles_(edt_, free_, kNumSamples, options.seed, options.num_threads),
        directions_(points, edt_),
        middle_(edt_.origin() + Eigen::Vector3d::Constant(0.5 * (edt_.numCells() - 1) * edt_.cellSize())),
        reach_(static_cast<float>(edt_.radius() / edt_.cellSize())),
        principal_(principalAxes(points)),
        mass_(toCells(principal_.center)) {}

  SymmetryFrame run() {
    lap("surface");
    const std::vector<CellPlane> candidates = gather();
    lap("candidates");
    std::vector<Hypothesis> turned;
    const std::vector<Hypothesis> frames = search(candidates, turned);
    lap("frames");
    SymmetryFrame frame = resultOf(frames, turned);
    lap("equivalent");
    frame.timing_ms = std::move(timing_ms_);
    return frame;
  }

  /// The greatest score of the planes across each axis.
  Eigen::Vector3d scoresOf(const Eigen::Matrix3d& axes) const {
    Eigen::Vector3d scores;
    for (int k = 0; k < 3; ++k) scores[k] = bestOffset(axes.col(k).cast<float>(), nullptr).second;
    return scores;
  }

private:
  GaussianEdtOptions edtOptions() const {
    GaussianEdtOptions edt = options_.edt;
    if (edt.sigma > 0.0 || points_.cols() == 0) return edt;
    const double radius = edt.radius > 0.0 ? edt.radius : boundingBall(points_).radius;
    const double cell = kCubeSide * radius / edt.num_cells;
    // Of so many points on a sphere the spacing, on the half of one that is seen.
    const double spacing = radius * std::sqrt((scanned_ ? 2.0 : 4.0) * M_PI / static_cast<double>(points_.cols()));
    edt.sigma = std::max((scanned_ ? kScanSigma : kWholeSigma) * cell, kSigmaInSpacings * spacing);
    return edt;
  }

  void lap(const char* stage) { timing_ms_.emplace_back(stage, watch_.lap()); }

  Eigen::Vector3f toCells(const Eigen::Vector3d& x) const { return ((x - middle_) / edt_.cellSize()).cast<float>(); }
  Eigen::Vector3d toInput(const Eigen::Vector3f& x) const { return middle_ + edt_.cellSize() * x.cast<double>(); }

  double agreement(const Eigen::Vector3f& axis) const { return weights_.agreement * directions_.agreement(axis); }
  double quality(const CellPlane& plane) const { return profiles_.score(plane) + agreement(plane.normal); }
  double valueOf(const Eigen::Vector3f& scores, double agreement) const {
    return scores[0] + weights_.others * (scores[1] + scores[2]) + agreement;
  }

  /// Of a scan the other planes are judged on what it is known to be on both sides of the first.
  const CellPlane* across(const CellPlane& first) const { return scanned_ ? &first : nullptr; }

  /// The scores of all offsets in steps of a cell, from -floor(reach).
  std::vector<float> profile(const Eigen::Vector3f& normal, const CellPlane* across) const {
    const int half = static_cast<int>(reach_);
    return profiles_.scores(normal, static_cast<float>(-half), 1.0f, 2 * half + 1, across);
  }

  std::pair<float, float> bestOffset(const Eigen::Vector3f& normal, const CellPlane* across) const {
    const std::vector<float> s = profile(normal, across);
    const auto at = std::max_element(s.begin(), s.end()) - s.begin();
    return {static_cast<float>(at - static_cast<int>(reach_)), s[at]};
  }

  /// The best offset within 1.5 cells, and its score.
  std::pair<float, float> nearbyOffset(const Eigen::Vector3f& normal, float offset, const CellPlane* across) const {
    constexpr int kSide = 3;
    constexpr float kStep = 0.5f;
    const std::vector<float> s = profiles_.scores(normal, offset - kSide * kStep, kStep, 2 * kSide + 1, across);
    const auto at = std::max_element(s.begin(), s.end()) - s.begin();
    return {offset + (static_cast<float>(at) - kSide) * kStep, s[at]};
  }

  static Eigen::Vector3f halfWay(const Eigen::Vector3f& a, const Eigen::Vector3f& b) { return (a + b).normalized(); }

  /// To the nearest maximum of quality, by steps of falling size.
  CellPlane climbed(CellPlane plane) const {
    double value = quality(plane);
    for (const double step : {3.0, 1.5, 0.75}) {
      for (int move = 0; move < 4; ++move) {
        const Eigen::Vector3f u = plane.normal.unitOrthogonal(), v = plane.normal.cross(u);
        CellPlane better = plane;
        for (const Eigen::Vector3f& side : {u, Eigen::Vector3f(-u), v, Eigen::Vector3f(-v)}) {
          const Eigen::Vector3f normal =
              (plane.normal + static_cast<float>(std::tan(step * kDegree)) * side).normalized();
          const auto [offset, score] = nearbyOffset(normal, plane.offset + (normal - plane.normal).dot(mass_), nullptr);
          const double tried = score + agreement(normal);
          if (tried <= value) continue;
          value = tried;
          better = {normal, offset};
        }
        if (better.normal == plane.normal) break;
        plane = better;
      }
    }
    return plane;
  }

  /// Maxima of the map, planes across the principal axes of the points and across the faces of the surface.
  std::vector<CellPlane> gather() {
    SymmetryMap map = mapOf(edt_, free_, options_);
    map.center_of_mass = centerOfMass(points_);
    lap("transform");
    LocalMaximaOptions maxima;
    maxima.num_threads = options_.num_threads;
    std::vector<CellPlane> candidates;
    for (const LocalMaximum& maximum : findLocalMaxima(map, maxima)) {
      if (candidates.size() >= kMaxCandidates) break;
      const Eigen::Vector3f normal = maximum.plane.normal().cast<float>();
      if (isKnown(candidates, normal, kCandidateAngle)) continue;
      candidates.push_back({normal, static_cast<float>(-maximum.plane.signedDistance(middle_) / edt_.cellSize())});
    }
    const std::size_t num_maxima = candidates.size();
    for (int k = 0; k < 3; ++k) candidates.push_back({principal_.axes.col(k).cast<float>(), 0.0f});
    for (const Eigen::Vector3f& peak : directions_.peaks(kMaxPeaks)) candidates.push_back({peak, 0.0f});
    parallelBlocks(candidates.size(), options_.num_threads, [&](std::size_t i) {
      CellPlane& plane = candidates[i];
      if (i >= num_maxima) plane.offset = bestOffset(plane.normal, nullptr).first;
      plane = climbed(plane);
    });
    return candidates;
  }

  static bool isKnown(const std::vector<CellPlane>& planes, const Eigen::Vector3f& normal, double angle) {
    return std::any_of(planes.begin(), planes.end(),
                       [&](const CellPlane& other) { return std::abs(other.normal.dot(normal)) > std::cos(angle); });
  }

  std::vector<CellPlane> primariesOf(const std::vector<CellPlane>& candidates) const {
    std::vector<std::pair<double, CellPlane>> ranked;
    for (const CellPlane& plane : candidates) ranked.emplace_back(quality(plane), plane);
    std::stable_sort(ranked.begin(), ranked.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
    std::vector<CellPlane> primaries;
    for (const auto& [value, plane] : ranked) {
      if (primaries.size() >= kMaxPrimaries) break;
      if (!isKnown(primaries, plane.normal, 0.5 * kCandidateAngle)) primaries.push_back(plane);
    }
    return primaries;
  }

  /// Frames from the best candidates, best first.
  /// \param all filled with the frames at all angles about the normals of these candidates, as they were before
  /// refinement.
  std::vector<Hypothesis> search(const std::vector<CellPlane>& candidates, std::vector<Hypothesis>& all) const {
    const std::vector<CellPlane> primaries = primariesOf(candidates);
    std::vector<CellPlane> turned(primaries.size() * kNumAngles);
    std::vector<float> scores(turned.size());
    std::vector<double> agreements(turned.size());
    std::vector<std::pair<float, float>> diagonals(turned.size());
    parallelBlocks(turned.size(), options_.num_threads, [&](std::size_t i) {
      const CellPlane& first = primaries[i / kNumAngles];
      const float angle = static_cast<float>(M_PI * static_cast<double>(i % kNumAngles) / kNumAngles);
      const Eigen::Vector3f u = first.normal.unitOrthogonal(), v = first.normal.cross(u);
      turned[i].normal = std::cos(angle) * u + std::sin(angle) * v;
      std::tie(turned[i].offset, scores[i]) = bestOffset(turned[i].normal, across(first));
      agreements[i] = agreement(turned[i].normal);
      if (scanned_) diagonals[i] = bestOffset(halfWay(first.normal, turned[i].normal), nullptr);
    });

    std::vector<Hypothesis> frames;
    constexpr std::size_t kQuarter = kNumAngles / 2;
    for (std::size_t p = 0; p < primaries.size(); ++p) {
      const float first_score = profiles_.score(primaries[p]);
      const double first_agreement = agreement(primaries[p].normal);
      const auto hypothesis = [&](std::size_t angle) {
        const std::size_t i = p * kNumAngles + angle % kQuarter, j = i + kQuarter;
        Hypothesis frame;
        frame.axes << primaries[p].normal, turned[i].normal, turned[j].normal;
        frame.offsets << primaries[p].offset, turned[i].offset, turned[j].offset;
        frame.scores << first_score, scores[i], scores[j];
        frame.value = valueOf(frame.scores, first_agreement + agreements[i] + agreements[j]);
        if (scanned_) {
          frame.about = diagonals[i].second > diagonals[j].second ? 2 : 1;
          const auto& diagonal = diagonals[frame.about == 2 ? i : j];
          frame.diagonal_offset = diagonal.first;
          frame.value += kRevolution * diagonal.second;
        }
        return frame;
      };
      for (std::size_t angle = 0; angle < kQuarter; ++angle) {
        const Hypothesis frame = hypothesis(angle);
        all.push_back(frame);
        if (frame.value >= hypothesis(angle + kQuarter - 1).value && frame.value > hypothesis(angle + 1).value)
          frames.push_back(frame);
      }
      // Where no angle stands out, any is right.
      if (frames.empty()) frames.push_back(hypothesis(0));
    }
    const auto best_first = [](const Hypothesis& a, const Hypothesis& b) { return a.value > b.value; };
    std::stable_sort(frames.begin(), frames.end(), best_first);
    frames.resize(std::min(frames.size(), kMaxFrames));
    parallelBlocks(frames.size(), options_.num_threads, [&](std::size_t i) { frames[i] = refined(frames[i]); });
    std::stable_sort(frames.begin(), frames.end(), best_first);
    return frames;
  }

  /// The frame turned to \p axes, with offsets near those it had.
  Hypothesis turnedTo(const Hypothesis& from, const Eigen::Matrix3f& axes) const {
    Hypothesis frame;
    frame.axes = axes;
    double agreements = 0.0;
    CellPlane first{axes.col(0), 0.0f};
    for (int k = 0; k < 3; ++k) {
      const float offset = from.offsets[k] + (axes.col(k) - from.axes.col(k)).dot(mass_);
      std::tie(frame.offsets[k], frame.scores[k]) = nearbyOffset(axes.col(k), offset, k > 0 ? across(first) : nullptr);
      if (k == 0) first.offset = frame.offsets[0];
      agreements += agreement(axes.col(k));
    }
    frame.value = valueOf(frame.scores, agreements);
    if (from.about > 0) {
      const int other = 3 - from.about;
      const Eigen::Vector3f normal = halfWay(axes.col(0), axes.col(other));
      const Eigen::Vector3f before = halfWay(from.axes.col(0), from.axes.col(other));
      const auto diagonal = nearbyOffset(normal, from.diagonal_offset + (normal - before).dot(mass_), nullptr);
      frame.about = from.about;
      frame.diagonal_offset = diagonal.first;
      frame.value += kRevolution * diagonal.second;
    }
    return frame;
  }

  double spreadAlong(const Eigen::Vector3f& axis) const {
    return (principal_.axes.transpose() * axis.cast<double>()).cwiseAbs2().dot(principal_.variances);
  }

  /// To the nearest maximum of the value, all three planes together; then in the order of their scores, or where they
  /// tie of the spread of the points along the axes.
  Hypothesis refined(const Hypothesis& start) const {
    Hypothesis frame = turnedTo(start, start.axes);
    for (const double step : {2.0, 1.0, 0.5}) {
      for (int move = 0; move < 3; ++move) {
        Hypothesis better = frame;
        for (int k = 0; k < 6; ++k) {
          const Eigen::Vector3f about = frame.axes.col(k / 2);
          const Eigen::AngleAxisf turn(static_cast<float>((k % 2 ? -step : step) * kDegree), about);
          const Hypothesis tried = turnedTo(frame, turn.toRotationMatrix() * frame.axes);
          if (tried.value > better.value) better = tried;
        }
        if (better.axes == frame.axes) break;
        frame = better;
      }
    }
    const float ahead = frame.scores[1] - frame.scores[2];
    const bool tied = std::abs(ahead) <= options_.tie;
    if (tied ? spreadAlong(frame.axes.col(2)) > spreadAlong(frame.axes.col(1)) : ahead < 0.0f) {
      frame.axes.col(1).swap(frame.axes.col(2));
      std::swap(frame.offsets[1], frame.offsets[2]);
      std::swap(frame.scores[1], frame.scores[2]);
    }
    return frame;
  }

  /// The middle of the extent of the points along an axis. Of a scan it is near that of the whole, as silhouettes and
  /// rims are seen where surfaces behind are not; the center of mass is not.
  double middleAlong(const Eigen::Vector3f& axis) const {
    std::vector<float> t(static_cast<std::size_t>(points_.cols()));
    for (std::size_t i = 0; i < t.size(); ++i)
      t[i] = axis.dot(toCells(points_.col(static_cast<Eigen::Index>(i)).cast<double>()));
    const auto tail = static_cast<std::ptrdiff_t>(kTail * static_cast<double>(t.size() - 1));
    std::nth_element(t.begin(), t.begin() + tail, t.end());
    const float low = t[static_cast<std::size_t>(tail)];
    std::nth_element(t.begin(), t.end() - 1 - tail, t.end());
    return 0.5 * (low + *(t.end() - 1 - tail));
  }

  /// The profiles of the second and third plane are flat: their offset is a mean over all, by score, about the middle.
  Eigen::Vector3f centerOf(const Hypothesis& frame) const {
    const CellPlane first{frame.axes.col(0), frame.offsets[0]};
    Eigen::Vector3f center = first.offset * first.normal;
    for (int k = 1; k < 3; ++k) {
      const Eigen::Vector3f axis = frame.axes.col(k);
      const std::vector<float> s = profile(axis, across(first));
      const float top = *std::max_element(s.begin(), s.end());
      const double middle = middleAlong(axis);
      double sum = 0.0, moment = 0.0;
      for (std::size_t i = 0; i < s.size(); ++i) {
        const double r = static_cast<double>(i) - std::floor(reach_);
        const double away = (r - middle) / (kOffsetWidth * reach_);
        const double weight = std::exp(kSharpness * (s[i] - top) - 0.5 * away * away);
        sum += weight;
        moment += weight * r;
      }
      center += static_cast<float>(sum > 0.0 ? moment / sum : middle) * axis;
    }
    return center;
  }

  /// Exactly, and right-handed.
  static Eigen::Matrix3d orthonormal(const Eigen::Matrix3f& axes) {
    Eigen::Matrix3d result = axes.cast<double>();
    result.col(0).normalize();
    result.col(1) = (result.col(1) - result.col(0).dot(result.col(1)) * result.col(0)).normalized();
    result.col(2) = result.col(0).cross(result.col(1));
    return result;
  }

  /// Signs by the third central moments.
  Eigen::Matrix3d oriented(const Eigen::Matrix3f& axes) const {
    Eigen::Matrix3d result = orthonormal(axes);
    const Eigen::Vector3d mean = centerOfMass(points_);
    Eigen::Vector3d moments = Eigen::Vector3d::Zero();
    for (Eigen::Index i = 0; i < points_.cols(); ++i)
      moments.array() += (result.transpose() * (points_.col(i).cast<double>() - mean)).array().cube();
    for (int k = 1; k < 3; ++k)
      if (moments[k] < 0.0) result.col(k) *= -1.0;
    result.col(0) = result.col(1).cross(result.col(2));
    return result;
  }

  /// \param frames best first. \param turned frames at all angles about a few axes.
  SymmetryFrame resultOf(const std::vector<Hypothesis>& frames, const std::vector<Hypothesis>& turned) const {
    const Hypothesis& best = frames.front();
    SymmetryFrame frame;
    frame.center = toInput(centerOf(best));
    frame.axes = oriented(best.axes);
    frame.scores = best.scores.cast<double>().cwiseMin(1.0);
    frame.revolution_axis = revolutionAxis(best);
    frame.T_canonical_input = poseOf(frame.axes, frame.center);
    addWithSigns(frame.equivalent, frame.axes, frame.center);
    for (const Hypothesis& other : frames)
      addTied(frame.equivalent, best.scores, other, &other == &best ? frame.center : toInput(centerOf(other)));
    frame.num_maxima = frame.equivalent.size();
    // Where the second plane hardly matters, angles between the maxima are as good.
    for (const Hypothesis& other : turned)
      if (!isCovered(frame, other)) addTied(frame.equivalent, best.scores, other, frame.center);
    return frame;
  }

  /// Whether all turns about the axis of revolution are as good anyway.
  static bool isCovered(const SymmetryFrame& frame, const Hypothesis& other) {
    if (frame.revolution_axis < 0) return false;
    if (frame.revolution_axis == 3) return true;
    const Eigen::Vector3f axis = frame.axes.col(frame.revolution_axis).cast<float>();
    return (other.axes.transpose() * axis).cwiseAbs().maxCoeff() > std::cos(kSame);
  }

  /// Adds the frame in all orders in which each of its planes scores no less than \p scores but for a tie.
  void addTied(std::vector<Eigen::Isometry3d>& frames, const Eigen::Vector3f& scores, const Hypothesis& other,
               const Eigen::Vector3d& center) const {
    constexpr int kOrders[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
    for (const auto& order : kOrders) {
      bool tied = true;
      Eigen::Matrix3f axes;
      for (int k = 0; k < 3; ++k) {
        tied &= other.scores[order[k]] >= scores[k] - options_.tie;
        axes.col(k) = other.axes.col(order[k]);
      }
      if (tied) addWithSigns(frames, orthonormal(axes), center);
    }
  }

  /// The column about which planes at all angles score alike; 3 where there are two such.
  int revolutionAxis(const Hypothesis& frame) const {
    const Eigen::Vector3f center = frame.axes * frame.offsets;
    int axis = -1, count = 0;
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3f u = frame.axes.col((k + 1) % 3), v = frame.axes.col((k + 2) % 3);
      float lowest = std::numeric_limits<float>::infinity(), highest = 0.0f;
      for (int a = 0; a < kRevolutionAngles; ++a) {
        const float angle = static_cast<float>(M_PI * a / kRevolutionAngles);
        const Eigen::Vector3f normal = std::cos(angle) * u + std::sin(angle) * v;
        const float score = nearbyOffset(normal, normal.dot(center), nullptr).second;
        lowest = std::min(lowest, score);
        highest = std::max(highest, score);
      }
      if (lowest < highest - options_.tie) continue;
      axis = k;
      ++count;
    }
    return count >= 2 ? 3 : axis;
  }

  const PointsRef& points_;
  const FrameOptions& options_;
  const bool scanned_;
  const Weights weights_;
  Stopwatch watch_;
  std::vector<std::pair<std::string, double>> timing_ms_;
  const GaussianEdt edt_;
  const std::vector<float> free_;
  const PlaneProfiles profiles_;
  const SurfaceDirections directions_;
  const Eigen::Vector3d middle_;
  const float reach_;  // radius in cells
  const PrincipalAxes principal_;
  const Eigen::Vector3f mass_;  // center of mass
};

/// Section 5.1 as it stands.
SymmetryFrame publishedFrame(const PointsRef& points, const FrameOptions& options) {
  const GaussianEdt edt(points, options.edt);
  const SymmetryMap map = mapOf(edt, {}, options);
  const PlaneGrid& grid = map.grid;
  const PlaneGrid::Bin strongest = grid.bin(map.strongest());
  const PlaneProfiles profiles(edt, {}, kNumSamples, options.seed, options.num_threads);
  const Eigen::Vector3d middle = edt.origin() + Eigen::Vector3d::Constant(0.5 * (edt.numCells() - 1) * edt.cellSize());
  /// Offset from the center of the grid, input units, and D.
  const auto best_offset = [&](const Eigen::Vector3d& normal) {
    const double first = (normal.dot(grid.center() - middle) + grid.offset(0)) / edt.cellSize();
    const std::vector<float> s =
        profiles.scores(normal.cast<float>(), static_cast<float>(first),
                        static_cast<float>(grid.radiusStep() / edt.cellSize()), grid.numRadius());
    const auto at = std::max_element(s.begin(), s.end()) - s.begin();
    return std::pair<double, double>(grid.offset(static_cast<int>(at)), s[at]);
  };
  SymmetryFrame frame;
  frame.axes.col(0) = grid.normal(strongest.theta, strongest.phi);
  const Eigen::Vector3d u = frame.axes.col(0).unitOrthogonal(), v = frame.axes.col(0).cross(u);
  const auto turned = [&](std::size_t i) -> Eigen::Vector3d {
    const double angle = M_PI * static_cast<double>(i) / grid.numPhi();
    return std::cos(angle) * u + std::sin(angle) * v;
  };
  std::vector<std::pair<double, double>> offsets(static_cast<std::size_t>(grid.numPhi()));
  parallelBlocks(offsets.size(), options.num_threads, [&](std::size_t i) { offsets[i] = best_offset(turned(i)); });
  const auto second = std::max_element(offsets.begin(), offsets.end(),
                                       [](const auto& a, const auto& b) { return a.second < b.second; });
  frame.axes.col(1) = turned(static_cast<std::size_t>(second - offsets.begin()));
  frame.axes.col(2) = frame.axes.col(0).cross(frame.axes.col(1));
  const auto third = best_offset(frame.axes.col(2));
  frame.center =
      grid.center() + frame.axes * Eigen::Vector3d(grid.offset(strongest.radius), second->first, third.first);
  frame.scores << map[map.strongest()], second->second, third.second;
  frame.T_canonical_input = poseOf(frame.axes, frame.center);
  addWithSigns(frame.equivalent, frame.axes, frame.center);
  frame.num_maxima = frame.equivalent.size();
  return frame;
}

}  // namespace

void FrameOptions::validate() const {
  edt.validate();
  check(num_theta >= 1, "num_theta", num_theta, ">= 1");
  check(num_phi >= 2 && num_phi % 2 == 0, "num_phi", num_phi, "even and >= 2");
  check(num_radius >= 1, "num_radius", num_radius, ">= 1");
  check(num_samples >= 1, "num_samples", num_samples, ">= 1");
  check(tie >= 0.0, "tie", tie, ">= 0");
  checkNumThreads(num_threads);
}

SymmetryFrame symmetryFrame(const PointsRef& points, const FrameOptions& options, const Visibility* visibility) {
  options.validate();
  return options.as_published ? publishedFrame(points, options) : FrameSearch(points, options, visibility).run();
}

std::vector<Eigen::Vector3d> axisScores(const PointsRef& points, const std::vector<Eigen::Matrix3d>& frames,
                                        const FrameOptions& options) {
  options.validate();
  const FrameSearch search(points, options, nullptr);
  std::vector<Eigen::Vector3d> scores;
  for (const Eigen::Matrix3d& axes : frames) scores.push_back(search.scoresOf(axes));
  return scores;
}

}  // namespace pcl_symmetry
