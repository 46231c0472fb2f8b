#include "core/scan/picture_frame.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <limits>
#include <optional>

#include "core/base/constants.h"
#include "core/base/median.h"
#include "pcl_symmetry/core/closest_point_search.h"

namespace pcl_symmetry {

namespace {

// Points whose neighbours show the grid. chosen: half is as good for a picture without noise, twice takes longer.
constexpr std::size_t kGridSamples = 1000;
constexpr int kGridNeighbours = 4;  // derived: a pixel has as many in a grid of squares
// Length of the mean of exp(4 i angle) over the directions to the neighbours. measured: scans of develop classes (fold
// 1) have 0.9 to 0.98, 0.5 and less where an inferred viewpoint is off by 20 degrees; points without order have 0.05.
// chosen: at half, chance decides what rows are, at 0.75, one in twenty scans has no grid.
constexpr double kLeastGrid = 0.5;
// Radians: how far a side may be off the direction of the rows, and the step of the search. derived: the middle of the
// points is up to 0.1 radians off the middle of the picture, and sides are 0.4 radians apart: their directions differ
// by the product. chosen: half of the step finds no more sides.
constexpr double kLargestTurn = 0.044, kTurnStep = 0.0044;
// Points of the last row, and their number over the mean of the next two rows. measured: on 138 scans of develop
// classes, 82 of 89 cut sides with five points and more pass, and 62 of 437 ends of objects, most of them straight.
// chosen: half of the points takes round ends for cut ones, twice loses cut legs; at 0.9, 73 and 44 pass.
constexpr int kLeastPoints = 10;
constexpr double kLeastRatio = 0.8;
constexpr double kHalfRow = 0.5;  // rows. derived: from the middle of the last pixels to their end

using Places = std::vector<Eigen::Array2d>;

/// Rows of places: their direction, one of four at right angles, and the distance of neighbours.
struct PixelRows {
  double angle;
  double pitch;
};

std::optional<PixelRows> rowsOf(const Places& places) {
  Points flat = Points::Zero(3, static_cast<Eigen::Index>(places.size()));
  for (std::size_t i = 0; i < places.size(); ++i)
    flat.col(static_cast<Eigen::Index>(i)).head<2>() = places[i].matrix().cast<float>();
  const auto stride = static_cast<Eigen::Index>(1 + (places.size() - 1) / kGridSamples);
  Points samples(3, (flat.cols() + stride - 1) / stride);
  for (Eigen::Index i = 0; i < samples.cols(); ++i) samples.col(i) = flat.col(i * stride);
  std::vector<int> closest;
  std::vector<float> sq_distances, distances;
  constexpr int kCount = kGridNeighbours + 1;  // derived: the closest point is the sample itself
  makeFlannSearch(flat)->search(samples, kCount, closest, sq_distances);
  std::complex<double> sum = 0.0;
  for (std::size_t k = 0; k < closest.size(); ++k) {
    const auto sample = static_cast<Eigen::Index>(k) / kCount;
    const Eigen::Vector3f d = flat.col(closest[k]) - samples.col(sample);
    if (!(sq_distances[k] > 0.0f)) continue;
    sum += std::polar(1.0, 4.0 * std::atan2(d.y(), d.x()));
    distances.push_back(std::sqrt(sq_distances[k]));
  }
  if (distances.empty() || std::abs(sum) < kLeastGrid * static_cast<double>(distances.size())) return std::nullopt;
  return PixelRows{std::arg(sum) / 4.0, median(distances)};
}

/// The line that all places lie behind, and how many lie in the three rows next to it.
struct LastRows {
  FrameSide side;
  std::array<int, 3> counts{};

  bool areCut() const { return counts[0] >= kLeastPoints && counts[0] >= kLeastRatio * 0.5 * (counts[1] + counts[2]); }
};

LastRows lastRows(const Places& places, double angle, double pitch) {
  LastRows rows{{{std::cos(angle), std::sin(angle)}, -std::numeric_limits<double>::infinity()}, {}};
  for (const Eigen::Array2d& place : places)
    rows.side.offset = std::max(rows.side.offset, rows.side.normal.dot(place.matrix()));
  for (const Eigen::Array2d& place : places) {
    const double row = (rows.side.offset - rows.side.normal.dot(place.matrix())) / pitch;
    if (row < static_cast<double>(rows.counts.size())) ++rows.counts[static_cast<std::size_t>(row)];
  }
  return rows;
}

/// Those of the places that may be in the last rows at any turn of the side.
Places nearSide(const Places& places, double angle, double pitch) {
  const Eigen::Vector2d normal(std::cos(angle), std::sin(angle));
  Eigen::Array2d low = places.front(), high = places.front();
  double offset = -std::numeric_limits<double>::infinity();
  for (const Eigen::Array2d& place : places) {
    low = low.min(place);
    high = high.max(place);
    offset = std::max(offset, normal.dot(place.matrix()));
  }
  const double depth = kLargestTurn * (high - low).matrix().norm() + 4.0 * pitch;
  Places near;
  for (const Eigen::Array2d& place : places)
    if (normal.dot(place.matrix()) > offset - depth) near.push_back(place);
  return near;
}

}  // namespace

std::vector<FrameSide> frameSides(const Places& places) {
  std::vector<FrameSide> sides;
  if (places.size() <= static_cast<std::size_t>(kGridNeighbours)) return sides;
  const std::optional<PixelRows> rows = rowsOf(places);
  if (!rows) return sides;
  for (int quarter = 0; quarter < 4; ++quarter) {
    const double ahead = rows->angle + 0.5 * kPi * quarter;
    const Places near = nearSide(places, ahead, rows->pitch);
    std::optional<LastRows> best;
    const int num_steps = static_cast<int>(std::lround(kLargestTurn / kTurnStep));
    for (int step = -num_steps; step <= num_steps; ++step) {
      LastRows last = lastRows(near, ahead + kTurnStep * step, rows->pitch);
      if (!best || last.counts[0] > best->counts[0]) best = last;
    }
    if (!best->areCut()) continue;
    best->side.offset += kHalfRow * rows->pitch;
    sides.push_back(best->side);
  }
  return sides;
}

}  // namespace pcl_symmetry
