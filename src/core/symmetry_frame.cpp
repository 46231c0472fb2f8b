#include "pcl_symmetry/core/symmetry_frame.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>

#include "check.h"
#include "pcl_symmetry/core/local_maxima.h"
#include "pcl_symmetry/core/parallel.h"
#include "pcl_symmetry/core/principal_axes.h"
#include "pcl_symmetry/core/sampled_transform.h"
#include "plane_profiles.h"
#include "surface_directions.h"

namespace pcl_symmetry {

namespace {

constexpr double kDegree = M_PI / 180.0;
const double kScanSigma = 3.0;
const int kNumSamples = 256;
const double kCandidateAngle = 9.0 * kDegree;
const int kMaxCandidates = 24;
const int kMaxPeaks = 6;
const int kMaxPrimaries = 6;
const double kAgreementWeight = 0.3;
const double kOtherWeight = 0.3;
constexpr int kNumAngles = 60;  // in the half-turn within the first plane
const int kMaxFrames = 6;
const double kSharpness = 30.0;
const double kPriorWidth = 0.5;
const double kPush = 0.15;

class Stopwatch {
public:
  double lap() {
    const auto now = std::chrono::steady_clock::now();
    const double elapsed = std::chrono::duration<double, std::milli>(now - last_).count();
    last_ = now;
    return elapsed;
  }

private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

struct Hypothesis {
  Eigen::Matrix3f axes;     // columns, best first
  Eigen::Vector3f offsets;  // of the planes across them
  Eigen::Vector3f scores;
  double value;
};

class FrameSearch {
public:
  FrameSearch(const PointsRef& points, const FrameOptions& options, const Visibility* visibility)
      : points_(points),
        options_(options),
        visibility_(visibility),
        edt_(points, edtOptions()),
        free_(visibility ? freeSpace(edt_, *visibility, options.num_threads) : std::vector<float>()),
        profiles_(edt_, free_, kNumSamples, options.seed, options.num_threads),
        directions_(points, edt_) {
    middle_ = edt_.origin() + Eigen::Vector3d::Constant(0.5 * (edt_.numCells() - 1) * edt_.cellSize());
    reach_ = static_cast<float>(edt_.radius() / edt_.cellSize());
    mass_ = toCells(centerOfMass(points));
    expected_ = mass_;
    if (visibility) {
      const Eigen::Vector3f away = mass_ - toCells(visibility->viewpoint());
      expected_ += kPush * reach_ * away.normalized();
    }
  }

  SymmetryFrame run() {
    std::vector<CellPlane> candidates = gather();
    lap("candidates");
    std::vector<Hypothesis> frames = search(candidates);
    lap("frames");
    return result(frames);
  }

private:
  GaussianEdtOptions edtOptions() const {
    GaussianEdtOptions edt = options_.edt;
    if (edt.sigma == 0.0 && visibility_) {
      const BoundingBall ball = boundingBall(points_);
      const double radius = edt.radius > 0.0 ? edt.radius : ball.radius;
      edt.sigma = kScanSigma * 2.2 * radius / edt.num_cells;
    }
    return edt;
  }

  void lap(const char* stage) { timing_.emplace_back(stage, watch_.lap()); }

  Eigen::Vector3f toCells(const Eigen::Vector3d& x) const { return ((x - middle_) / edt_.cellSize()).cast<float>(); }
  Eigen::Vector3d toInput(const Eigen::Vector3f& x) const { return middle_ + edt_.cellSize() * x.cast<double>(); }

  double quality(const CellPlane& plane) const {
    return profiles_.score(plane) + kAgreementWeight * directions_.agreement(plane.normal);
  }

  /// The best offset of a normal.
  CellPlane best(const Eigen::Vector3f& normal, const CellPlane* across = nullptr) const {
    const int half = static_cast<int>(reach_);
    const std::vector<float> s = profiles_.scores(normal, -half, 1.0f, 2 * half + 1, across);
    const auto at = std::max_element(s.begin(), s.end()) - s.begin();
    return {normal, static_cast<float>(at - half)};
  }

  /// The best offset near that of a plane.
  std::pair<float, float> nearby(const Eigen::Vector3f& normal, float offset, const CellPlane* across) const {
    constexpr int kSide = 3;
    constexpr float kStep = 0.5f;
    const std::vector<float> s = profiles_.scores(normal, offset - kSide * kStep, kStep, 2 * kSide + 1, across);
    const auto at = std::max_element(s.begin(), s.end()) - s.begin();
    return {offset + (static_cast<float>(at) - kSide) * kStep, s[at]};
  }

