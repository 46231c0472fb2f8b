#include "core/scan/picture_frame.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <limits>
#include <optional>

#include "core/base/constants.h"
#include "core/base/median.h"
#include "core/scan/scan_rules.h"
#include "pcl_symmetry/core/closest_point_search.h"

namespace pcl_symmetry {

namespace {

using Positions = std::vector<Eigen::Array2d>;

/// Rows of positions: their direction, one of four at right angles, and the distance of neighbors.
struct PixelRows {
  double angle;
  double pitch;
};

std::optional<PixelRows> rowsOf(const Positions& positions) {
  Points flat = Points::Zero(3, static_cast<Eigen::Index>(positions.size()));
  for (std::size_t i = 0; i < positions.size(); ++i)
    flat.col(static_cast<Eigen::Index>(i)).head<2>() = positions[i].matrix().cast<float>();
  const auto stride = static_cast<Eigen::Index>(1 + (positions.size() - 1) / kScan.grid_samples);
  Points samples(3, (flat.cols() + stride - 1) / stride);
  for (Eigen::Index i = 0; i < samples.cols(); ++i) samples.col(i) = flat.col(i * stride);
  std::vector<int> closest;
  std::vector<float> sq_distances, distances;
  makeFlannSearch(flat)->search(samples, kScan.grid_neighbors + 1, closest, sq_distances);
  std::complex<double> sum = 0.0;
  for (std::size_t k = 0; k < closest.size(); ++k) {
    const auto sample = static_cast<Eigen::Index>(k) / (kScan.grid_neighbors + 1);
    const Eigen::Vector3f d = flat.col(closest[k]) - samples.col(sample);
    if (!(sq_distances[k] > 0.0f)) continue;
    sum += std::polar(1.0, 4.0 * std::atan2(d.y(), d.x()));
    distances.push_back(std::sqrt(sq_distances[k]));
  }
  if (distances.empty() || std::abs(sum) < kScan.least_grid * static_cast<double>(distances.size()))
    return std::nullopt;
  return PixelRows{std::arg(sum) / 4.0, median(distances)};
}

/// The line that all positions lie behind, and how many lie in the three rows next to it.
struct LastRows {
  FrameSide side;
  std::array<int, 3> counts{};

  bool areCut() const {
    return counts[0] >= kScan.least_row && counts[0] >= kScan.least_row_ratio * 0.5 * (counts[1] + counts[2]);
  }
};

LastRows lastRows(const Positions& positions, double angle, double pitch) {
  LastRows rows{{{std::cos(angle), std::sin(angle)}, -std::numeric_limits<double>::infinity()}, {}};
  for (const Eigen::Array2d& position : positions)
    rows.side.offset = std::max(rows.side.offset, rows.side.normal.dot(position.matrix()));
  for (const Eigen::Array2d& position : positions) {
    const double row = (rows.side.offset - rows.side.normal.dot(position.matrix())) / pitch;
    if (row < static_cast<double>(rows.counts.size())) ++rows.counts[static_cast<std::size_t>(row)];
  }
  return rows;
}

/// Those of the positions that may be in the last rows at any turn of the side.
Positions nearSide(const Positions& positions, double angle, double pitch) {
  const Eigen::Vector2d normal(std::cos(angle), std::sin(angle));
  Eigen::Array2d low = positions.front(), high = positions.front();
  double offset = -std::numeric_limits<double>::infinity();
  for (const Eigen::Array2d& position : positions) {
    low = low.min(position);
    high = high.max(position);
    offset = std::max(offset, normal.dot(position.matrix()));
  }
  const double depth = kScan.most_side_angle * (high - low).matrix().norm() + 4.0 * pitch;
  Positions near;
  for (const Eigen::Array2d& position : positions)
    if (normal.dot(position.matrix()) > offset - depth) near.push_back(position);
  return near;
}

}  // namespace

std::vector<FrameSide> frameSides(const Positions& positions) {
  std::vector<FrameSide> sides;
  if (positions.size() <= static_cast<std::size_t>(kScan.grid_neighbors)) return sides;
  const std::optional<PixelRows> rows = rowsOf(positions);
  if (!rows) return sides;
  for (int quarter = 0; quarter < 4; ++quarter) {
    const double ahead = rows->angle + 0.5 * kPi * quarter;
    const Positions near = nearSide(positions, ahead, rows->pitch);
    std::optional<LastRows> best;
    const int num_steps = static_cast<int>(std::lround(kScan.most_side_angle / kScan.side_angle_step));
    for (int step = -num_steps; step <= num_steps; ++step) {
      LastRows last = lastRows(near, ahead + kScan.side_angle_step * step, rows->pitch);
      if (!best || last.counts[0] > best->counts[0]) best = last;
    }
    if (!best->areCut()) continue;
    best->side.offset += 0.5 * rows->pitch;
    sides.push_back(best->side);
  }
  return sides;
}

}  // namespace pcl_symmetry
