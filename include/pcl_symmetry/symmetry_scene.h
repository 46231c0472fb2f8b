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
  /// Points within this of a supporting plane belong to it, input units, >= 0; 0 = from the spacing and the roughness
  /// of the points.
  double plane_distance = 0.0;
  /// Points closer than this are of one object, input units, >= 0; 0 = from the spacing of the points.
  double cluster_distance = 0.0;
  /// Clusters of fewer points are left out, >= 20: half reports specks, twice misses small things far away.
  int min_points = 300;
  /// Points at a greater depth than this, seen from the viewpoint, are background, input units, >= 0; 0 = none is.
  double max_range = 0.0;
  /// Points of a cluster that are analyzed, >= 100: time grows with them; half makes weak planes less certain.
  int max_points = 5'000;
  /// Cuts objects that touch apart where their surface bends inwards, and joins pieces that one symmetry explains.
  bool separate = true;
  bool frames = true;  ///< finds the frame of each object
  /// Completes objects whose best plane, or a plane through their axis or center, decides. Another plane of confidence
  /// 0.8 or more is taken where it adds more points; a best one that lies along the view adds next to none.
  bool complete = true;
  DetectionOptions detection;      ///< of the planes of each object
  FrameOptions frame;              ///< of the frame of each object
  CompletionOptions completion;    ///< of its completion
  RecognitionOptions recognition;  ///< of its name, with a database
  int num_threads = 0;             ///< >= 0; 0 = one per core

  /// Checks all values.
  /// \throws std::invalid_argument naming field, value and rule.
  void validate() const;
};

/// A table, floor or wall: other points lie on the viewer's side of it.
struct SupportingPlane {
  Eigen::Vector4d coefficients;  ///< unit normal toward the viewer, then d: normal . x + d = 0 on the plane
  pcl::Indices indices;          ///< of its points, into the scene
};

/// A cluster of a scene and its results, in the frame of the scene; without the map.
struct SceneObject : Detection {
  pcl::Indices indices;                ///< of its points, into the scene
  std::optional<SymmetryFrame> frame;  ///< nothing without SceneOptions::frames
  /// The plane that the object was completed by: the best one, another one that adds more, or through the axis or
  /// center and across the view. Nothing where no plane decides.
  std::optional<ReflectionPlane> completed_by;
  pcl::PointCloud<pcl::PointXYZ> added;  ///< points that this reflection adds to the cluster
  Recognition models;                    ///< best first; empty without a database, and where the object is unknown
  std::string model_reason;              ///< why no model of the database fits; empty where one does
};

/// Two pieces that touch, cut apart where the surface bends inwards, and the decision on them: one object if one
/// symmetry explains both.
struct SceneJunction {
  /// Index into SceneAnalysis::objects of the object of the first piece; that of the second is the same where symmetry
  /// joined them.
  std::size_t first = 0;
  std::size_t second = 0;                   ///< the same of the second piece
  std::array<std::size_t, 2> num_points{};  ///< of the pieces
  /// Share of their points that the best symmetry of both maps onto them, in [0, 1], of those that land where the
  /// sensor saw; 0 where there is none.
  double together = 0.0;
  double apart = 0.0;  ///< the same, each piece by its own symmetries; a piece without one adds nothing

  bool isJoined() const { return first == second; }  ///< by symmetry
};

/// Result of SymmetryScene.
struct SceneAnalysis {
  SeenSpace::ConstPtr seen;               ///< what the sensor saw, for further analyses
  std::vector<SupportingPlane> supports;  ///< tables, floors and walls, as they were found
  std::vector<SceneObject> objects;       ///< most points first
  std::vector<SceneJunction> junctions;   ///< with SceneOptions::separate
  std::string reason;                     ///< why there is no answer, which PCL_WARN prints, or empty
  /// Why the scene is a single object, in a few words; its faces may pass for supporting planes, and
  /// SymmetryMaximaRefinement takes it as a whole. Empty for a scene.
  std::string alone;
  double plane_distance = 0.0;                            ///< that was used, input units
  double cluster_distance = 0.0;                          ///< that was used, input units
  std::vector<std::pair<std::string, double>> timing_ms;  ///< stages in order
};

/// Finds the objects of a scene and their symmetries.
///
/// Supporting planes are found by PCL's sample consensus and left out; the rest falls into clusters by PCL's Euclidean
/// clustering, with distances that follow from the points. Objects that touch are cut apart where the surface bends
/// inwards (PCL's supervoxels and locally convex patches); pieces that one symmetry explains are joined again. What the
/// sensor saw is made once of the whole scene (SeenSpace), so that an object in front does not count as free space
/// beside the one behind it. Space behind a supporting plane counts as free of the objects before it
/// (SeenSpace::withSupport()).
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

  /// Where the sensor stood; by default the rays of an organized cloud, or else its sensor_origin_, which may be in the
  /// middle of the scene, as that of a spinning LiDAR.
  void setViewpoint(const Viewpoint& viewpoint) { viewpoint_ = detail::checkedViewpoint(viewpoint); }

  /// The plane that objects stand on, a x + b y + c z + d = 0 in the frame of the scene, in place of supporting planes
  /// that are searched for: points within SceneOptions::plane_distance belong to it.
  /// \throws pcl::BadArgumentException for a zero normal or a value that is not finite.
  void setGround(const Eigen::Vector4d& coefficients);

  /// Names objects by the models that they show. Null (default): objects have no names.
  void setDatabase(const std::shared_ptr<const SymmetryDatabase>& database) { database_ = database; }

  /// Sets the frame to analyze.
  /// \param cloud one frame: organized, or points without order with the viewpoint that they were seen from.
  /// Of points with other fields than x, y and z only these are used.
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
  /// \throws pcl::BadArgumentException where all points lie at the viewpoint that was given.
  SceneAnalysis compute() const;

private:
  SceneOptions options_;
  Viewpoint viewpoint_;
  std::optional<Eigen::Vector4d> ground_;
  std::shared_ptr<const SymmetryDatabase> database_;
  Cloud::ConstPtr input_;
};

}  // namespace pcl_symmetry
