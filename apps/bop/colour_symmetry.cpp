#include "bop/colour_symmetry.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>
#include <vector>

#include "core/base/constants.h"
#include "core/geometry/directions.h"

namespace pcl_symmetry::apps {

namespace {

// Share of the surface whose colour a symmetry may change. chosen: half refuses scans with uneven light, twice
// overlooks a label.
constexpr double kMostChanged = 0.05;
// Samples around a place that may have its colour. chosen: half takes the edge of a pattern for a difference, twice
// overlooks thin lines.
constexpr int kNumColoursNear = 4;
// Turns that stand for all turns about an axis. chosen: half takes stripes for one colour, twice takes twice the time.
constexpr int kNumTurns = 8;
// Greatest fold of stripes. chosen: half overlooks fine patterns, at twice that samples are as far apart as stripes.
constexpr int kMaxFold = 24;

Eigen::Isometry3d turnAbout(const Eigen::Vector3d& axis, double angle, const Eigen::Vector3d& center) {
  return motionFixing(center, rotationAbout(axis, angle));
}

/// The motions that keep the colours and are a group: the worst one goes until the rest is.
ObjectSymmetries finiteGroup(const std::vector<Eigen::Isometry3d>& motions, const ColouredSurface& surface) {
  std::vector<std::pair<double, std::size_t>> kept;  // changed share and index
  for (std::size_t i = 0; i < motions.size(); ++i) {
    const double changed = surface.changedShare(motions[i]);
    if (changed <= kMostChanged) kept.emplace_back(changed, i);
  }
  std::sort(kept.begin(), kept.end());
  for (; !kept.empty(); kept.pop_back()) {
    std::vector<Eigen::Isometry3d> rest;
    for (const auto& [changed, i] : kept) rest.push_back(motions[i]);
    try {
      const ObjectSymmetries group = ObjectSymmetries::from(rest, {});
      if (group.discrete.size() == rest.size()) return group;
    } catch (const std::invalid_argument&) {
    }
  }
  return ObjectSymmetries::from({}, {});
}

/// The turns about an axis by the greatest number of equal steps that keep the colours.
std::vector<Eigen::Isometry3d> keptTurns(const ContinuousSymmetry& axis, const ColouredSurface& surface) {
  for (int fold = kMaxFold; fold > 1; --fold) {
    std::vector<Eigen::Isometry3d> turns;
    for (int k = 1; k < fold; ++k) turns.push_back(turnAbout(axis.axis, 2.0 * kPi * k / fold, axis.offset));
    if (std::all_of(turns.begin(), turns.end(), [&](const auto& turn) { return surface.keeps(turn); })) return turns;
  }
  return {};
}

/// The half turn about a line across an axis that changes least.
Eigen::Isometry3d bestFlip(const ContinuousSymmetry& axis, const ColouredSurface& surface) {
  constexpr int kNumLines = 90;  // chosen: 2 degrees apart; half misses fine stripes, twice takes twice the time
  const Eigen::Vector3d across = axis.axis.unitOrthogonal();
  Eigen::Isometry3d best = turnAbout(across, kPi, axis.offset);
  double least = surface.changedShare(best);
  for (int k = 1; k < kNumLines; ++k) {
    const Eigen::Isometry3d flip = turnAbout(rotationAbout(axis.axis, kPi * k / kNumLines) * across, kPi, axis.offset);
    const double changed = surface.changedShare(flip);
    if (changed >= least) continue;
    least = changed;
    best = flip;
  }
  return best;
}

ObjectSymmetries roundGroup(const ObjectSymmetries& found, const ColouredSurface& surface) {
  const ContinuousSymmetry& axis = found.continuous.front();
  bool is_round = true;
  for (int k = 1; k <= kNumTurns && is_round; ++k)
    is_round = surface.keeps(turnAbout(axis.axis, 2.0 * kPi * goldenFraction(k), axis.offset));
  std::vector<Eigen::Isometry3d> kept = is_round ? std::vector<Eigen::Isometry3d>{} : keptTurns(axis, surface);
  if (!found.discrete.empty()) {
    const Eigen::Isometry3d flip = bestFlip(axis, surface);
    if (surface.keeps(flip)) kept.push_back(flip);
  }
  return ObjectSymmetries::from(kept, is_round ? found.continuous : std::vector<ContinuousSymmetry>{});
}

/// Of a ball with a pattern only turns about the coordinate axes are looked for.
ObjectSymmetries sphereGroup(const ObjectSymmetries& found, const ColouredSurface& surface) {
  std::vector<Eigen::Isometry3d> turns;
  for (const Eigen::Vector3d& direction : evenDirections(kNumTurns))
    turns.push_back(turnAbout(direction, 2.0 * kPi * goldenFraction(static_cast<int>(turns.size()) + 1), found.center));
  if (std::all_of(turns.begin(), turns.end(), [&](const auto& turn) { return surface.keeps(turn); })) return found;
  for (int k = 0; k < 3; ++k) {
    ObjectSymmetries one_axis = found;
    one_axis.continuous = {found.continuous[static_cast<std::size_t>(k)]};
    one_axis.discrete = {turnAbout(one_axis.continuous[0].axis.unitOrthogonal(), kPi, found.center)};
    const ObjectSymmetries group = roundGroup(one_axis, surface);
    if (group.name() != "C1") return group;
  }
  return ObjectSymmetries::from({}, {});
}

}  // namespace

Eigen::Vector3f labOf(const Eigen::Vector3f& rgb) {
  // The transfer curve of sRGB (IEC 61966-2-1), its primaries, and CIELAB relative to D65.
  const auto linear = [](float c) { return c <= 0.04045f ? c / 12.92f : std::pow((c + 0.055f) / 1.055f, 2.4f); };
  Eigen::Matrix3f xyz_rgb;
  xyz_rgb << 0.4124f, 0.3576f, 0.1805f, 0.2126f, 0.7152f, 0.0722f, 0.0193f, 0.1192f, 0.9505f;
  const Eigen::Vector3f white(0.9505f, 1.0f, 1.089f);
  const Eigen::Vector3f xyz = (xyz_rgb * rgb.unaryExpr(linear)).cwiseQuotient(white);
  const auto curve = [](float t) { return t > 0.008856f ? std::cbrt(t) : 7.787f * t + 16.0f / 116.0f; };
  const Eigen::Vector3f f = xyz.unaryExpr(curve);
  return {116.0f * f.y() - 16.0f, 500.0f * (f.x() - f.y()), 200.0f * (f.y() - f.z())};
}

ColouredSurface::ColouredSurface(const SurfaceColours& colours, Points points, double tolerance)
    : points_(std::move(points)), tolerance_(tolerance), search_(makeFlannSearch(points_)) {
  std::vector<int> closest;
  std::vector<float> ignored;
  makeFlannSearch(colours.points)->search(points_, 1, closest, ignored);
  lab_.resize(3, points_.cols());
  for (Eigen::Index i = 0; i < points_.cols(); ++i)
    lab_.col(i) = labOf(colours.rgb.col(closest[static_cast<std::size_t>(i)]));
}

double ColouredSurface::changedShare(const Eigen::Isometry3d& motion) const {
  const Points moved = (motion.cast<float>() * points_.colwise().homogeneous()).eval();
  std::vector<int> closest;
  std::vector<float> ignored;
  const int num_near = std::min(kNumColoursNear, static_cast<int>(points_.cols()));
  search_->search(moved, num_near, closest, ignored);
  Eigen::Index num_changed = 0;
  for (Eigen::Index i = 0; i < moved.cols(); ++i) {
    float least = (lab_.col(i) - lab_.col(closest[i * num_near])).norm();
    for (int k = 1; k < num_near; ++k)
      least = std::min(least, (lab_.col(i) - lab_.col(closest[i * num_near + k])).norm());
    num_changed += least > tolerance_;
  }
  return static_cast<double>(num_changed) / static_cast<double>(moved.cols());
}

bool ColouredSurface::keeps(const Eigen::Isometry3d& motion) const {
  return changedShare(motion) <= kMostChanged;
}

ObjectSymmetries keepingColours(const ObjectSymmetries& found, const ColouredSurface& surface) {
  ObjectSymmetries kept;
  if (found.kind == RotationGroupKind::Spherical)
    kept = sphereGroup(found, surface);
  else if (isContinuous(found.kind))
    kept = roundGroup(found, surface);
  else
    kept = finiteGroup(found.discrete, surface);
  // What the shape says of its symmetries holds for those that are left; their axes pass through the same point.
  kept.support = found.support;
  kept.confidence = found.confidence;
  kept.timing_ms = found.timing_ms;
  kept.center = found.center;
  for (ContinuousSymmetry& symmetry : kept.continuous) symmetry.offset = found.center;
  return kept;
}

}  // namespace pcl_symmetry::apps