  CellPlane climb(CellPlane plane) const {
    double value = profiles_.score(plane) + kAgreementWeight * directions_.agreement(plane.normal);
    for (const double step : {3.0, 1.5, 0.75}) {
      for (int move = 0; move < 4; ++move) {
        const Eigen::Vector3f u = plane.normal.unitOrthogonal(), v = plane.normal.cross(u);
        CellPlane better = plane;
        for (const auto& [a, b] : {std::pair(1, 0), std::pair(-1, 0), std::pair(0, 1), std::pair(0, -1)}) {
          const float tilt = static_cast<float>(std::tan(step * kDegree));
          const Eigen::Vector3f normal = (plane.normal + tilt * (a * u + b * v)).normalized();
          // Turned about the place of the center of mass.
          const float offset = plane.offset + (normal - plane.normal).dot(mass_);
          const auto [r, s] = nearby(normal, offset, nullptr);
          const double q = s + kAgreementWeight * directions_.agreement(normal);
          if (q > value) value = q, better = {normal, r};
        }
        if (better.normal == plane.normal) break;
        plane = better;
      }
    }
    return plane;
  }

  std::vector<CellPlane> gather() {
    const PlaneGrid grid(options_.num_theta, options_.num_phi, options_.num_radius, edt_.center(), edt_.radius());
    SampledTransformOptions sampling;
    sampling.num_samples = options_.num_samples;
    sampling.seed = options_.seed;
    sampling.num_threads = options_.num_threads;
    SymmetryMap map = sampledTransform(edt_, grid, sampling, free_);
    map.center_of_mass = centerOfMass(points_);
    lap("transform");
    LocalMaximaOptions maxima;
    maxima.num_threads = options_.num_threads;
    std::vector<CellPlane> candidates;
    for (const LocalMaximum& maximum : findLocalMaxima(map, maxima)) {
      if (static_cast<int>(candidates.size()) >= kMaxCandidates) break;
      const Eigen::Vector3f normal = maximum.plane.normal().cast<float>();
      const bool known = std::any_of(candidates.begin(), candidates.end(), [&](const CellPlane& other) {
        return std::abs(other.normal.dot(normal)) > std::cos(kCandidateAngle);
      });
      if (known) continue;
      candidates.push_back({normal, static_cast<float>(-maximum.plane.signedDistance(middle_) / edt_.cellSize())});
    }
    const std::size_t num_maxima = candidates.size();
    const PrincipalAxes principal = principalAxes(points_);
    for (int k = 0; k < 3; ++k) candidates.push_back({principal.axes.col(k).cast<float>(), 0.0f});
    for (const Eigen::Vector3f& peak : directions_.peaks(kMaxPeaks)) candidates.push_back({peak, 0.0f});
    parallelBlocks(candidates.size(), options_.num_threads, [&](std::size_t i) {
      if (i >= num_maxima) candidates[i] = best(candidates[i].normal);
      candidates[i] = climb(candidates[i]);
    });
    return candidates;
  }

