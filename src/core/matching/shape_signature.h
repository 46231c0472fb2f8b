#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "pcl_symmetry/core/point_set.h"
#include "pcl_symmetry/core/symmetry_frame.h"
#include "pcl_symmetry/core/visibility.h"

namespace pcl_symmetry {

/// Cells along each side of the cube that a signature describes.
constexpr int kSignatureCells = 12;
/// Products of two components of a unit normal: xx, yy, zz, yz, zx, xy.
constexpr int kNumOrientations = 6;
/// Values of a signature: for each of two cubes and each product, one value per cell, x fastest.
constexpr int kSignatureSize = 2 * kNumOrientations * kSignatureCells * kSignatureCells * kSignatureCells;

/// Shape signature, which matching compares (Section 5.2): where the surface of a shape lies and which way it faces, in
/// a frame of its symmetry.
///
/// Departure from the paper: the values of its distance transform (GEDT) tell only how near the surface is. Here each
/// cell holds the mean of n n^T over the surface in it, n the normal, so that a wall differs from a floor at the same
/// position. The roots of the values are compared, with their signs. The first cube has the proportions of the shape;
/// in the second one the shape is stretched to equal root mean squares along the axes, so that long and short things of
/// a class agree. The comparison decides the order and the signs of the axes, see rotateSignature().
/// \param points 3 x N, finite, input units, at least two different ones.
/// \param axes unit vectors in columns, right-handed.
/// \return kSignatureSize values of unit norm.
/// \throws std::invalid_argument for points without extent.
std::vector<float> shapeSignature(const PointsRef& points, const Eigen::Matrix3d& axes);

/// Frames in which signatures are made, right-handed axes in columns.
/// \return two frames. The first one has the first axis of the symmetry frame; its other axes are the
/// directions of greatest and least spread perpendicular to it: shapes of a class share these more often than weak
/// symmetry planes. The second one is the symmetry frame.
std::vector<Eigen::Matrix3d> signatureFrames(const PointsRef& points, const SymmetryFrame& frame);

/// \return options of symmetryFrame() that are good enough for signatures and take a third of the time of the default.
FrameOptions signatureFrameOptions();

/// The signature in the frame whose axes are axes * axisRotations()[rotation]^T.
/// \param signature kSignatureSize values in the frame of the axes.
/// \param rotation index into axisRotations().
/// \param rotated kSignatureSize values, not overlapping \p signature.
void rotateSignature(const float* signature, int rotation, float* rotated);

struct DescriptionOptions {
  /// Greatest number of points that signatures are made from, spread evenly over the input, >= 2.
  int max_points = 20'000;
  std::uint64_t seed = 1;
  int num_threads = 0;  ///< >= 0; 0 = one per core
};

/// A description of a shape for matching, independent of pose and size (Section 5.2).
struct ShapeDescription {
  SymmetryFrame frame;
  Eigen::MatrixXf signatures;  ///< kSignatureSize x 2, one column for each of the signatureFrames()
};

/// \param points 3 x N, finite, input units, at least two different ones.
/// \param visibility what a scanner saw; null = the points show the object from all sides.
/// \throws std::invalid_argument for points without extent.
ShapeDescription describeShape(const PointsRef& points, const DescriptionOptions& options = {},
                               const Visibility* visibility = nullptr);

}  // namespace pcl_symmetry
