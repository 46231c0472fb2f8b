/// Moves and extends clouds of any fields.
#pragma once

#include <pcl/PCLPointCloud2.h>
#include <pcl/types.h>

#include <Eigen/Geometry>
#include <array>
#include <string>
#include <vector>

namespace pcl_symmetry::apps {

/// Three fields of float or double that hold a vector of each point.
class VectorField {
public:
  explicit VectorField(const pcl::PCLPointCloud2& cloud, const std::array<const char*, 3>& names = {"x", "y", "z"});

  /// \return whether the cloud has the fields; otherwise they must not be read.
  bool isThere() const { return is_there_; }
  bool isDouble() const { return is_double_[0] || is_double_[1] || is_double_[2]; }
  /// \param cloud a cloud with the same fields as the constructor's.
  Eigen::Vector3d get(const pcl::PCLPointCloud2& cloud, std::size_t i) const;
  void set(pcl::PCLPointCloud2& cloud, std::size_t i, const Eigen::Vector3d& value) const;

private:
  std::size_t point_step_;
  std::array<std::size_t, 3> offsets_{};
  std::array<bool, 3> is_double_{};
  bool is_there_ = false;
};

/// \return the points of finite coordinates; all points of a cloud without coordinates.
pcl::Indices finiteIndices(const pcl::PCLPointCloud2& cloud);

/// Moves the points from \p first on: x, y, z and the viewpoint vp_x, vp_y, vp_z by the whole map, normals by its
/// linear part. Other fields stay.
/// \param map a map that keeps distances: a rigid motion or a reflection.
void movePoints(pcl::PCLPointCloud2& cloud, const Eigen::Affine3d& map, std::size_t first = 0);

/// One more field of type float for each name, after those that the cloud has.
/// \param values for each name one value per point.
/// \throws InputError if a name is taken.
pcl::PCLPointCloud2 withFields(const pcl::PCLPointCloud2& cloud, const std::vector<std::string>& names,
                               const std::vector<std::vector<float>>& values);

/// One more field `label` of unsigned numbers.
pcl::PCLPointCloud2 withLabels(const pcl::PCLPointCloud2& cloud, const std::vector<int>& labels);

/// \return the points whose field `label` has a value.
/// \throws std::invalid_argument if the cloud has no such field, or no such point.
pcl::Indices labeledPoints(const pcl::PCLPointCloud2& cloud, int label);

/// Appends copies of the given points to the finite ones; the result is not organized. An additional field of type
/// int32 holds, for each copy, the index in the result of the point that it was copied from, and -1 for all others.
pcl::PCLPointCloud2 appendCopies(const pcl::PCLPointCloud2& cloud, const pcl::Indices& points,
                                 const std::string& field_name);

}  // namespace pcl_symmetry::apps
