#pragma once

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "core/matching/compact_index.h"
#include "core/matching/shape_description.h"
#include "core/matching/signature_projection.h"
#include "core/views/view_index.h"
#include "pcl_symmetry/registration/cloud_registration.h"
#include "pcl_symmetry/viewpoint.h"

namespace pcl_symmetry {

struct DatabaseOptions {
  int num_references = 128;         ///< models, spread over all, that compact forms are made from, >= 1
  int num_views = 80;               ///< of a model, that scans are compared with, >= 1
  std::size_t max_points = 20'000;  ///< of a cloud that are kept, >= 100
  int num_threads = 0;              ///< >= 0; 0 = one per core

  /// \throws std::invalid_argument naming field, value and rule.
  void validate() const;
};

struct RecognitionOptions {
  int num_candidates = 10;  ///< models that are brought to the scan, >= 1 ...
  int num_refined = 4;      ///< ... and of a view, those of the best poses that are brought to it exactly, >= 1
  /// What a factor of e between the size of the scan and that of a model's view adds to their distance, >= 0. Less
  /// where much of an object is hidden behind others.
  double size_weight = 0.25;
  /// Of a pose by which a model is known, in [-1, 1], see SymmetryRegistration. For clouds that are sampled evenly, as
  /// by scanners; points drawn at random meet less well.
  double min_merit = 0.64;
  CloudRegistrationOptions registration = quickRegistration();
  int num_threads = 0;  ///< >= 0; 0 = one per core

  /// A search for poses that takes a tenth of the time of the default.
  static CloudRegistrationOptions quickRegistration();
  /// \throws std::invalid_argument naming field, value and rule.
  void validate() const;
};

struct ModelMatch {
  std::string name;
  double distance;  ///< of the signatures, in [0, 2]
};

struct RecognizedModel {
  std::string name;
  Eigen::Isometry3d T_model_scan = Eigen::Isometry3d::Identity();
  PoseScore score;
  /// How likely this model and no other of the database: merits compared by soft maximum, times how far the merit lies
  /// above the least one. In [0, 1]; they add up to no more than 1.
  double confidence = 0.0;
};

/// Known models, best first; none: an unknown object.
using Recognition = std::vector<RecognizedModel>;

/// Models in a folder, found by their symmetry: whole ones of the same kind, or the very one that a scan shows (Section
/// 5.2).
///
/// The folder holds manifest.txt, the models' clouds, signatures and views, and the compact forms of all. A change is
/// written beside what is there and counts from the moment that the new manifest takes the name of the old one: an
/// interrupted one leaves the old state whole.
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

  /// Opens a database; a folder that does not exist or is empty becomes an empty one.
  /// \throws pcl::IOException naming file and reason, pcl::BadArgumentException for bad options.
  explicit SymmetryDatabase(const std::string& folder, const DatabaseOptions& options = {});

  std::vector<std::string> names() const;
  std::size_t size() const { return models_.size(); }
  bool contains(const std::string& name) const { return models_.count(name) > 0; }

  /// Adds a model, or replaces that of the name. It is not stored before save(), nor found before save() or rebuild().
  /// \param name of letters, digits and "_-." and no more than 100 of them. \param cloud seen from all sides.
  /// \throws pcl::BadArgumentException for another name or a cloud without extent.
  void add(const std::string& name, const Cloud& cloud);
  /// \throws pcl::BadArgumentException where there is no such model.
  void remove(const std::string& name);
  /// Makes the compact forms anew, from the models that are there now.
  void rebuild();
  /// Stores what has changed; rebuilds where the models have become more than twice those that compact forms are made
  /// from. \throws pcl::IOException naming file and reason.
  void save();

  /// \return the cloud of a model. \throws pcl::BadArgumentException where there is none, pcl::IOException.
  Cloud cloud(const std::string& name) const;

  /// Models of like shape, whatever their size and pose, nearest first. \param cloud seen from all sides, or a scan.
  std::vector<ModelMatch> match(const Cloud& cloud, int num_nearest = 10, const Viewpoint& viewpoint = {}) const;

  /// The models that a scan can be a view of, in the same unit. Candidates look like it from some side; without a
  /// viewpoint they are those of like shape. \throws pcl::BadArgumentException for bad options or a scan without
  /// extent.
  Recognition recognize(const Cloud& scan, const RecognitionOptions& options = {},
                        const Viewpoint& viewpoint = {}) const;

private:
  struct Model {
    std::string file;            ///< name of its files without extension; empty: not stored yet
    Cloud cloud;                 ///< empty where it is stored
    Eigen::MatrixXf signatures;  ///< empty where they are stored
    Eigen::MatrixXf compact;     ///< of the projection; empty: not made yet
    std::vector<View> views;     ///< empty where they are stored
  };

  std::string path(const std::string& file) const;
  void load();
  void loadCompactForms();
  void storeModel(const std::string& name, Model& model);
  Eigen::MatrixXf signatures(const Model& model) const;
  std::vector<View> views(const Model& model) const;
  void fillIndex();
  void removeStrayFiles() const;
  std::vector<std::pair<int, float>> nearest(const Points& points, const Visibility* seen, int count) const;
  Recognition recognizeView(const Points& points, const Points& scan, const Visibility& seen,
                            const RecognitionOptions& options, const CloudRegistrationOptions& registration) const;
  Recognition recognizeWhole(const Points& points, const Points& scan, const RecognitionOptions& options,
                             const CloudRegistrationOptions& registration) const;

  std::string folder_;
  DatabaseOptions options_;
  std::map<std::string, Model> models_;
  int next_file_ = 1;
  int num_fitted_ = 0;           // models that the projection was made from
  std::string projection_file_;  // name of its files without extension
  SignatureProjection projection_;
  std::vector<std::string> indexed_;  // names, in the order of the index
  CompactIndex index_;
  ViewIndex view_index_;
  bool changed_ = false;
};

}  // namespace pcl_symmetry
