/// Meshes whose symmetries are known by construction: a closed curve with folds, swept along a profile.
#pragma once

#include <pcl/PolygonMesh.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "core/base/random.h"
#include "evaluate/shared/plane_difference.h"
#include "pcl_symmetry/core/geometry/reflection_plane.h"

namespace pcl_symmetry::apps {

/// A shape about the z axis.
struct SweptShape {
  std::string body;  ///< what the profile is called
  pcl::PolygonMesh mesh;
  int num_folds = 0;                                 ///< 0 = round
  std::vector<ReflectionPlane> planes;               ///< all symmetries but those of a round shape through its axis
  double between = 1.0;                              ///< share of the surface that planes halfway between two folds map
  double diagonal = 1.0;                             ///< of the bounding box
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  ///< of the bounding box

  static Line3d axis() { return Line3d(Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ()); }
  /// At the tolerance of the library's default, planes halfway between folds are symmetries.
  bool isRound() const;
  /// They are symmetries or nearly so.
  bool isNearlyRound() const;
};

/// Names of the profiles of shapes with folds.
const std::vector<std::string>& foldedBodies();

/// Vertices of a closed curve of the given folds, one of which lies at angle 0; radius at most 1.
/// \param num_folds >= 2; 0 = a circle.
/// \param report draws from the curves of the report half (stars and gears) in place of flowers; both draw polygons.
std::vector<Eigen::Vector2d> foldedCurve(int num_folds, bool report, RandomStream& random);

/// A shape with folds.
/// \param body one of foldedBodies().
SweptShape foldedShape(const std::string& body, int num_folds, bool report, RandomStream& random);

/// \param profile radius and height, from end to end.
SweptShape roundShape(const std::string& body, const std::vector<Eigen::Vector2d>& profile);

/// Names of the profiles of round shapes: of the tuning half or of the report half.
std::vector<std::string> roundBodies(bool report);

/// A round shape with sizes drawn at random.
/// \param body one of roundBodies(), or "ball".
SweptShape roundShape(const std::string& body, RandomStream& random);

/// A cloud of a shape with folds, or of a round one.
struct FoldedCloud {
  std::string body;  ///< one of foldedBodies(), or "round"
  int noise = 0;     ///< standard deviation along each axis, spacings
  bool thinned = false;
  SweptShape shape;
  pcl::PointCloud<pcl::PointXYZ>::Ptr cloud;  ///< the points, moved by the pose
  Eigen::Isometry3d pose;                     ///< of the shape
};

/// Bodies of 2 to 24 folds and round ones, with noise of 0, 1 and 2 spacings; half of them thinned along one direction.
/// \param i decides on body, noise and thinning; all else is drawn from \p seed.
/// \param report draws from the shapes of the report half.
FoldedCloud foldedCloud(int i, std::uint64_t seed, bool report, int num_points);

/// The area of a mesh, squared units of its frame.
double areaOf(const pcl::PolygonMesh& mesh);

/// Moves the points, and then each by a normal distribution.
/// \param noise its standard deviation along each axis.
void moveAndBlur(pcl::PointCloud<pcl::PointXYZ>& cloud, const Eigen::Isometry3d& pose, double noise,
                 RandomStream& random);

}  // namespace pcl_symmetry::apps
