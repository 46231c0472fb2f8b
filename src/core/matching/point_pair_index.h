#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "core/matching/surface_points.h"

namespace pcl_symmetry {

/// A shape with pairs of points like the pairs of a scan.
struct ShapeOfPairs {
  int shape;                                    ///< number of the shape, in the order in which shapes were added
  double votes;                                 ///< votes for the best pose
  std::vector<Eigen::Isometry3d> T_shape_scan;  ///< poses by decreasing votes
};

struct PairSearchOptions {
  int num_nearest = 10;  ///< shapes that are returned, >= 0
  int num_poses = 6;     ///< poses of each shape, >= 1
  int num_threads = 0;   ///< >= 0; 0 = one per core
};

/// Finds shapes and poses by pairs of points with their normals (Drost et al. 2010): two points of a scan have the same
/// distance and angles between normals as two points of the shape that it shows. Occlusion removes pairs but does not
/// change the others, whereas views (see ViewIndex) change with every hidden part. Not in the paper.
///
/// Unlike in that work, normals have no sign, distances are compared by their ratio, so that shapes may be of any size,
/// and pairs that many shapes have count less.
class PointPairIndex {
public:
  /// \param shapes points of each shape, about MatchingRules::num_pair_points.
  explicit PointPairIndex(const std::vector<SurfacePoints>& shapes, int num_threads = 0);

  int numShapes() const { return static_cast<int>(radii_.size()); }

  /// \param scan some points, about MatchingRules::num_scan_points, in random order, in the unit of the shapes.
  /// \return most votes first, at most PairSearchOptions::num_nearest.
  std::vector<ShapeOfPairs> nearest(const SurfacePoints& scan, const PairSearchOptions& options = {}) const;

private:
  /// A pose that one point of the scan votes for.
  struct Vote {
    Eigen::Quaterniond rotation;
    Eigen::Vector3d position;  // center of the scan, frame of the shape
    double weight;
  };

  /// A few shapes whose votes fit into the cache.
  struct Block {
    int first_shape, end_shape;
    // Their pairs by key: the first point, counted from the first one of the block, and in the last 8 bits the rotation
    // of the second point about the normal of the first.
    std::vector<std::uint32_t> key_begins, pairs;
  };

  /// Key of the pairs of shapes that resemble a pair of the scan.
  struct LookUp {
    std::uint32_t key, rotation;
  };

  /// A point of the scan that votes, with its normal in one of the two directions.
  struct Reference {
    Eigen::Matrix3d frame;
    Eigen::Vector3d point;
    std::vector<LookUp> look_ups;
  };

  Block blockOf(int first_shape, int end_shape) const;
  void fillWeights();
  Reference referenceOf(const SurfacePoints& scan, int index, int sign) const;
  void count(const Block& block, const std::vector<LookUp>& look_ups, std::vector<std::int32_t>& votes) const;
  void collect(int shape, const Reference& reference, const Eigen::Vector3d& center, const std::int32_t* votes,
               std::vector<Vote>& poses) const;
  ShapeOfPairs clustered(int shape, std::vector<Vote> votes, const Eigen::Vector3d& center, int num_poses) const;
  int keyOf(int distance, int angle, int other_angle, int between) const;
  std::size_t numKeys() const { return weights_.size(); }

  // Points of all shapes, one after the other: positions, normals, where the points of each shape begin.
  Points points_, normals_;
  std::vector<int> begins_ = {0};
  std::vector<double> radii_;  // radius of each shape
  int first_distance_ = 0, num_distances_ = 0;
  std::vector<Block> blocks_;
  std::vector<std::uint8_t> weights_;  // weight of each key
};

}  // namespace pcl_symmetry
