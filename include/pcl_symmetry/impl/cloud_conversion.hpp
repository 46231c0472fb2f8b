#pragma once

#include <pcl/PolygonMesh.h>
#include <pcl/common/point_tests.h>
#include <pcl/exceptions.h>
#include <pcl/point_cloud.h>
#include <pcl/type_traits.h>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "pcl_symmetry/core/exports.h"
#include "pcl_symmetry/core/point_set.h"
#include "pcl_symmetry/core/visibility.h"
#include "pcl_symmetry/viewpoint.h"

/// PCL clouds and meshes become points of the core, and errors of the core become errors of PCL.
///
/// All classes and functions for PCL users share one error policy:
/// - Data that hold no answer give an empty result, and PCL_WARN prints the reason. Such data are: no input, no finite
///   point, fewer than 20 distinct points, points at one position or on one line, a mesh without area.
/// - Wrong parameters throw pcl::BadArgumentException with the message "field = value, must be rule". Indices that the
///   cloud or mesh does not have, and a viewpoint among the points, are wrong parameters.
/// - Messages name neither a C++ function nor a source file.
namespace PCL_SYMMETRY_EXPORTS pcl_symmetry {
namespace detail {

/// A polygon mesh of PCL as plain arrays.
struct MeshArrays {
  Points vertices;                         ///< 3 x V, input units; may be not finite
  std::vector<std::vector<int>> polygons;  ///< indices of vertices, each valid
  std::vector<Eigen::Vector3i> triangles;  ///< fans of the polygons, each about its first corner

