#include "core/geometry/surface_discs.h"

#include "core/base/median.h"
#include "core/geometry/geometry_rules.h"

namespace pcl_symmetry {

namespace {

constexpr float half_diagonal = 0.8660254f;  // cells: sqrt(3) / 2

}  // namespace

SurfaceDiscs::SurfaceDiscs(const Points& samples, const LocalGeometry& geometry, float disc_radius, float reach)
    : reach_(reach) {
  const auto spacing = static_cast<float>(median(geometry.spacing));
  float greatest = 0.0f;
  for (Eigen::Index i = 0; i < samples.cols(); ++i) {
    discs_.push_back({samples.col(i), geometry.normals.col(i),
                      disc_radius * std::min(geometry.spacing[i], kGeometry.max_disc_spacing * spacing)});
    greatest = std::max(greatest, discs_.back().radius);
  }
  const float margin = reach + greatest;
  const Eigen::Vector3f low = samples.rowwise().minCoeff(), high = samples.rowwise().maxCoeff();
  const float extent = (high - low).maxCoeff() + 2.0f * margin;
  cell_size_ = std::max(kGeometry.disc_cell * spacing, extent / kGeometry.max_disc_cells);
  origin_ = low.array() - margin;
  const Eigen::Array3f sides = (high - low).array() + 2.0f * margin;
  size_ = (sides / cell_size_).cast<int>() + 1;
  // Counts, then positions: two passes over the same cells.
  first_.assign(static_cast<std::size_t>(size_.prod()) + 1, 0);
  for (const SurfaceDisc& disc : discs_) visitCells(disc, [&](std::size_t cell) { ++first_[cell + 1]; });
  for (std::size_t cell = 1; cell < first_.size(); ++cell) first_[cell] += first_[cell - 1];
  entries_.resize(static_cast<std::size_t>(first_.back()));
  std::vector<int> next = first_;
  for (std::size_t i = 0; i < discs_.size(); ++i)
    visitCells(discs_[i], [&](std::size_t cell) { entries_[next[cell]++] = static_cast<int>(i); });
}

/// Calls visit(cell) for the cells that hold points within reach of a disc, and for some more.
template <typename Visit>
void SurfaceDiscs::visitCells(const SurfaceDisc& disc, const Visit& visit) const {
  const float beside = disc.radius + reach_, slack = half_diagonal * cell_size_;
  const Eigen::Array3f low = (disc.center - origin_).array() - beside, high = low + 2.0f * beside;
  const Eigen::Array3i from = (low / cell_size_).max(0.0f).cast<int>();
  const Eigen::Array3i to = (high / cell_size_).cast<int>().min(size_ - 1);
  for (int z = from.z(); z <= to.z(); ++z)
    for (int y = from.y(); y <= to.y(); ++y)
      for (int x = from.x(); x <= to.x(); ++x) {
        const Eigen::Vector3f center =
            origin_ +
            cell_size_ *
                (Eigen::Vector3f(static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)).array() + 0.5f)
                    .matrix();
        const Eigen::Vector3f difference = center - disc.center;
        if (std::abs(disc.normal.dot(difference)) > reach_ + slack) continue;
        if (difference.squaredNorm() > (beside + slack) * (beside + slack)) continue;
        visit((static_cast<std::size_t>(z) * size_.y() + y) * size_.x() + x);
      }
}

SurfaceDiscs::Range SurfaceDiscs::discsNear(const Eigen::Vector3f& x) const {
  const Eigen::Array3f position = (x - origin_).array() / cell_size_;
  if (!(position >= 0.0f).all()) return {nullptr, nullptr};
  const Eigen::Array3i cell = position.min(static_cast<float>(kGeometry.max_disc_cells) + 2.0f).cast<int>();
  if (!(cell < size_).all()) return {nullptr, nullptr};
  const std::size_t index = (static_cast<std::size_t>(cell.z()) * size_.y() + cell.y()) * size_.x() + cell.x();
  return {entries_.data() + first_[index], entries_.data() + first_[index + 1]};
}

SurfaceDiscs::Nearest SurfaceDiscs::nearest(const Eigen::Vector3f& x) const {
  Nearest result;
  float least = reach_ * reach_;
  const Range range = discsNear(x);
  for (const int* disc = range.begin; disc != range.end; ++disc) {
    const float sq_distance = discs_[*disc].sqDistance(x);
    if (!(sq_distance <= least)) continue;
    least = sq_distance;
    result.disc = *disc;
  }
  if (result.disc >= 0) result.distance = std::sqrt(least);
  return result;
}

bool SurfaceDiscs::isWithin(const Eigen::Vector3f& x, float distance) const {
  const float sq_limit = distance * distance;
  const Range range = discsNear(x);
  for (const int* disc = range.begin; disc != range.end; ++disc) {
    const SurfaceDisc& d = discs_[*disc];
    const Eigen::Vector3f difference = x - d.center;
    const float across = d.normal.dot(difference), sq_room = sq_limit - across * across;
    if (sq_room < 0.0f) continue;
    const float sq_along = difference.squaredNorm() - across * across;
    if (sq_along <= d.radius * d.radius) return true;
    const float most = d.radius + distance;
    if (sq_along > most * most) continue;
    const float beside = std::sqrt(sq_along) - d.radius;
    if (beside * beside <= sq_room) return true;
  }
  return false;
}

float SurfaceDiscs::ownDistance(int i, float across_factor) const {
  const Eigen::Vector3f& x = discs_[i].center;
  float least = std::numeric_limits<float>::infinity();
  const Range range = discsNear(x);
  for (const int* disc = range.begin; disc != range.end; ++disc)
    if (*disc != i) least = std::min(least, discs_[*disc].sqDistance(x, across_factor * across_factor));
  return std::sqrt(least);
}

}  // namespace pcl_symmetry