  std::vector<Hypothesis> search(const std::vector<CellPlane>& candidates) {
    std::vector<std::pair<double, CellPlane>> ranked;
    for (const CellPlane& plane : candidates) ranked.emplace_back(quality(plane), plane);
    std::stable_sort(ranked.begin(), ranked.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
    std::vector<CellPlane> primaries;
    for (const auto& [value, plane] : ranked) {
      if (static_cast<int>(primaries.size()) >= kMaxPrimaries) break;
      const bool known = std::any_of(primaries.begin(), primaries.end(), [&](const CellPlane& other) {
        return std::abs(other.normal.dot(plane.normal)) > std::cos(0.5 * kCandidateAngle);
      });
      if (!known) primaries.push_back(plane);
    }
    std::vector<CellPlane> turned(primaries.size() * kNumAngles);
    std::vector<float> scores(turned.size()), agreements(turned.size());
    parallelBlocks(turned.size(), options_.num_threads, [&](std::size_t i) {
      const CellPlane& first = primaries[i / kNumAngles];
      const float angle = static_cast<float>(M_PI * static_cast<double>(i % kNumAngles) / kNumAngles);
      const Eigen::Vector3f u = first.normal.unitOrthogonal(), v = first.normal.cross(u);
      turned[i] = best(std::cos(angle) * u + std::sin(angle) * v, across(first));
      scores[i] = profiles_.score(turned[i], across(first));
      agreements[i] = static_cast<float>(directions_.agreement(turned[i].normal));
    });
    std::vector<Hypothesis> frames;
    constexpr int kQuarter = kNumAngles / 2;
    for (std::size_t p = 0; p < primaries.size(); ++p) {
      const double s1 = profiles_.score(primaries[p]), b1 = directions_.agreement(primaries[p].normal);
      const auto value = [&](int a) {
        const std::size_t i = p * kNumAngles + (a + kQuarter) % kQuarter, j = i + kQuarter;
        return s1 + kOtherWeight * (scores[i] + scores[j]) + kAgreementWeight * (b1 + agreements[i] + agreements[j]);
      };
      for (int a = 0; a < kQuarter; ++a) {
        if (value(a) < value(a - 1) || value(a) <= value(a + 1)) continue;
        const std::size_t i = p * kNumAngles + a, j = i + kQuarter;
        Hypothesis frame{};
        frame.axes << primaries[p].normal, turned[i].normal, turned[j].normal;
        frame.offsets << primaries[p].offset, turned[i].offset, turned[j].offset;
        frame.value = value(a);
        frames.push_back(frame);
      }
    }
    std::stable_sort(frames.begin(), frames.end(), [](const auto& a, const auto& b) { return a.value > b.value; });
    if (frames.size() > static_cast<std::size_t>(kMaxFrames)) frames.resize(kMaxFrames);
    parallelBlocks(frames.size(), options_.num_threads, [&](std::size_t i) { polish(frames[i]); });
    std::stable_sort(frames.begin(), frames.end(), [](const auto& a, const auto& b) { return a.value > b.value; });
    return frames;
  }

  const CellPlane* across(const CellPlane& first) const { return visibility_ ? &first : nullptr; }

  /// Offsets near those of the frame, scores and value of the turned frame.
  Hypothesis evaluated(const Hypothesis& from, const Eigen::Matrix3f& axes) const {
    Hypothesis frame{};
    frame.axes = axes;
    double agreement = 0.0;
    CellPlane first{axes.col(0), 0.0f};
    for (int k = 0; k < 3; ++k) {
      const float offset = from.offsets[k] + (axes.col(k) - from.axes.col(k)).dot(mass_);
      std::tie(frame.offsets[k], frame.scores[k]) = nearby(axes.col(k), offset, k ? across(first) : nullptr);
      if (k == 0) first.offset = frame.offsets[0];
      agreement += directions_.agreement(axes.col(k));
    }
    frame.value = frame.scores[0] + kOtherWeight * (frame.scores[1] + frame.scores[2]) + kAgreementWeight * agreement;
    return frame;
  }

  void polish(Hypothesis& frame) const {
    frame = evaluated(frame, frame.axes);
    for (const double step : {2.0, 1.0, 0.5}) {
      for (int move = 0; move < 3; ++move) {
        Hypothesis better = frame;
        for (int k = 0; k < 6; ++k) {
          const float angle = static_cast<float>((k % 2 ? -step : step) * kDegree);
          const Eigen::Matrix3f turn =
              Eigen::AngleAxisf(angle, Eigen::Vector3f(frame.axes.col(k / 2))).toRotationMatrix();
          const Hypothesis turned = evaluated(frame, turn * frame.axes);
          if (turned.value > better.value) better = turned;
        }
        if (better.axes == frame.axes) break;
        frame = better;
      }
    }
    if (frame.scores[2] > frame.scores[1]) {
      frame.axes.col(1).swap(frame.axes.col(2));
      std::swap(frame.offsets[1], frame.offsets[2]);
      std::swap(frame.scores[1], frame.scores[2]);
    }
  }

  /// Weak planes have flat profiles: their offset is the mean over all, by score.
  Eigen::Vector3f centerOf(const Hypothesis& frame) const {
    Eigen::Vector3f center = frame.offsets[0] * frame.axes.col(0);
    const CellPlane first{frame.axes.col(0), frame.offsets[0]};
    const int half = static_cast<int>(reach_);
    for (int k = 1; k < 3; ++k) {
      const std::vector<float> s = profiles_.scores(frame.axes.col(k), -half, 1.0f, 2 * half + 1, across(first));
      const float top = *std::max_element(s.begin(), s.end());
      double sum = 0.0, moment = 0.0;
      for (std::size_t i = 0; i < s.size(); ++i) {
        const double r = static_cast<double>(i) - half;
        const double away = (r - frame.axes.col(k).dot(expected_)) / (kPriorWidth * reach_);
        const double weight = std::exp(kSharpness * (s[i] - top) - 0.5 * away * away);
        sum += weight;
        moment += weight * r;
      }
      center += static_cast<float>(moment / sum) * frame.axes.col(k);
    }
    return center;
  }

  Eigen::Isometry3d poseOf(const Eigen::Matrix3d& axes, const Eigen::Vector3d& center) const {
    Eigen::Isometry3d T_canonical_input = Eigen::Isometry3d::Identity();
    T_canonical_input.linear() = axes.transpose();
    T_canonical_input.translation() = -axes.transpose() * center;
    return T_canonical_input;
  }

  /// Signs by the third moments about the center.
  Eigen::Matrix3d oriented(const Eigen::Matrix3f& axes, const Eigen::Vector3d& center) const {
    Eigen::Matrix3d result = axes.cast<double>();
    result.col(1) = (result.col(1) - result.col(0).dot(result.col(1)) * result.col(0)).normalized();
    result.col(2) = result.col(0).cross(result.col(1)) *
                    (result.col(0).cross(result.col(1)).dot(axes.col(2).cast<double>()) < 0.0 ? -1.0 : 1.0);
    for (int k = 1; k < 3; ++k) {
      double moment = 0.0;
      for (Eigen::Index i = 0; i < points_.cols(); ++i)
        moment += std::pow(result.col(k).dot(points_.col(i).cast<double>() - center), 3);
      if (moment < 0.0) result.col(k) *= -1.0;
    }
    result.col(0) = result.col(1).cross(result.col(2));
    return result;
  }

  SymmetryFrame result(const std::vector<Hypothesis>& frames) {
    const Hypothesis& best = frames.front();
    SymmetryFrame frame;
    frame.center = toInput(centerOf(best));
    frame.axes = oriented(best.axes, frame.center);
    frame.scores = best.scores.cast<double>();
    frame.T_canonical_input = poseOf(frame.axes, frame.center);
    frame.revolution_axis = revolutionAxis(best);
    addEquivalent(frame, frame.axes, frame.center);
    for (const Hypothesis& other : frames) {
      constexpr int kOrders[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
      const Eigen::Vector3d center = &other == &best ? frame.center : toInput(centerOf(other));
      for (const auto& order : kOrders) {
        bool tied = true;
        Eigen::Matrix3f axes;
        for (int k = 0; k < 3; ++k) {
          tied &= other.scores[order[k]] >= best.scores[k] - options_.tie;
          axes.col(k) = other.axes.col(order[k]);
        }
        if (tied) addEquivalent(frame, oriented(axes, center), center);
      }
    }
    lap("equivalent");
    frame.timing_ms = timing_;
    return frame;
  }

  void addEquivalent(SymmetryFrame& frame, const Eigen::Matrix3d& axes, const Eigen::Vector3d& center) const {
    const double kSame = 5.0 * kDegree;
    for (const Eigen::Vector3d& signs : {Eigen::Vector3d(1, 1, 1), Eigen::Vector3d(1, -1, -1),
                                         Eigen::Vector3d(-1, 1, -1), Eigen::Vector3d(-1, -1, 1)}) {
      const Eigen::Isometry3d T = poseOf(axes * signs.asDiagonal(), center);
      const bool known = std::any_of(frame.equivalent.begin(), frame.equivalent.end(), [&](const auto& other) {
        return Eigen::AngleAxisd(T.linear() * other.linear().transpose()).angle() < kSame;
      });
      if (!known) frame.equivalent.push_back(T);
    }
  }

  int revolutionAxis(const Hypothesis& frame) const {
    constexpr int kAngles = 8;
    const Eigen::Vector3f center = centerOf(frame);
    int axis = -1, count = 0;
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3f u = frame.axes.col((k + 1) % 3), v = frame.axes.col((k + 2) % 3);
      float lowest = 2.0f, highest = 0.0f;
      for (int a = 0; a < kAngles; ++a) {
        const float angle = static_cast<float>(M_PI * a / kAngles);
        const Eigen::Vector3f normal = std::cos(angle) * u + std::sin(angle) * v;
        const float s = nearby(normal, normal.dot(center), nullptr).second;
        lowest = std::min(lowest, s);
        highest = std::max(highest, s);
      }
      if (lowest < highest - options_.tie) continue;
      axis = k;
      ++count;
    }
    return count >= 2 ? 3 : axis;
  }

  const PointsRef& points_;
  const FrameOptions& options_;
  const Visibility* visibility_;
  Stopwatch watch_;
  std::vector<std::pair<std::string, double>> timing_;
  GaussianEdt edt_;
  std::vector<float> free_;
  PlaneProfiles profiles_;
  SurfaceDirections directions_;
  Eigen::Vector3d middle_;
  float reach_;
  Eigen::Vector3f mass_;
  Eigen::Vector3f expected_;  // where the center of the whole is likely: behind what was seen
};

/// Sections 5.1 as it stands.
SymmetryFrame publishedFrame(const PointsRef& points, const FrameOptions& options) {
  const GaussianEdt edt(points, options.edt);
  const PlaneGrid grid(options.num_theta, options.num_phi, options.num_radius, edt.center(), edt.radius());
  SampledTransformOptions sampling;
  sampling.num_samples = options.num_samples;
  sampling.seed = options.seed;
  sampling.num_threads = options.num_threads;
  const SymmetryMap map = sampledTransform(edt, grid, sampling);
  const PlaneGrid::Bin bin = map.grid.bin(map.strongest());
  const Eigen::Vector3d first = grid.normal(bin.theta, bin.phi);
  const double first_offset = grid.offset(bin.radius);
  const PlaneProfiles profiles(edt, {}, 4 * options.num_samples, options.seed, options.num_threads);
  const Eigen::Vector3d middle = edt.origin() + Eigen::Vector3d::Constant(0.5 * (edt.numCells() - 1) * edt.cellSize());
  const Eigen::Vector3d shift = (edt.center() - middle) / edt.cellSize();
  const auto bestOffset = [&](const Eigen::Vector3d& n) {
    const float step = static_cast<float>(grid.radiusStep() / edt.cellSize());
    const float start = static_cast<float>((n.dot(shift) + grid.offset(0) / edt.cellSize()));
    const std::vector<float> s = profiles.scores(n.cast<float>(), start, step, grid.numRadius());
    const auto at = std::max_element(s.begin(), s.end()) - s.begin();
    return std::pair(grid.offset(static_cast<int>(at)), s[at]);
  };
  const Eigen::Vector3d u = first.unitOrthogonal(), v = first.cross(u);
  std::vector<std::pair<double, float>> turned(grid.numPhi());
  parallelBlocks(turned.size(), options.num_threads, [&](std::size_t i) {
    const double angle = M_PI * static_cast<double>(i) / grid.numPhi();
    turned[i] = bestOffset(std::cos(angle) * u + std::sin(angle) * v);
  });
  const auto at =
      std::max_element(turned.begin(), turned.end(), [](const auto& a, const auto& b) { return a.second < b.second; }) -
      turned.begin();
  const double angle = M_PI * static_cast<double>(at) / grid.numPhi();
  SymmetryFrame frame;
  frame.axes.col(0) = first;
  frame.axes.col(1) = std::cos(angle) * u + std::sin(angle) * v;
  frame.axes.col(2) = frame.axes.col(0).cross(frame.axes.col(1));
  const auto [third_offset, third_score] = bestOffset(frame.axes.col(2));
  frame.center = edt.center() + first_offset * frame.axes.col(0) + turned[at].first * frame.axes.col(1) +
                 third_offset * frame.axes.col(2);
  frame.scores << map[map.strongest()], turned[at].second, third_score;
  frame.T_canonical_input.linear() = frame.axes.transpose();
  frame.T_canonical_input.translation() = -frame.axes.transpose() * frame.center;
  frame.equivalent.push_back(frame.T_canonical_input);
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
  if (options.as_published) return publishedFrame(points, options);
  FrameSearch search(points, options, visibility);
  return search.run();
}

}  // namespace pcl_symmetry
