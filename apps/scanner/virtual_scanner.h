/// A range scanner that looks at a mesh: organized clouds like those of a depth camera (Section 5.1, Figure 11).
#pragma once

#include <pcl/PolygonMesh.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>

namespace pcl_symmetry::apps {

struct VirtualScannerOptions {
  int num_points = 10000;  ///< wanted number of hits, > 0
  /// Full angle of the square image, radians, in (0, pi); not set: 0.4, or more if that crops the model.
  std::optional<double> field_of_view;
  double distance = 2.0;           ///< distance from the center of the bounding box, diagonals of the box, > 0.5
  double noise = 0.0;              ///< standard deviation of the depth along the ray, diagonals of the box, >= 0
  bool random_pose = false;        ///< rotates and moves the model before it is scanned
  std::uint64_t seed = 1;          ///< seed of pose and noise
  std::uint64_t noise_stream = 0;  ///< different numbers give scans of one pose different noise
  int num_threads = 0;             ///< 0 = all; the result does not depend on it
  /// Greatest number of pixels along the edge of the image; thin shapes then give fewer points.
  int max_resolution = 8192;
};

struct VirtualScan {
  /// One point per pixel, row by row, NaN if the ray misses, in the scan's frame; sensor_origin_ and
  /// sensor_orientation_ hold the pose of the scanner (z forward, x right, y down).
  pcl::PointCloud<pcl::PointXYZ>::Ptr cloud;
  Eigen::Isometry3d T_scan_model = Eigen::Isometry3d::Identity();  ///< the identity unless random_pose is set
  Eigen::Isometry3d T_scan_sensor = Eigen::Isometry3d::Identity();
  int num_points = 0;    ///< number of hits
  bool cropped = false;  ///< whether the model extends beyond the image
};

/// Holds the mesh in the form in which rays are traced.
class VirtualScanner {
public:
  /// Polygons are cut into fans; triangles with non-finite corners are left out.
  /// \throws std::invalid_argument if no triangle is left.
  explicit VirtualScanner(const pcl::PolygonMesh& mesh);
  ~VirtualScanner();

  /// Diagonal of the bounding box of the triangles, input units.
  double diagonal() const;

  /// \param direction direction from the center toward the scanner, in the model's frame; any length but zero.
  /// \param options with random_pose, scanner and model are rotated and moved together, so that the view stays the
  /// same.
  /// \throws std::runtime_error if no ray hits.
  VirtualScan scan(const Eigen::Vector3d& direction, const VirtualScannerOptions& options = {}) const;

private:
  struct Scene;
  std::unique_ptr<Scene> scene_;
};

/// The eight corners of a cube around the origin, unit length; bit k of the index is set where coordinate k is
/// positive.
std::array<Eigen::Vector3d, 8> cubeCorners();

}  // namespace pcl_symmetry::apps
