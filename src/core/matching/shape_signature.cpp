#include "core/matching/shape_signature.h"

#include <array>
#include <cmath>
#include <cstdint>

#include "core/base/symmetric_solvers.h"
#include "core/geometry/cloud_extent.h"
#include "core/geometry/directions.h"
#include "core/geometry/point_samples.h"
#include "core/geometry/surface_normals.h"
#include "core/matching/matching_rules.h"

namespace pcl_symmetry {

namespace {

constexpr int kNumCells = kSignatureCells * kSignatureCells * kSignatureCells;
// Finer cells count as surface or not, so that the density of the points does not matter.
constexpr int kFineSide = 2 * kSignatureCells;
constexpr int kNumFineCells = kFineSide * kFineSide * kFineSide;
// Rows and columns of the products of components, see kNumOrientations.
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

/// Adds a value to the eight cells around a position, by trilinear weights.
/// \param position in cells from the corner of the cube.
void spread(const Orientation& value, const Eigen::Array3f& position, float* cells) {
  const Eigen::Array3f corner = (position - 0.5f).floor();
  const Eigen::Array3f t = position - 0.5f - corner;
  const Eigen::Array3i first = corner.cast<int>();
  for (int k = 0; k < 8; ++k) {
    const Eigen::Array3i step(k & 1, k >> 1 & 1, k >> 2);
    const Eigen::Array3i at = first + step;
    if ((at < 0).any() || (at >= kSignatureCells).any()) continue;
    const float weight = (step == 1).select(t, 1.0f - t).prod();
    float* cell = cells + (at.z() * kSignatureCells + at.y()) * kSignatureCells + at.x();
    for (int c = 0; c < kNumOrientations; ++c) cell[c * kNumCells] += weight * value[c];
  }
}

/// Sums of n n^T over the points in each fine cell.
/// \param points points about their middle.
/// \param normals normals of cells, in the axes of the points.
/// \param reach half the side of the cube.
std::vector<FineCell> fineCells(const Points& points, const Eigen::Matrix3Xf& normals,
                                const std::vector<int>& normal_of_points, float reach) {
  std::vector<FineCell> fine(kNumFineCells);
  const float to_fine = kFineSide / (2.0f * reach);
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const Eigen::Array3i at = ((points.col(i).array() + reach) * to_fine).floor().cast<int>();
    if ((at < 0).any() || (at >= kFineSide).any()) continue;
    FineCell& cell = fine[(at.z() * kFineSide + at.y()) * kFineSide + at.x()];
    cell.sum += orientationOf(normals.col(normal_of_points[i]));
    ++cell.count;
  }
  return fine;
}

/// One cube of a signature, of unit norm.
/// \param points points about their middle, in the axes.
/// \param normals normals of cells, in the same axes.
/// \param cube kNumOrientations * kNumCells values, initially 0.
void fillCube(const Points& points, const Eigen::Matrix3Xf& normals, const std::vector<int>& normal_of_points,
              float* cube) {
  const float reach = static_cast<float>(kMatching.signature_reach) * points.colwise().norm().mean();
  const std::vector<FineCell> fine = fineCells(points, normals, normal_of_points, reach);
  for (int i = 0; i < kNumFineCells; ++i) {
    const FineCell& cell = fine[i];
    if (cell.count == 0) continue;
    const Eigen::Array3f at(static_cast<float>(i % kFineSide), static_cast<float>(i / kFineSide % kFineSide),
                            static_cast<float>(i / (kFineSide * kFineSide)));
    spread(cell.sum / static_cast<float>(cell.count), (at + 0.5f) * (static_cast<float>(kSignatureCells) / kFineSide),
           cube);
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
    result.sign[c] = static_cast<float>(axis_sign[a] * axis_sign[b]);
    for (int i = 0; i < kNumCells; ++i) {
      const int at[3] = {i % kSignatureCells, i / kSignatureCells % kSignatureCells,
                         i / (kSignatureCells * kSignatureCells)};
      int from[3];
      for (int axis = 0; axis < 3; ++axis)
        from[from_axis[axis]] = axis_sign[axis] > 0 ? at[axis] : kSignatureCells - 1 - at[axis];
      result.source[c * kNumCells + i] =
          from_orientation * kNumCells + (from[2] * kSignatureCells + from[1]) * kSignatureCells + from[0];
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
  return rotations[rotation];
}

/// Points in the given axes, about the point half-way between their center of mass and the middle of their extent.
Points aboutMiddle(const Points& points, const Eigen::Matrix3d& axes) {
  Points rotated = axes.transpose().cast<float>() * points;
  const Eigen::Vector3f mean = rotated.rowwise().mean();
  const Eigen::Vector3f middle = 0.5f * (rotated.rowwise().minCoeff() + rotated.rowwise().maxCoeff());
  rotated.colwise() -= 0.5f * (mean + middle);
  return rotated;
}

/// Points divided by their root mean squares along the axes.
Points stretched(const Points& points) {
  const Eigen::Vector3f spread = points.rowwise().norm();
  return spread.cwiseMax(kMatching.min_spread * spread.maxCoeff()).cwiseInverse().asDiagonal() * points;
}

}  // namespace

std::vector<float> shapeSignature(const PointsRef& points, const Eigen::Matrix3d& axes) {
  const BoundingBall ball = checkedBall(points);
  const Points centered = normalizePoints(points, ball.center, ball.radius);
  const CellNormals surface =
      cellNormals(centered, Eigen::Vector3d::Constant(-1.0), 2.0 / kMatching.normal_cells, kMatching.normal_cells);
  const Points rotated = aboutMiddle(centered, axes);
  const Eigen::Matrix3Xf normals = axes.transpose().cast<float>() * surface.normals;
  std::vector<float> signature(kSignatureSize, 0.0f);
  fillCube(rotated, normals, surface.cell_of_points, signature.data());
  fillCube(stretched(rotated), normals, surface.cell_of_points, signature.data() + kSignatureSize / 2);
  for (float& value : signature) value *= static_cast<float>(std::sqrt(0.5));
  return signature;
}

std::vector<Eigen::Matrix3d> signatureFrames(const PointsRef& points, const SymmetryFrame& frame) {
  const PrincipalAxes principal = principalAxes(points);
  const Eigen::Vector3d first = frame.axes.col(0);
  Eigen::Matrix<double, 3, 2> across;
  across << first.unitOrthogonal(), first.cross(first.unitOrthogonal());
  const Eigen::Matrix<double, 3, 2> rotated = principal.axes.transpose() * across;
  const Eigen::Matrix2d spread_across = rotated.transpose() * principal.variances.asDiagonal() * rotated;
  const SymmetricEigen<Eigen::Matrix2d> solver(spread_across);
  Eigen::Matrix3d axes;
  axes.col(0) = first;
  axes.col(1) = across * solver.eigenvectors().col(1);
  axes.col(2) = first.cross(axes.col(1));
  return {axes, frame.axes};
}

FrameOptions signatureFrameOptions() {
  FrameOptions options;  // half the default resolution
  options.num_cells = 32;
  options.num_theta = 16;
  options.num_phi = 64;
  options.num_radius = 32;
  options.rotations = false;
  options.probabilities = options.refined = false;
  return options;
}

void rotateSignature(const float* signature, int rotation, float* rotated) {
  const CubeRotation& table = cubeRotation(rotation);
  for (int cube = 0; cube < 2; ++cube) {
    const float* from = signature + cube * kNumOrientations * kNumCells;
    for (int c = 0; c < kNumOrientations; ++c) {
      const float sign = table.sign[c];
      const std::int32_t* source = table.source.data() + c * kNumCells;
      for (int i = 0; i < kNumCells; ++i) *rotated++ = sign * from[source[i]];
    }
  }
}

ShapeDescription describeShape(const PointsRef& points, const DescriptionOptions& options,
                               const Visibility* visibility) {
  FrameOptions frame_options = signatureFrameOptions();
  frame_options.seed = options.seed;
  frame_options.num_threads = options.num_threads;
  ShapeDescription result;
  result.frame =
      symmetryFrame(pointsAt(points, equalSteps(points.cols(), kMatching.frame_points)), frame_options, visibility);
  const Points used = pointsAt(points, equalSteps(points.cols(), options.max_points));
  const std::vector<Eigen::Matrix3d> frames = signatureFrames(used, result.frame);
  result.signatures.resize(kSignatureSize, frames.size());
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const std::vector<float> signature = shapeSignature(used, frames[i]);
    result.signatures.col(i) = Eigen::Map<const Eigen::VectorXf>(signature.data(), kSignatureSize);
  }
  return result;
}

}  // namespace pcl_symmetry
