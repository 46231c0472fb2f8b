#include "core/matching/turnable_prst.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/constants.h"
#include "core/matching/signature_axes.h"
#include "core/frame/plane_profiles.h"
#include "core/geometry/axis_rotations.h"
#include "pcl_symmetry/core/gaussian_edt.h"

namespace pcl_symmetry {

namespace {

constexpr int kCells = 64;             // chosen: as kTransformCells of symmetryDescriptors()
constexpr double kSigma = 1.0 / 16.0;  // radii of the ball. chosen: as kTransformSigma of symmetryDescriptors()
constexpr int kNumSamples = 256;       // chosen: as DescriptorOptions::num_samples
constexpr int kFaceSide = 10;          // normals along each side of a cube face. chosen: 9 degrees apart; half blurs
                                       // planes, twice takes four times the time and size
static_assert(kTurnableNormals == 3 * kFaceSide * kFaceSide);
constexpr int kFineOffsets = 2 * kTurnableOffsets;  // chosen: D is averaged over two offsets; one is noisier
// Radius of the ball in mean distances of the points from the middle. chosen: it holds nearly all points of compact
// shapes; half cuts away the outer parts, twice leaves half of the offsets empty.
constexpr double kRadius = 2.2;
constexpr double kStretchedRadius = 2.0;  // chosen: as above; stretched shapes reach less far

struct Normals {
  Eigen::Matrix<double, 3, kTurnableNormals> directions;
  Eigen::Matrix<float, kTurnableNormals, 1> weights;
};

/// Normals on three faces of a cube, at equal angles along its edges; each stands for itself and its opposite. A weight
/// is the root of the solid angle around the normal, up to a common factor.
const Normals& normals() {
  static const Normals values = [] {
    Normals made;
    Eigen::Index count = 0;
    for (int axis = 0; axis < 3; ++axis) {
      for (int i = 0; i < kFaceSide * kFaceSide; ++i) {
        const auto place = [](int k) { return std::tan(((k + 0.5) / kFaceSide - 0.5) * (0.5 * kPi)); };
        const double u = place(i % kFaceSide), v = place(i / kFaceSide), sq = 1.0 + u * u + v * v;
        Eigen::Vector3d x;
        x[axis] = 1.0;
        x[(axis + 1) % 3] = u;
        x[(axis + 2) % 3] = v;
        made.directions.col(count) = x / std::sqrt(sq);
        made.weights[count++] = static_cast<float>(std::sqrt((1.0 + u * u) * (1.0 + v * v) / (sq * std::sqrt(sq))));
      }
    }
    return made;
  }();
  return values;
}

/// For each normal, the normal that the rotation maps to it or to its opposite.
struct NormalRotation {
  std::array<int, kTurnableNormals> source;
  std::array<bool, kTurnableNormals> opposite;
};

NormalRotation makeNormalRotation(const Eigen::Matrix3i& rotation) {
  NormalRotation result;
  const auto& directions = normals().directions;
  for (int i = 0; i < kTurnableNormals; ++i) {
    const Eigen::Vector3d from = rotation.transpose().cast<double>() * directions.col(i);
    const Eigen::Matrix<double, kTurnableNormals, 1> cosines = directions.transpose() * from;
    Eigen::Index source;
    cosines.cwiseAbs().maxCoeff(&source);
    result.source[static_cast<std::size_t>(i)] = static_cast<int>(source);
    result.opposite[static_cast<std::size_t>(i)] = cosines[source] < 0.0;
  }
  return result;
}

const NormalRotation& normalRotation(int rotation) {
  static const std::vector<NormalRotation> rotations = [] {
    std::vector<NormalRotation> made;
    for (const Eigen::Matrix3i& matrix : axisRotations()) made.push_back(makeNormalRotation(matrix));
    return made;
  }();
  return rotations[static_cast<std::size_t>(rotation)];
}

/// sqrt(D) at the normals and offsets, of unit norm.
/// \param points about their middle, in the axes.
/// \param radius of the ball, in mean distances of the points from the middle.
void fillPRST(const Points& points, double radius, float* prst) {
  GaussianEdtOptions options;
  options.num_cells = kCells;
  options.num_threads = 1;
  options.radius = 1.0;
  options.sigma = kSigma;
  const double scale = radius * points.colwise().norm().mean();
  const GaussianEdt edt(points / static_cast<float>(scale), options);
  const PlaneProfiles profiles(edt, {}, kNumSamples, 1, 1);
  // Profiles are in cells about the middle of the grid, which is not the middle of the points.
  const Eigen::Vector3d origin =
      -(edt.origin() + Eigen::Vector3d::Constant(0.5 * (edt.numCells() - 1) * edt.cellSize())) / edt.cellSize();
  const double reach = 1.0 / edt.cellSize(), step = 2.0 * reach / kFineOffsets;
  Eigen::Map<Eigen::MatrixXf> values(prst, kTurnableOffsets, kTurnableNormals);
  for (int i = 0; i < kTurnableNormals; ++i) {
    const Eigen::Vector3d normal = normals().directions.col(i);
    const double first = normal.dot(origin) - reach + 0.5 * step;
    const std::vector<float> d =
        profiles.scores(normal.cast<float>(), static_cast<float>(first), static_cast<float>(step), kFineOffsets);
    for (int k = 0; k < kTurnableOffsets; ++k)
      values(k, i) = normals().weights[i] * 0.5f * (std::sqrt(d[2 * k]) + std::sqrt(d[2 * k + 1]));
  }
  values.stableNormalize();
}

}  // namespace

std::vector<float> turnablePRST(const PointsRef& points, const Eigen::Matrix3d& axes) {
  const Points turned = aboutMiddle(inRadii(points), axes);
  std::vector<float> prst(kTurnablePRSTSize);
  fillPRST(turned, kRadius, prst.data());
  fillPRST(stretched(turned), kStretchedRadius, prst.data() + kTurnablePRSTSize / 2);
  for (float& value : prst) value *= static_cast<float>(std::sqrt(0.5));
  return prst;
}

void rotateTurnablePRST(const float* prst, int rotation, float* rotated) {
  const NormalRotation& table = normalRotation(rotation);
  for (int shape = 0; shape < 2; ++shape) {
    for (std::size_t i = 0; i < kTurnableNormals; ++i, rotated += kTurnableOffsets) {
      const float* from = prst + kTurnableOffsets * (shape * kTurnableNormals + table.source[i]);
      if (table.opposite[i])
        std::reverse_copy(from, from + kTurnableOffsets, rotated);
      else
        std::copy(from, from + kTurnableOffsets, rotated);
    }
  }
}

}  // namespace pcl_symmetry
