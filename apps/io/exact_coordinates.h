/// Coordinates that need more digits than float has: they are read in double, shifted near zero, and shifted back on
/// output.
///
/// The library computes in float. A box of one meter at map coordinates such as (500000, 5000000, 100) would lose its
/// shape, so the loader subtracts a shift in double, and the tools add it to what they report.
#pragma once

#include <pcl/PCLPointCloud2.h>
#include <pcl/PolygonMesh.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <Eigen/Geometry>
#include <array>
#include <boost/functional/hash.hpp>
#include <cstdint>
#include <cstring>
#include <string>
#include <unordered_map>
#include <vector>

#include "pcl_symmetry/core/reflection_plane.h"
#include "pcl_symmetry/viewpoint.h"

namespace pcl_symmetry::apps {

using Cloud = pcl::PointCloud<pcl::PointXYZ>;

/// Vertices and faces of a file, in double.
struct ExactShape {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<pcl::Vertices> polygons;
  std::vector<std::string> left_out;  ///< further content of the file, which is not read
};

/// \return what to subtract: zero if float is precise enough, otherwise a point near the middle of the finite points,
/// rounded so that the subtraction is exact
Eigen::Vector3d shiftFor(const std::vector<Eigen::Vector3d>& points);

/// \return the points minus the shift
Cloud shifted(const std::vector<Eigen::Vector3d>& points, const Eigen::Vector3d& shift);

/// \return number of digits of the extent that float coordinates keep at the shift, which is not zero
int digitsOfFloat(const Cloud& points, const Eigen::Vector3d& shift);

/// \return the points plus the shift; fields x, y and z are doubles if there is a shift, floats otherwise
pcl::PCLPointCloud2 toFields(const Cloud& points, const Eigen::Vector3d& shift);

/// \return the viewpoint in the frame of the shifted points
Viewpoint shifted(Viewpoint viewpoint, const Eigen::Vector3d& shift);

/// \return a plane a x + b y + c z + d = 0 in the frame of the shifted points
Eigen::Vector4d shifted(const Eigen::Vector4d& plane, const Eigen::Vector3d& shift);

/// \return the point of the shifted points in the input frame
Eigen::Vector3d shiftedBack(const Eigen::Vector3d& point, const Eigen::Vector3d& shift);

/// \return the plane of the shifted points in the input frame
ReflectionPlane shiftedBack(const ReflectionPlane& plane, const Eigen::Vector3d& shift);

/// \param T_target_source between shifted frames
/// \return the same motion between the input frames
Eigen::Isometry3d shiftedBack(const Eigen::Isometry3d& T_target_source, const Eigen::Vector3d& source_shift,
                              const Eigen::Vector3d& target_shift);

/// \return a, b, c and d of the plane of the shifted points in the input frame, for a normal printed with six decimals:
/// even far from the origin, d and the rounded normal together give the plane at the points
Eigen::Vector4d printedCoefficients(const ReflectionPlane& plane, const Eigen::Vector3d& shift);

/// \return number of significant digits of lengths in the input frame that a tool prints
int lengthDigits(const Eigen::Vector3d& shift);

/// \return "x y z" with the given number of significant digits
std::string spelled(const Eigen::Vector3d& point, int digits);

class VertexWelder {
public:
  explicit VertexWelder(ExactShape& shape) : shape_(shape) {}

  /// \return the index of the vertex in the shape.
  pcl::index_t add(const Eigen::Vector3d& vertex) {
    const Eigen::Vector3d xyz = vertex + Eigen::Vector3d::Zero();  // 0 in place of -0
    Bits bits;
    std::memcpy(bits.data(), xyz.data(), sizeof(bits));
    const auto [entry, is_new] = index_of_.emplace(bits, static_cast<pcl::index_t>(shape_.vertices.size()));
    if (is_new) shape_.vertices.push_back(vertex);
    return entry->second;
  }

private:
  /// Compared in place of the coordinates, so that NaN values are handled as well.
  using Bits = std::array<std::uint64_t, 3>;
  ExactShape& shape_;
  std::unordered_map<Bits, pcl::index_t, boost::hash<Bits>> index_of_;
};

}  // namespace pcl_symmetry::apps
