#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <memory>
#include <stdexcept>
#include <vector>

#include "pcl_symmetry/core/exports.h"
#include "pcl_symmetry/core/point_set.h"

namespace PCL_SYMMETRY_EXPORTS pcl_symmetry {

/// A function on a regular grid in space, such as a CT or MR image (Section 4.2: "medical imaging data").
class ScalarGrid {
public:
  using Ptr = std::shared_ptr<ScalarGrid>;
  using ConstPtr = std::shared_ptr<const ScalarGrid>;
  using Size = std::array<int, 3>;  ///< voxels along each axis

  /// \param size voxels along each axis of the grid, >= 1.
  /// \param T_input_index transform from indices (voxel centers at whole numbers) to the input frame; finite and
  /// invertible. It holds spacing, origin and direction, see placed().
  /// \param values one value per voxel, the first index fastest; NaN where nothing is known.
  /// \throws std::invalid_argument naming what is wrong.
  ScalarGrid(const Size& size, const Eigen::Affine3d& T_input_index, std::vector<float> values);

  /// The pose of a grid from spacing, origin and axes.
  /// \param spacing between voxel centers, input units, > 0.
  /// \param origin center of voxel (0, 0, 0), input frame.
  /// \param direction unit columns: where the axes of the grid point.
  /// \throws std::invalid_argument naming field, value and rule.
  static Eigen::Affine3d placed(const Eigen::Vector3d& spacing, const Eigen::Vector3d& origin,
                                const Eigen::Matrix3d& direction = Eigen::Matrix3d::Identity());

  const Size& size() const { return size_; }                               ///< voxels along each axis
  std::size_t numVoxels() const { return values_.size(); }                 ///< product of the size
  const std::vector<float>& values() const { return values_; }             ///< one a voxel, the first index fastest
  const Eigen::Affine3d& T_input_index() const { return T_input_index_; }  ///< from indices to the input frame
  Eigen::Vector3d spacing() const { return T_input_index_.linear().colwise().norm(); }  ///< input units

  /// Whether a point lies in the grid.
  /// \param p indices, which may be fractional.
  /// \param margin voxels.
  /// \return whether p lies between voxel centers, at least the margin from the outermost ones.
  bool contains(const Eigen::Vector3d& p, const Eigen::Vector3d& margin = Eigen::Vector3d::Zero()) const {
    return (p.array() >= margin.array()).all() && (p.array() <= last_.array() - margin.array()).all();
  }

  /// Trilinear interpolation.
  /// \param p indices for which contains() is true.
  double at(const Eigen::Vector3d& p) const;

private:
  friend struct VolumeFunction;

  Size size_;
  Eigen::Affine3d T_input_index_;
  std::vector<float> values_;
  Eigen::Vector3d last_;             ///< indices of the last voxel
  std::array<std::size_t, 3> step_;  ///< index step to the next voxel along each axis; 0 if there is only one
};

/// The range of intensities that is mapped to [0, 1]: \p low and less become 0, \p high and more become 1.
struct VolumeLevels {
  double low = 0.0;  ///< input intensity that becomes 0
  /// Input intensity that becomes 1; low = high = 0: background and brightest half percent of the voxels.
  double high = 0.0;

  /// \throws std::invalid_argument unless both are finite and low < high, or both are 0.
  void validate() const;
};

/// Thrown if a volume holds no answer: too few voxels, no finite value, all values equal.
struct VolumeWithoutAnswer : std::invalid_argument {
  using std::invalid_argument::invalid_argument;
};

/// A volume as the function f of the transform, reduced to a given number of voxels and slightly smoothed.
struct VolumeFunction {
  /// \param volume at least 4 voxels along each axis.
  /// \param max_voxels groups of voxels are averaged until there are no more than this, >= 4096.
  /// \throws std::invalid_argument for bad levels; VolumeWithoutAnswer.
  VolumeFunction(const ScalarGrid& volume, const VolumeLevels& levels, std::size_t max_voxels, int num_threads = 0);

  /// The same function on fewer voxels.
  VolumeFunction(const VolumeFunction& finer, std::size_t max_voxels, int num_threads = 0);

  ScalarGrid f;         ///< f at the voxels, in [0, 1]
  double body = 0.5;    ///< f of the border between background and body (Otsu's threshold)
  VolumeLevels levels;  ///< levels that were used

  /// \return 3 x N voxel centers of the body, input frame; with \p surface only those with a neighbor outside.
  Points bodyPoints(bool surface) const;
};

}  // namespace pcl_symmetry
