/// One frame of a sensor, from points to objects: supporting planes, clusters, and the symmetries of each cluster.
#pragma once

#include <pcl/common/io.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "pcl_symmetry/completion.h"
#include "pcl_symmetry/core/detect_planes.h"
#include "pcl_symmetry/core/exports.h"
#include "pcl_symmetry/core/symmetry_frame.h"
#include "pcl_symmetry/symmetry_database.h"
#include "pcl_symmetry/viewpoint.h"

namespace PCL_SYMMETRY_EXPORTS pcl_symmetry {

/// How a scene is divided into objects, and what is done with each.
struct SceneOptions {
  /// Greatest distance of the points of a supporting plane from the plane, input units, >= 0; 0 = from the spacing and
  /// the roughness of the points.
  double plane_distance = 0.0;
  /// Distance below which two points belong to one object, input units, >= 0; 0 = from the spacing of the points.
  double cluster_distance = 0.0;
  /// Least number of points of a cluster, >= 20: with half as many, specks are reported; with twice as many, small
  /// things far away are missed.
  int min_points = 300;
  /// Greatest depth of points from the viewpoint, input units, >= 0; farther points are background. 0 = no limit.
  double max_range = 0.0;
  /// Greatest number of points of a cluster that are analyzed, >= 100: the time grows with it; with half as many, weak
  /// planes are less certain.
  int max_points = 5'000;
  /// Cuts touching objects apart where their surface bends inwards, and joins pieces that one symmetry explains.
  bool separate = true;
  bool frames = true;  ///< whether the frame of each object is found
  /// Completes objects by their best plane or a plane through their axis or center, if it is a symmetry. Another plane
  /// of confidence 0.8 or more is taken if it adds more points; a best plane along the view adds next to none.
  bool complete = true;
  DetectionOptions detection;      ///< options of the planes of each object
  FrameOptions frame;              ///< options of the frame of each object
  CompletionOptions completion;    ///< options of the completion of each object
  RecognitionOptions recognition;  ///< options of the recognition of each object, with a database
  int num_threads = 0;             ///< >= 0; 0 = one per core

  /// Checks all values.
  /// \throws std::invalid_argument naming field, value and rule.
  void validate() const;
};

/// A table, floor or wall: all other points lie on the viewer's side of it.
struct SupportingPlane {
  Eigen::Vector4d coefficients;  ///< unit normal n toward the viewer, then d: n . x + d = 0 on the plane
  pcl::Indices indices;          ///< indices of its points in the scene
};

/// A cluster of a scene and its results, in the frame of the scene; without the map.
struct SceneObject : Detection {
  pcl::Indices indices;                ///< indices of its points in the scene
  std::optional<SymmetryFrame> frame;  ///< frame of the object; nothing without SceneOptions::frames
  /// The plane by which the object was completed: the best one, another one that adds more, or one through the axis or
  /// center, perpendicular to the view. Nothing if no plane is decided.
  std::optional<ReflectionPlane> completed_by;
  pcl::PointCloud<pcl::PointXYZ> added;  ///< points that this reflection adds to the cluster
  Recognition models;        ///< accepted models, best first; empty without a database, and if the object is unknown
  std::string model_reason;  ///< why no model of the database fits; empty if one does
};

/// Two touching pieces, cut apart where the surface bends inwards, and whether they are one object: they are if one
/// symmetry explains both.
struct SceneJunction {
  /// Index into SceneAnalysis::objects of the object with the first piece; equal to `second` if symmetry joined the
  /// two.
  std::size_t first = 0;
  std::size_t second = 0;                   ///< index into SceneAnalysis::objects of the object with the second piece
  std::array<std::size_t, 2> num_points{};  ///< number of points of each piece
  /// Share of the points that the best common symmetry of both pieces maps onto them, in [0, 1], among the points whose
  /// images lie where the sensor saw; 0 if there is none.
  double together = 0.0;
  double apart = 0.0;  ///< the same share, with each piece's own symmetries; a piece without any adds nothing

