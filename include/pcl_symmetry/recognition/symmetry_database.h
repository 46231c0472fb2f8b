/// Models in a folder, found by shape or recognized in a scan (Section 5.2).
#pragma once

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <Eigen/Geometry>
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "pcl_symmetry/core/exports.h"
#include "pcl_symmetry/registration/cloud_registration.h"
#include "pcl_symmetry/viewpoint.h"

namespace PCL_SYMMETRY_EXPORTS pcl_symmetry {

namespace detail {
struct DatabaseParts;
}

struct DatabaseOptions {
  /// Models, spread evenly over all, that compact forms are fitted to, >= 1. chosen: fewer show less of the variety of
  /// the models, twice takes four times the time and memory of the fit; README measures 200 for 904 models.
  int num_references = 128;
  /// Views of a model that scans are compared with, >= 1. chosen: of 80 views the nearest is within 12 degrees of any
  /// direction; half makes that 17 degrees, twice 8.5 (gaps shrink with the square root).
  int num_views = 80;
  std::size_t max_points = 20'000;  ///< points of a cloud that are kept, >= 100. chosen: time grows with them
  int num_threads = 0;              ///< >= 0; 0 = one per core

  /// \throws std::invalid_argument naming field, value and rule.
  void validate() const;
};

struct RecognitionOptions {
  /// Models that are brought to the scan coarsely, >= 1. chosen: half misses more models, twice takes twice the time.
  int num_candidates = 10;
  /// For scans from a viewpoint: models with the best coarse poses, whose poses are refined, >= 1. chosen: as above.
  int num_refined = 4;
  /// Added to the distance of two views if their radii differ by a factor of e, >= 0. A smaller value is better where
  /// other objects hide much of the object. chosen: 0 ignores the size.
  double size_weight = 0.25;
  /// Least merit of a pose that is accepted, in [-1, 1], see PoseScore::merit(). It suits clouds that are sampled
  /// evenly, as scanners do; points drawn at random reach lower merits. measured: pcl_symmetry_evaluate recognition on
  /// the training half of the Princeton Shape Benchmark, where 0.64 leaves 9.6 % of the known models unknown and
  /// accepts 26 % of the unknown ones, and 0.60 6.0 % and 37 %.
  double min_merit = 0.64;
  CloudRegistrationOptions registration = quickRegistration();  ///< search for poses and their refinement
  int num_threads = 0;                                          ///< >= 0; 0 = one per core

  /// \return a search for poses that takes a tenth of the time of the default.
  static CloudRegistrationOptions quickRegistration();
  /// \throws std::invalid_argument naming field, value and rule.
  void validate() const;
};

struct ModelMatch {
  std::string name;
  double distance;  ///< L2 distance of the compact signatures, in [0, 2]
};

struct RecognizedModel {
  std::string name;
  Eigen::Isometry3d T_model_scan = Eigen::Isometry3d::Identity();
  PoseScore score;
  /// How likely the scan shows this model and no other one of the database, in [0, 1]: the soft maximum over the merits
  /// of all accepted models, times the root of (merit - min_merit) / (1 - min_merit). The sum is at most 1.
  double confidence = 0.0;
};

/// Accepted models, best first. Empty: the object is unknown.
using Recognition = std::vector<RecognizedModel>;

/// Models in a folder, found by their symmetry (Section 5.2): match() finds models of like shape, recognize() the model
/// that a scan shows.
///
/// The folder holds manifest.txt; for each model its cloud, signatures and views; and the compact forms of all models.
/// A save writes new files beside the old ones and then replaces manifest.txt: if it is interrupted, the old state
/// stays whole. Other files in the folder are neither changed nor removed. Only one program may write at a time.
///
/// Clouds that hold no answer (fewer than 20 distinct points, or all of them on one line) give an empty result and a
/// PCL_WARN.
///
/// \code
/// pcl_symmetry::SymmetryDatabase database("models");
/// database.add("milk", cloud);
/// database.save();
/// for (const auto& model : database.recognize(scan)) std::cout << model.name << ' ' << model.confidence << '\n';
/// \endcode
class SymmetryDatabase {
public:
  using Cloud = pcl::PointCloud<pcl::PointXYZ>;

  /// Opens a database. A folder that is missing or empty becomes an empty database.
  /// \throws pcl::IOException naming file and reason.
  /// \throws pcl::BadArgumentException for bad options.
  explicit SymmetryDatabase(const std::string& folder, const DatabaseOptions& options = {});
  ~SymmetryDatabase();
  SymmetryDatabase(SymmetryDatabase&&) noexcept;
  SymmetryDatabase& operator=(SymmetryDatabase&&) noexcept;

  /// \return names of all models, sorted.
  std::vector<std::string> names() const;
  std::size_t size() const;
  bool contains(const std::string& name) const;

  /// Adds a model, or replaces the model of that name. The model is stored by save(), and found after save() or
  /// rebuild().
  /// \param name 1 to 100 letters, digits and "_-."; the first one is not ".".
  /// \param cloud the object seen from all sides.
  /// \throws pcl::BadArgumentException for another name or a cloud that holds no answer: it would never be found.
  void add(const std::string& name, const Cloud& cloud);
  /// Removes a model. Its files are removed by save().
  /// \throws pcl::BadArgumentException where there is no such model.
  void remove(const std::string& name);
  /// Fits the compact forms anew to the models that are there now, and indexes all models.
  /// \throws pcl::IOException naming file and reason.
  void rebuild();
  /// Stores all changes. The compact forms are fitted anew if they have less than half of the references that
  /// DatabaseOptions::num_references asks for.
  /// \throws pcl::IOException naming file and reason.
  void save();

  /// \return the cloud of a model, at most DatabaseOptions::max_points points.
  /// \throws pcl::BadArgumentException where there is no such model.
  /// \throws pcl::IOException naming file and reason.
  Cloud cloud(const std::string& name) const;

  /// Models of like shape, whatever their size and pose.
  /// \param cloud the object seen from all sides, or a scan.
  /// \param num_nearest >= 0.
  /// \param viewpoint where the scanner stood.
  /// \return nearest first, at most \p num_nearest.
  /// \throws pcl::BadArgumentException for bad parameters.
  std::vector<ModelMatch> match(const Cloud& cloud, int num_nearest = 10, const Viewpoint& viewpoint = {}) const;

  /// The models that a scan can show, in the unit of the models. Candidates look like the scan from some side; without
  /// a viewpoint, candidates are of like shape.
  /// \param scan at least two different finite points.
  /// \param viewpoint
  /// where the scanner stood.
  /// \return accepted models, best first.
  /// \throws pcl::BadArgumentException for bad options.
  /// \throws pcl::IOException naming file and reason.
  Recognition recognize(const Cloud& scan, const RecognitionOptions& options = {},
                        const Viewpoint& viewpoint = {}) const;

private:
  std::unique_ptr<detail::DatabaseParts> parts_;
};

}  // namespace pcl_symmetry
