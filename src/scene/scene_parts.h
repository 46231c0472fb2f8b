#pragma once

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "pcl_symmetry/symmetry_scene.h"

namespace pcl_symmetry::detail {

/// \return the positions of some points of a scene.
Points pointsOf(const SymmetryScene::Cloud& scene, const pcl::Indices& indices);

/// \return the squared distance of each point from the closest point of \p surface, which is not empty.
std::vector<float> sqDistancesFrom(const Points& surface, const Points& points);

/// \param plane unit normal and offset, frame of the scene.
/// \return signed distance, input units.
double heightOver(const Eigen::Vector4d& plane, const pcl::PointXYZ& point);

/// Distances that decide what belongs together, input units.
struct SceneDistances {
  double spacing;  ///< median spacing of neighboring points
  double plane;    ///< distance of the points of a supporting plane from the plane
  double cluster;  ///< distance between the points of one object
};

/// Computes the distances from the spacing of the points and how far neighbors are from their tangent plane.
/// \param points indices of finite points, at least one.
SceneDistances sceneDistances(const SymmetryScene::Cloud& scene, const pcl::Indices& points);

/// Adds the supporting planes to the visibility: no part of an object lies behind planes that it stands on or in front
/// of.
/// \param object indices of the points of the object, at least one.
/// \param tolerance how far a symmetric surface may be off, as a share of the diameter.
SeenSpace seenOfObject(const SeenSpace& seen, const SymmetryScene::Cloud& scene,
                       const std::vector<SupportingPlane>& supports, const pcl::Indices& object,
                       const SceneDistances& distances, double tolerance);

/// Evidence against a model of an object: depths, with the errors of the points of the supports, and the greatest
/// support that the object stands on. Other planes may end before the object, and its hidden part may reach beyond
/// them.
/// \param object indices of the points of the object, at least one.
SeenSpace seenOfModel(const SeenSpace& seen, const SymmetryScene::Cloud& scene,
                      const std::vector<SupportingPlane>& supports, const pcl::Indices& object,
                      const SceneDistances& distances);

/// The greatest planes of a scene that other points stand on or in front of.
/// \param points indices of finite points that may lie on the planes.
/// \param others indices of finite points that may stand on them, those that lie on them included.
/// \param viewpoint position of the sensor; nothing: the normals point to the side with most of the other points.
/// \param distance greatest distance of points that belong to a plane, > 0.
std::vector<SupportingPlane> findSupports(const SymmetryScene::Cloud::ConstPtr& scene, const pcl::Indices& points,
                                          pcl::Indices others, const std::optional<Eigen::Vector3d>& viewpoint,
                                          double distance);

/// A supporting plane that is known.
/// \param plane unit normal of any sign; objects are on the side of the viewpoint, or else on the side with most
/// points.
/// \param distance greatest distance of points that belong to it, > 0.
SupportingPlane supportOf(const SymmetryScene::Cloud& scene, const pcl::Indices& points,
                          const std::optional<Eigen::Vector3d>& viewpoint, const Eigen::Vector4d& plane,
                          double distance);

/// \return the points that belong to no support.
pcl::Indices withoutSupports(const pcl::Indices& points, const std::vector<SupportingPlane>& supports,
                             std::size_t scene_size);

/// Clusters of points close to each other, without remainders of the supporting planes.
/// \param points indices of finite points that belong to no supporting plane.
/// \return clusters of at least \p min_points, most points first.
std::vector<pcl::Indices> findClusters(const SymmetryScene::Cloud::ConstPtr& scene, const pcl::Indices& points,
                                       const std::vector<SupportingPlane>& supports, const SceneDistances& distances,
                                       int min_points);

/// Appends small clusters to the body that hides where they are attached, and drops the others: seen from the side, the
/// handle of a mug stands apart in the picture, because its ends are behind the body.
/// \param scene organized.
/// \param min_points least number of points of a body. A smaller cluster belongs to the body that most of its pixels
/// border, and lie behind by less than the body's diagonal.
/// \param[in,out] clusters most points first.
void attachHiddenParts(const SymmetryScene::Cloud& scene, const Eigen::Vector3d& viewpoint, int min_points,
                       std::vector<pcl::Indices>& clusters);

/// Returns feet to objects: points that were assigned to the support of an object because they lie within its distance,
/// but that rise above the plane around the object by more than the noise.
///
/// Without its feet, a box looks lower than it is: if it then looks as high as it is deep, it gets a plane of symmetry
/// between the two directions.
/// \param supports lose these points.
/// \param clusters gain these points, each the cluster that is nearest to it.
/// \param distances a foot is as close to the other points of its cluster as these are to each other.
void returnFeet(const SymmetryScene::Cloud& scene, std::vector<SupportingPlane>& supports,
                std::vector<pcl::Indices>& clusters, const SceneDistances& distances);

/// Whether a cluster is a flat piece of a table, floor or wall that noise lifts off its plane: stereo cameras measure
/// walls in waves, and depths far away have large errors. All points of such a piece lie near one plane, the surface
/// continues along its outline, and nowhere does it end in front of something farther away. An object, even a thin one,
/// does.
/// \param frame organized; others have no such clusters.
/// \param cluster indices of finite points, at least one.
/// \param seen what the scanner saw, from this frame; null: no such clusters.
/// \param tolerance how far a symmetric surface may be off, as a share of the diagonal, > 0.
/// \param distance distance between points of one object, input units, > 0.
bool isBulge(const SymmetryScene::Cloud& frame, const pcl::Indices& cluster, const Visibility* seen, double tolerance,
             double distance);

}  // namespace pcl_symmetry::detail
