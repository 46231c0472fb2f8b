#include "core/matching/shape_signature.h"

#include <Eigen/Eigenvalues>
#include <array>
#include <cmath>
#include <cstdint>

#include "core/matching/signature_axes.h"
#include "core/geometry/axis_rotations.h"
#include "core/geometry/principal_axes.h"
#include "core/geometry/cell_normals.h"

namespace pcl_symmetry {

namespace {

constexpr int kSide = kSignatureCells;            // derived: short name
constexpr int kNumCells = kSide * kSide * kSide;  // derived: cells of one cube
// Finer cells, which count as surface or not: the density of the points does not matter. chosen: half the size of a
// cell; at the full size walls fill whole cells, at a quarter gaps between points count as holes.
constexpr int kFineSide = 2 * kSide;
constexpr int kNumFineCells = kFineSide * kFineSide * kFineSide;  // derived: fine cells of one cube
// Half the side of a cube, in mean distances of the points from the middle. chosen: half cuts away the outer parts of
// most shapes, twice leaves most cells empty.
constexpr double kReach = 2.5;
// Cells across the bounding ball, one normal each. chosen: half rounds edges, twice leaves too few points in a cell.
constexpr int kNormalCells = 60;
// derived: rows and columns of the entries of n n^T, in the order of kNumOrientations.
constexpr int kPairs[kNumOrientations][2] = {{0, 0}, {1, 1}, {2, 2}, {1, 2}, {2, 0}, {0, 1}};

using Orientation = Eigen::Matrix<float, kNumOrientations, 1>;

/// The entries of n n^T.
Orientation orientationOf(const Eigen::Vector3f& normal) {
  Orientation products;
  for (int c = 0; c < kNumOrientations; ++c) products[c] = normal[kPairs[c][0]] * normal[kPairs[c][1]];
  return products;
}

struct FineCell {
  Orientation sum = Orientation::Zero();
  int count = 0;
};

/// Adds a value to the eight cells around a place, by trilinear weights.
/// \param place in cells from the corner of the cube.
void spread(const Orientation& value, const Eigen::Array3f& place, float* cells) {
  const Eigen::Array3f corner = (place - 0.5f).floor();
  const Eigen::Array3f t = place - 0.5f - corner;
  const Eigen::Array3i first = corner.cast<int>();
  for (int k = 0; k < 8; ++k) {
    const Eigen::Array3i step(k & 1, k >> 1 & 1, k >> 2);
    const Eigen::Array3i at = first + step;
    if ((at < 0).any() || (at >= kSide).any()) continue;
    const float weight = (step == 1).select(t, 1.0f - t).prod();
    float* cell = cells + (at.z() * kSide + at.y()) * kSide + at.x();
    for (int c = 0; c < kNumOrientations; ++c) cell[c * kNumCells] += weight * value[c];
  }
}

/// Sums of n n^T over the points in each fine cell.
/// \param points about their middle.
/// \param normals of cells, in the axes of the points.
/// \param reach half the side of the cube.
std::vector<FineCell> fineCells(const Points& points, const Eigen::Matrix3Xf& normals,
                                const std::vector<int>& normal_of_points, float reach) {
  std::vector<FineCell> fine(kNumFineCells);
  const float to_fine = kFineSide / (2.0f * reach);
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const Eigen::Array3i at = ((points.col(i).array() + reach) * to_fine).floor().cast<int>();
    if ((at < 0).any() || (at >= kFineSide).any()) continue;
    FineCell& cell = fine[static_cast<std::size_t>((at.z() * kFineSide + at.y()) * kFineSide + at.x())];
    cell.sum += orientationOf(normals.col(normal_of_points[static_cast<std::size_t>(i)]));
    ++cell.count;
  }
  return fine;
}

/// One cube of a signature, of unit norm.
/// \param points about their middle, in the axes.
/// \param normals of cells, in the same axes.
/// \param cube kNumOrientations * kNumCells values, 0 before.
void fillCube(const Points& points, const Eigen::Matrix3Xf& normals, const std::vector<int>& normal_of_points,
              float* cube) {
  const float reach = static_cast<float>(kReach) * points.colwise().norm().mean();
  const std::vector<FineCell> fine = fineCells(points, normals, normal_of_points, reach);
  for (int i = 0; i < kNumFineCells; ++i) {
    const FineCell& cell = fine[static_cast<std::size_t>(i)];
    if (cell.count == 0) continue;
    const Eigen::Array3f at(static_cast<float>(i % kFineSide), static_cast<float>(i / kFineSide % kFineSide),
                            static_cast<float>(i / (kFineSide * kFineSide)));
    spread(cell.sum / static_cast<float>(cell.count), (at + 0.5f) * (static_cast<float>(kSide) / kFineSide), cube);
  }
  Eigen::Map<Eigen::ArrayXf> values(cube, kNumOrientations * kNumCells);
  values = values.sign() * values.abs().sqrt();
  const float norm = values.matrix().norm();
  if (norm > 0.0f) values /= norm;
}

/// For each value of a rotated cube, the index and the sign of the value that moves there.
struct CubeRotation {
  std::array<std::int32_t, kNumOrientations * kNumCells> source;
  std::array<float, kNumOrientations> sign;
};

/// Index of the product of components \p a and \p b in kPairs.
int orientationIndex(int a, int b) {
  return a == b ? a : 6 - a - b;
}

CubeRotation makeCubeRotation(const Eigen::Matrix3i& rotation) {
  // The value at cell x of the rotated cube comes from R^T x, and n n^T becomes R n n^T R^T.
  int from_axis[3], axis_sign[3];
  for (int axis = 0; axis < 3; ++axis)
    axis_sign[axis] = rotation.row(axis).cwiseAbs().maxCoeff(&from_axis[axis]) * rotation.row(axis).sum();
  CubeRotation result;
  for (int c = 0; c < kNumOrientations; ++c) {
    const int a = kPairs[c][0], b = kPairs[c][1];
    const int from_orientation = orientationIndex(from_axis[a], from_axis[b]);
    result.sign[static_cast<std::size_t>(c)] = static_cast<float>(axis_sign[a] * axis_sign[b]);
    for (int i = 0; i < kNumCells; ++i) {
      const int at[3] = {i % kSide, i / kSide % kSide, i / (kSide * kSide)};
      int from[3];
      for (int axis = 0; axis < 3; ++axis)
        from[from_axis[axis]] = axis_sign[axis] > 0 ? at[axis] : kSide - 1 - at[axis];
      result.source[static_cast<std::size_t>(c * kNumCells + i)] =
          from_orientation * kNumCells + (from[2] * kSide + from[1]) * kSide + from[0];
    }
  }
  return result;
}

const CubeRotation& cubeRotation(int rotation) {
  static const std::vector<CubeRotation> rotations = [] {
    std::vector<CubeRotation> made;
    for (const Eigen::Matrix3i& matrix : axisRotations()) made.push_back(makeCubeRotation(matrix));
    return made;
  }();
  return rotations[static_cast<std::size_t>(rotation)];
}

}  // namespace