  /// \return whether any polygon with finite corners has an area.
  bool hasArea() const;
};

/// \throws std::invalid_argument where a polygon refers to a vertex that the mesh does not have.
MeshArrays toArrays(const pcl::PolygonMesh& mesh);

/// Throws pcl::BadArgumentException whose what() is \p message and nothing else. (PCL_THROW_EXCEPTION puts the
/// function, the file and the line into the text.)
[[noreturn]] void throwBadArgument(const std::string& message);

/// Calls \p body. What the core refuses with std::invalid_argument reaches PCL users as pcl::BadArgumentException.
/// \return what \p body returns.
template <typename Body>
auto withBadArguments(const Body& body) {
  try {
    return body();
  } catch (const std::invalid_argument& error) {
    throwBadArgument(error.what());
  }
}

/// Changes some options if the result is valid.
/// \param change sets fields of the options that it is given.
/// \throws pcl::BadArgumentException "field = value, must be rule"; the options are as before then.
template <typename Options, typename Change>
void changeOptions(Options& options, const Change& change) {
  Options changed = options;
  change(changed);
  withBadArguments([&] { changed.validate(); });
  options = std::move(changed);
}

/// \throws pcl::BadArgumentException if \p value is below \p lower_limit.
void checkAtLeast(const char* field, std::int64_t value, std::int64_t lower_limit);

/// \param points 3 x N, finite.
/// \param input what the points are called in the sentence.
/// \param min_points least number of points for an answer.
/// \param indices the indices by which the points were chosen; null: all points were taken.
/// \return why the points hold no answer, one sentence; empty where they can be analyzed.
std::string reasonForNoAnswer(const Points& points, const std::string& input = "input cloud", int min_points = 0,
                              const pcl::Indices* indices = nullptr);

/// Prints "[pcl_symmetry::SOURCE] REASON." by PCL_WARN.
void warnOfNoAnswer(const std::string& source, const std::string& reason);

/// The points of a cloud that an analysis uses.
struct SelectedPoints {
  Points points;         ///< 3 x N, finite
  pcl::Indices indices;  ///< N indices into the cloud
};

/// Draws one element of each of \p max_points equal runs of a sequence.
/// \param num_points length of the sequence, more than \p max_points.
/// \return max_points positions in the sequence, ascending.
std::vector<std::size_t> drawOneOfEachRun(std::size_t num_points, std::size_t max_points, std::uint64_t seed);

/// The finite points of a cloud. From more than \p max_points, one of each of max_points equal runs is drawn, so that
/// the time and memory of an analysis do not grow with the cloud.
/// \param indices the points of the cloud to choose from; null: all.
/// \throws pcl::BadArgumentException for an index that the cloud does not have.
template <typename PointT>
SelectedPoints selectPoints(const pcl::PointCloud<PointT>& cloud, const pcl::Indices* indices, std::size_t max_points,
                            std::uint64_t seed) {
  SelectedPoints selected;
  const std::size_t size = indices ? indices->size() : cloud.size();
  for (std::size_t i = 0; i < size; ++i) {
    const pcl::index_t index = indices ? (*indices)[i] : static_cast<pcl::index_t>(i);
    if (index < 0 || static_cast<std::size_t>(index) >= cloud.size())
      throwBadArgument("indices[" + std::to_string(i) + "] = " + std::to_string(index) + ", must be in [0, " +
                       std::to_string(cloud.size()) + ")");
    if (pcl::isXYZFinite(cloud[index])) selected.indices.push_back(index);
  }
  if (selected.indices.size() > max_points) {
    pcl::Indices drawn;
    for (const std::size_t position : drawOneOfEachRun(selected.indices.size(), max_points, seed))
      drawn.push_back(selected.indices[position]);
    selected.indices = std::move(drawn);
  }
  selected.points.resize(3, static_cast<Eigen::Index>(selected.indices.size()));
  for (std::size_t i = 0; i < selected.indices.size(); ++i)
    selected.points.col(static_cast<Eigen::Index>(i)) = cloud[selected.indices[i]].getVector3fMap();
  return selected;
}

/// \return the normals of some points, 3 x N; nothing for point types without normals.
template <typename PointT>
std::optional<Points> normalsOf(const pcl::PointCloud<PointT>& cloud, const pcl::Indices& indices) {
  if constexpr (pcl::traits::has_normal<PointT>::value) {
    Points normals(3, static_cast<Eigen::Index>(indices.size()));
    for (std::size_t i = 0; i < indices.size(); ++i)
      normals.col(static_cast<Eigen::Index>(i)) = cloud[indices[i]].getNormalVector3fMap();
    return normals;
  } else {
    return std::nullopt;
  }
}

/// The rays of an organized cloud from a pinhole camera.
/// \return nothing where the rows and columns are not those of such a camera.
std::optional<Visibility> seenByOrganizedCloud(const pcl::PointCloud<pcl::PointXYZ>& cloud);

/// Seen, free and unknown space of points without rows and columns.
/// \param points 3 x N, finite, N >= 1.
/// \param stored viewpoint stored with the cloud, for Viewpoint::Mode::Auto. It is used if the points can be seen from
/// there; a default one only if the points by themselves show a single view, which it explains as well as any other.
/// \param is_default whether the stored viewpoint may be a default, which is no evidence by itself.
/// \throws std::invalid_argument if the points surround a given viewpoint.
SeenSpace seenFrom(const Points& points, const Viewpoint& viewpoint, const Eigen::Vector3d& stored, bool is_default);

/// \return whether the sensor of a cloud is at 0 0 0 and not rotated.
template <typename PointT>
bool hasDefaultSensor(const pcl::PointCloud<PointT>& cloud) {
  return cloud.sensor_origin_.template head<3>().isZero(0.0f) && cloud.sensor_orientation_.vec().isZero(0.0f);
}

/// Seen, free and unknown space of a cloud.
/// \param points the points of the cloud that are analyzed, 3 x N, finite, N >= 1.
/// \param is_part whether the analyzed points are only a part of the cloud, which the other points may hide.
/// \throws std::invalid_argument if the points surround a given viewpoint.
template <typename PointT>
SeenSpace findSeenSpace(const pcl::PointCloud<PointT>& cloud, const Points& points, const Viewpoint& viewpoint,
                        bool is_part = false) {
  if (viewpoint.mode == Viewpoint::Mode::None) return {};
  if (is_part) return SeenSpace(cloud, viewpoint);
  if (viewpoint.mode == Viewpoint::Mode::Auto && cloud.isOrganized() && cloud.width > 1)
    if (auto seen = seenByOrganizedCloud(*positionsOf(cloud))) return {std::move(*seen), ViewpointSource::Rays};
  return seenFrom(points, viewpoint, cloud.sensor_origin_.template head<3>().template cast<double>(),
                  hasDefaultSensor(cloud));
}

/// An organized cloud whose rows and columns are those of a depth camera.
struct DepthFrame {
  /// The cloud without the errors of its depths; null if it has none.
  pcl::PointCloud<pcl::PointXYZ>::ConstPtr filtered;
  SeenSpace seen;  ///< space seen along its own rays; empty if no camera fits
};

/// \param num_threads 0 = one per core.
DepthFrame depthFrame(const pcl::PointCloud<pcl::PointXYZ>::ConstPtr& cloud, int num_threads);

/// \return the plane, scaled to a unit normal.
/// \throws pcl::BadArgumentException for a zero normal or a value that is not finite.
Eigen::Vector4d unitPlane(const Eigen::Vector4d& coefficients);

/// The same space for points that stand on a ground.
/// \param ground a plane with a unit normal of any sign; the viewpoint lies above it.
/// \param points 3 x N, N >= 1.
/// \param tolerance distance by which points may seem to reach into the ground, as a share of their diagonal.
/// \return \p seen itself where it has no viewpoint.
SeenSpace standingOn(const SeenSpace& seen, const Eigen::Vector4d& ground, const Points& points, double tolerance);

/// The same space around a part of a scene: nothing of the part lies behind the supporting planes that it stands on or
/// in front of, which PCL's sample consensus finds among the other points.
/// \param part indices of the points of the part, at least one of them finite.
/// \param tolerance how far a symmetric surface may be off, as a share of the diameter.
SeenSpace standingInScene(const SeenSpace& seen, const pcl::PointCloud<pcl::PointXYZ>::ConstPtr& scene,
                          const pcl::Indices& part, double tolerance);

/// \return what the scanner saw; nothing without a viewpoint.
inline std::optional<Visibility> visibilityOf(const SeenSpace& seen) {
  return seen.visibility() ? std::optional<Visibility>(*seen.visibility()) : std::nullopt;
}

}  // namespace detail
}  // namespace pcl_symmetry
