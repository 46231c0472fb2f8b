/// The clouds that a mesh is turned into: whole ones and single-view scans, in random poses, noisy, with parts missing,
/// with their viewpoint lost, and sampled in the ways of scanners.
#pragma once

#include <pcl/PolygonMesh.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/scanner/virtual_scanner.h"
#include "evaluate/clouds/sampling_pattern.h"

namespace pcl_symmetry::apps {

/// What is varied while all else keeps its default; None: whole clouds at all noise levels, and scans.
enum class Sweep { None, Noise, Points, Missing, Views };

/// Kinds of clouds of Sweep::None.
enum class CloudRow {
  Whole,    ///< without noise
  Noise,    ///< whole, at the levels of noise above 0
  Scan,     ///< with viewpoint
  Moved,    ///< the same scans in another pose, unorganized, origin 0 0 0: the viewpoint is lost
  Crop,     ///< whole, a share of the points cut off by a random plane
  Sampling  ///< whole, one cloud for each SamplingPattern
};

struct TestCloudOptions {
  Sweep sweep = Sweep::None;
  std::vector<CloudRow> rows = {CloudRow::Whole, CloudRow::Noise, CloudRow::Scan};
  int num_points = 10'000;                                        ///< of a whole cloud, and wanted of a scan
  std::vector<double> noise = {0.0, 0.005, 0.01, 0.02};           ///< of whole clouds, standard deviation in diagonals
  std::vector<double> scan_noise = {0.0};                         ///< along the ray, in diagonals
  std::vector<double> missing = {0.0, 0.05, 0.1, 0.2, 0.3, 0.5};  ///< shares of the points
  std::vector<double> crops = {0.05, 0.2, 0.5};                   ///< shares of the points, of CloudRow::Crop
  std::vector<double> point_counts = {500, 1000, 2000, 5000, 10'000, 30'000, 100'000};
  bool random_views = false;  ///< or else from the corners of a cube
  int num_views = 8;          ///< scans of one model, 0 for none; at most 8 corners
  std::uint64_t seed = 0;
};

/// How one cloud is made; the same for all models.
struct CloudRecipe {
  std::string group;  ///< the line of the table, e.g. "whole, noise 0.01"
  std::string name;   ///< unique among the recipes and fit for file names, e.g. "whole_noise_0.01"
  double x = 0.0;     ///< the value that a sweep varies
  int num_points = 10'000;
  double noise = 0.0;
  double missing = 0.0;
  int view = -1;                                    ///< of a scan; -1 for a whole cloud
  bool moved = false;                               ///< the scan's viewpoint is lost
  int ring_distance = 1;                            ///< of a scan, one row of its picture in this many is kept
  SamplingPattern pattern = SamplingPattern::Even;  ///< of a whole cloud
};

std::vector<CloudRecipe> recipesFor(const TestCloudOptions& options);

/// The true view of a scan, also where the cloud does not tell it.
struct View {
  Eigen::Vector3d direction;         ///< from the model's centre to the scanner, in the cloud's frame, unit
  Eigen::Isometry3d T_cloud_sensor;  ///< z forward
  double half_width;                 ///< of the square picture at depth one
};

struct TestCloud {
  pcl::PointCloud<pcl::PointXYZ>::Ptr cloud;  ///< of a scan organized, as VirtualScan has it, with the sensor's pose
  Eigen::Isometry3d T_cloud_model = Eigen::Isometry3d::Identity();
  std::optional<View> view;  ///< of a scan
};

/// Makes the clouds of one model.
class TestCloudMaker {
public:
  /// \param key of the model: with the seed it chooses poses, noise and views, whatever other models there are.
  /// \throws std::invalid_argument where the mesh has no area.
  TestCloudMaker(const pcl::PolygonMesh& mesh, const std::string& key, const TestCloudOptions& options);

  /// \throws std::runtime_error where a scan sees nothing.
  TestCloud make(const CloudRecipe& recipe) const;

private:
  TestCloud makeWhole(const CloudRecipe& recipe) const;
  TestCloud makeScan(const CloudRecipe& recipe) const;
  pcl::PointCloud<pcl::PointXYZ>::Ptr sample(const CloudRecipe& recipe) const;
  Eigen::Vector3d viewDirection(int view) const;

  pcl::PolygonMesh mesh_;
  TestCloudOptions options_;
  VirtualScanner scanner_;
  std::uint64_t seed_;
};

}  // namespace pcl_symmetry::apps
