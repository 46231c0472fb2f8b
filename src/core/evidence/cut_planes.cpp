#include "core/evidence/cut_planes.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>

#include "core/base/random.h"
#include "core/evidence/evidence_rules.h"

namespace pcl_symmetry {

namespace {

/// Three points fix a plane if they are not along a line.
std::optional<CutPlane> planeThrough(const Eigen::Vector3f& a, const Eigen::Vector3f& b, const Eigen::Vector3f& c,
                                     float spacing) {
  const Eigen::Vector3f across = (b - a).cross(c - a);
  const float longest = std::max({(b - a).norm(), (c - a).norm(), (c - b).norm()});
  // The height of the triangle, compared with the error of its points.
  if (!(across.norm() > 2.0f * kEvidence.cut_band * spacing * longest)) return std::nullopt;
  const Eigen::Vector3f normal = across.normalized();
  return CutPlane{normal, normal.dot(a)};
}

class CutSearch {
public:
  CutSearch(const Points& points, const std::vector<char>& borders, float spacing)
      : points_(points), borders_(borders), band_(kEvidence.cut_band * spacing), spacing_(spacing) {
    for (std::size_t i = 0; i < borders.size(); ++i)
      if (borders[i]) free_.push_back(static_cast<Eigen::Index>(i));
    middle_ = points.rowwise().mean();
  }

  /// The cut with most of the border points that no other cut has; nothing where there is none.
  std::optional<CutPlane> next(RandomStream& random) {
    std::optional<CutPlane> best;
    std::size_t most = kEvidence.least_of_cut - 1;
    if (free_.size() <= most) return best;
    const auto any = [&]() -> Eigen::Vector3f { return points_.col(free_[random.below(free_.size())]); };
    for (int draw = 0; draw < kEvidence.cut_draws; ++draw) {
      const Eigen::Vector3f a = any(), b = any(), c = any();
      std::optional<CutPlane> plane = planeThrough(a, b, c, spacing_);
      if (!plane) continue;
      if (plane->normal.dot(middle_) > plane->offset) *plane = {-plane->normal, -plane->offset};
      if (leavesPointsBeyond(*plane)) continue;
      const std::size_t count = bordersAt(*plane).size();
      if (count <= most) continue;
      most = count;
      best = plane;
    }
    if (best) best = fitted(*best);
    if (!best) return best;
    const std::vector<Eigen::Index> used = bordersAt(*best);
    free_.erase(std::remove_if(free_.begin(), free_.end(),
                               [&](Eigen::Index i) { return std::binary_search(used.begin(), used.end(), i); }),
                free_.end());
    return best;
  }

private:
  bool leavesPointsBeyond(const CutPlane& plane) const {
    auto left = static_cast<Eigen::Index>(kEvidence.most_beyond * static_cast<double>(points_.cols()));
    for (Eigen::Index i = 0; i < points_.cols(); ++i)
      if (plane.normal.dot(points_.col(i)) > plane.offset + band_ && --left < 0) return true;
    return false;
  }

  std::vector<Eigen::Index> bordersAt(const CutPlane& plane) const {
    std::vector<Eigen::Index> found;
    for (const Eigen::Index i : free_)
      if (std::abs(plane.normal.dot(points_.col(i)) - plane.offset) <= band_) found.push_back(i);
    return found;
  }

  /// The plane that fits its border points best; nothing where they fix no plane, or where the surface goes on.
  std::optional<CutPlane> fitted(const CutPlane& start) const {
    const std::vector<Eigen::Index> at = bordersAt(start);
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const Eigen::Index i : at) mean += points_.col(i).cast<double>() / static_cast<double>(at.size());
    Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
    for (const Eigen::Index i : at) {
      const Eigen::Vector3d d = points_.col(i).cast<double>() - mean;
      squares += d * d.transpose() / static_cast<double>(at.size());
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(squares);
    const double least = kEvidence.least_spread * spacing_;
    if (!(solver.eigenvalues()[1] > least * least)) return std::nullopt;
    Eigen::Vector3f normal = solver.eigenvectors().col(0).cast<float>();
    if (normal.dot(start.normal) < 0.0f) normal = -normal;
    const CutPlane plane{normal, normal.dot(mean.cast<float>())};
    if (leavesPointsBeyond(plane)) return std::nullopt;
    std::size_t num_near = 0, num_at_border = 0;
    for (Eigen::Index i = 0; i < points_.cols(); ++i) {
      if (plane.normal.dot(points_.col(i)) < plane.offset - spacing_) continue;
      ++num_near;
      num_at_border += borders_[static_cast<std::size_t>(i)] ? 1 : 0;
    }
    if (static_cast<double>(num_at_border) < kEvidence.least_at_border * static_cast<double>(num_near))
      return std::nullopt;
    return plane;
  }

  const Points& points_;
  const std::vector<char>& borders_;
  const float band_, spacing_;
  std::vector<Eigen::Index> free_;  // border points that no cut has, in order
  Eigen::Vector3f middle_;
};

}  // namespace

std::vector<CutPlane> findCutPlanes(const Points& points, const std::vector<char>& borders, double spacing,
                                    std::uint64_t seed) {
  std::vector<CutPlane> cuts;
  CutSearch search(points, borders, static_cast<float>(spacing));
  RandomStream random(seed);
  while (cuts.size() < static_cast<std::size_t>(kEvidence.most_cuts)) {
    const std::optional<CutPlane> cut = search.next(random);
    if (!cut) break;
    cuts.push_back(*cut);
  }
  return cuts;
}

}  // namespace pcl_symmetry