  bool isJoined() const { return first == second; }  ///< whether symmetry joined the pieces
};

/// Result of SymmetryScene.
struct SceneAnalysis {
  SeenSpace::ConstPtr seen;               ///< what the sensor saw, for further analyses
  std::vector<SupportingPlane> supports;  ///< tables, floors and walls, in the order in which they were found
  std::vector<SceneObject> objects;       ///< most points first
  std::vector<SceneJunction> junctions;   ///< touching pieces, with SceneOptions::separate
  std::string reason;                     ///< why there is no answer, which PCL_WARN prints, or empty
  /// Why the input is a single object rather than a scene, in a few words; empty for a scene. The faces of a single
  /// object may be taken for supporting planes: SymmetryMaximaRefinement analyzes it as a whole.
  std::string alone;
  double plane_distance = 0.0;                            ///< value that was used, input units
  double cluster_distance = 0.0;                          ///< value that was used, input units
  std::vector<std::pair<std::string, double>> timing_ms;  ///< stages in order, with their milliseconds
};

/// Finds the objects of a scene and their symmetries.
///
/// Supporting planes are found by PCL's sample consensus and left out; the other points are grouped into clusters by
/// PCL's Euclidean clustering, with distances that follow from the points. Touching objects are cut apart where the
/// surface bends inwards (PCL's supervoxels and locally convex patches); pieces that one symmetry explains are joined
/// again. What the sensor saw is determined once from the whole scene (SeenSpace), so that an object in front does not
/// count as free space beside the one behind it. Space behind a supporting plane counts as free for the objects in
/// front of it (SeenSpace::withSupport()).
///
/// \code
/// pcl_symmetry::SymmetryScene scene;
/// scene.setInputCloud(frame);
/// for (const auto& object : scene.compute().objects) std::cout << object.planes.size() << '\n';
/// \endcode
class SymmetryScene {
public:
  using Cloud = pcl::PointCloud<pcl::PointXYZ>;

  /// Sets all options at once.
  /// \throws pcl::BadArgumentException "field = value, must be rule".
  void setOptions(const SceneOptions& options);
  const SceneOptions& getOptions() const { return options_; }  ///< see setOptions()

  /// Sets where the sensor stood; by default it follows from the rays of an organized cloud, or else from
  /// sensor_origin_, which may be in the middle of the scene, as for a spinning LiDAR.
  void setViewpoint(const Viewpoint& viewpoint) { viewpoint_ = detail::checkedViewpoint(viewpoint); }

  /// Sets the plane that objects stand on, a x + b y + c z + d = 0 in the frame of the scene, in place of a search for
  /// supporting planes: points within SceneOptions::plane_distance belong to it.
  /// \throws pcl::BadArgumentException for a zero normal or a value that is not finite.
  void setGround(const Eigen::Vector4d& coefficients);

  /// Sets the models by which objects are named. Null (default): objects have no names.
  void setDatabase(const std::shared_ptr<const SymmetryDatabase>& database) { database_ = database; }

  /// Sets the frame to analyze.
  /// \param cloud one frame: organized, or unorganized points with the viewpoint that they were seen from. Only x, y
  /// and z are used.
  template <typename AnyCloud>
  void setInputCloud(const pcl::shared_ptr<AnyCloud>& cloud) {
    if constexpr (std::is_same_v<std::remove_const_t<AnyCloud>, Cloud>) {
      input_ = cloud;
    } else {
      auto positions = pcl::make_shared<Cloud>();
      pcl::copyPointCloud(*cloud, *positions);
      input_ = positions;
    }
  }

  /// Finds the objects of the frame.
  /// \return the results; no object and a reason if the scene has no point.
  /// \throws pcl::BadArgumentException if all points lie at the viewpoint that was given.
  SceneAnalysis compute() const;

private:
  SceneOptions options_;
  Viewpoint viewpoint_;
  std::optional<Eigen::Vector4d> ground_;
  std::shared_ptr<const SymmetryDatabase> database_;
  Cloud::ConstPtr input_;
};

}  // namespace pcl_symmetry