std::vector<float> shapeSignature(const PointsRef& points, const Eigen::Matrix3d& axes) {
  const Points centered = inRadii(points);
  const CellNormals surface = cellNormals(centered, Eigen::Vector3d::Constant(-1.0), 2.0 / kNormalCells, kNormalCells);
  const Points turned = aboutMiddle(centered, axes);
  const Eigen::Matrix3Xf normals = axes.transpose().cast<float>() * surface.normals;
  std::vector<float> signature(kSignatureSize, 0.0f);
  fillCube(turned, normals, surface.cell_of_points, signature.data());
  fillCube(stretched(turned), normals, surface.cell_of_points, signature.data() + kSignatureSize / 2);
  for (float& value : signature) value *= static_cast<float>(std::sqrt(0.5));
  return signature;
}

std::vector<Eigen::Matrix3d> signatureFrames(const PointsRef& points, const SymmetryFrame& frame) {
  const PrincipalAxes principal = principalAxes(points);
  const Eigen::Vector3d first = frame.axes.col(0);
  Eigen::Matrix<double, 3, 2> across;
  across << first.unitOrthogonal(), first.cross(first.unitOrthogonal());
  const Eigen::Matrix<double, 3, 2> turned = principal.axes.transpose() * across;
  const Eigen::Matrix2d spread_across = turned.transpose() * principal.variances.asDiagonal() * turned;
  // A matrix of two rows is tridiagonal as it is; Eigen's general way takes ten seconds to compile.
  const double scale = spread_across.cwiseAbs().maxCoeff();
  const Eigen::Matrix2d scaled = spread_across / (scale > 0.0 ? scale : 1.0);
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver;
  solver.computeFromTridiagonal(Eigen::Vector2d(scaled.diagonal()), Eigen::Matrix<double, 1, 1>(scaled(1, 0)));
  Eigen::Matrix3d axes;
  axes.col(0) = first;
  axes.col(1) = across * solver.eigenvectors().col(1);
  axes.col(2) = first.cross(axes.col(1));
  return {axes, frame.axes};
}

FrameOptions signatureFrameOptions() {
  FrameOptions options;  // chosen: half the default resolution along theta, phi and r
  options.num_cells = 32;
  options.num_theta = 16;
  options.num_phi = 64;
  options.num_radius = 32;
  options.turns = false;
  options.probabilities = false;
  return options;
}

void rotateSignature(const float* signature, int rotation, float* rotated) {
  const CubeRotation& table = cubeRotation(rotation);
  for (int cube = 0; cube < 2; ++cube) {
    const float* from = signature + cube * kNumOrientations * kNumCells;
    for (int c = 0; c < kNumOrientations; ++c) {
      const float sign = table.sign[static_cast<std::size_t>(c)];
      const std::int32_t* source = table.source.data() + c * kNumCells;
      for (int i = 0; i < kNumCells; ++i) *rotated++ = sign * from[source[i]];
    }
  }
}

}  // namespace pcl_symmetry
