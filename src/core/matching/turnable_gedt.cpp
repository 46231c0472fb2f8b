#include "core/matching/turnable_gedt.h"

#include <array>
#include <cmath>
#include <cstddef>

#include "core/matching/signature_axes.h"
#include "core/geometry/axis_rotations.h"
#include "pcl_symmetry/core/gaussian_edt.h"

namespace pcl_symmetry {

namespace {

constexpr int kSideOfGEDT = kTurnableGEDTCells;                 // derived: a shorter name
constexpr std::size_t kNumCellsOfGEDT = kTurnableGEDTSize / 2;  // derived: of one cube
constexpr int kFineSideOfGEDT = 2 * kSideOfGEDT;                // derived: each cell is the mean of eight
// Radius of the ball in mean distances of the points from the middle. chosen: as those of turnablePRST().
constexpr double kRadiusOfGEDT = 2.2, kStretchedRadiusOfGEDT = 2.0;

/// f of one shape, of unit norm.
/// \param points about their middle, in the axes.
/// \param radius of the ball, in mean distances of the points from the middle.
/// \param cube kNumCellsOfGEDT values, 0 before.
void fillGEDT(const Points& points, double radius, float* cube) {
  GaussianEdtOptions options;
  options.num_cells = kFineSideOfGEDT;
  options.num_threads = 1;
  options.radius = 1.0;
  const double scale = radius * points.colwise().norm().mean();
  const GaussianEdt edt(points / static_cast<float>(scale), options);
  const std::vector<float>& fine = edt.values();
  for (std::size_t i = 0; i < fine.size(); ++i) {
    const std::size_t x = i % kFineSideOfGEDT, y = i / kFineSideOfGEDT % kFineSideOfGEDT,
                      z = i / (kFineSideOfGEDT * kFineSideOfGEDT);
    cube[((z / 2) * kSideOfGEDT + y / 2) * kSideOfGEDT + x / 2] += fine[i];
  }
  Eigen::Map<Eigen::VectorXf>(cube, kNumCellsOfGEDT).stableNormalize();
}

/// For each cell of a rotated cube, the cell that moves there.
using CellRotation = std::array<int, kNumCellsOfGEDT>;

CellRotation makeCellRotation(const Eigen::Matrix3i& rotation) {
  CellRotation source;
  for (int i = 0; i < static_cast<int>(kNumCellsOfGEDT); ++i) {
    // Twice the places of the cells about the middle are whole numbers.
    const Eigen::Vector3i to =
        2 * Eigen::Vector3i(i % kSideOfGEDT, i / kSideOfGEDT % kSideOfGEDT, i / (kSideOfGEDT * kSideOfGEDT)) -
        Eigen::Vector3i::Constant(kSideOfGEDT - 1);
    const Eigen::Vector3i from = (rotation.transpose() * to + Eigen::Vector3i::Constant(kSideOfGEDT - 1)) / 2;
    source[static_cast<std::size_t>(i)] = (from.z() * kSideOfGEDT + from.y()) * kSideOfGEDT + from.x();
  }
  return source;
}

}  // namespace

std::vector<float> turnableGEDT(const PointsRef& points, const Eigen::Matrix3d& axes) {
  const Points turned = aboutMiddle(inRadii(points), axes);
  std::vector<float> gedt(kTurnableGEDTSize);
  fillGEDT(turned, kRadiusOfGEDT, gedt.data());
  fillGEDT(stretched(turned), kStretchedRadiusOfGEDT, gedt.data() + kNumCellsOfGEDT);
  for (float& value : gedt) value *= static_cast<float>(std::sqrt(0.5));
  return gedt;
}

void rotateTurnableGEDT(const float* gedt, int rotation, float* rotated) {
  static const std::vector<CellRotation> tables = [] {
    std::vector<CellRotation> made;
    for (const Eigen::Matrix3i& matrix : axisRotations()) made.push_back(makeCellRotation(matrix));
    return made;
  }();
  const CellRotation& source = tables[static_cast<std::size_t>(rotation)];
  for (std::size_t shape = 0; shape < 2; ++shape, gedt += kNumCellsOfGEDT, rotated += kNumCellsOfGEDT)
    for (std::size_t i = 0; i < kNumCellsOfGEDT; ++i) rotated[i] = gedt[source[i]];
}

}  // namespace pcl_symmetry
