/// Models in a file, found by shape or recognized in a scan (Section 5.2).
#pragma once

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "pcl_symmetry/core/exports.h"
#include "pcl_symmetry/symmetry_registration.h"
#include "pcl_symmetry/viewpoint.h"

namespace PCL_SYMMETRY_EXPORTS pcl_symmetry {

namespace detail {
struct DatabaseParts;
}

/// Options of a database.
struct DatabaseOptions {
  /// Number of models, drawn by their names, to which compact forms are fitted and by which distances are scaled, >= 1.
  /// Twice as many take four times the time and memory of the fit.
  int num_references = 200;
  /// Number of views of a model that scans are compared with, >= 1: with 80, one is within 12 degrees of any direction.
  int num_views = 80;
  std::size_t max_points = 20'000;  ///< points of a cloud that are kept, >= 100
  int num_threads = 0;              ///< >= 0; 0 = one per core
  double lock_timeout = 30.0;       ///< seconds that a change waits while another program writes, >= 0
  /// Unit of the coordinates of all models, such as "m", stored when the database is made. For an existing database:
  /// empty, or the unit that is stored.
  std::string unit;
  /// If true, build() fits no compact forms: for a part of a database, because merge() fits those of the whole.
  bool is_part = false;

  /// Checks all values.
  /// \throws std::invalid_argument naming field, value and rule.
  void validate() const;
};

/// Options of SymmetryDatabase::recognize().
struct RecognitionOptions {
  int num_candidates = 10;  ///< models that look most like the scan, which are tried first, >= 1
  /// Greatest number of models tried, num_candidates included, >= 1, for scans from a viewpoint in databases of more
  /// than 300 models: the others are tried if none of the first num_candidates is accepted. An unknown object takes the
  /// time of all.
  int max_candidates = 70;
  /// Number of models with the best poses that are refined, >= 1, for scans from a viewpoint; in databases of more than
  /// 300 models, as many again of those tried after the first num_candidates.
  int num_refined = 4;
  double min_confidence = 0.5;  ///< least confidence of an accepted model, in [0, 1], see RecognizedModel::confidence
  int num_threads = 0;          ///< >= 0; 0 = one per core

  /// Checks all values.
  /// \throws std::invalid_argument naming field, value and rule.
  void validate() const;
};

/// A model that is similar to a query.
struct ModelMatch {
  std::string name;  ///< name of the model
  /// L2 distance of the compact signatures, divided by the geometric mean of both shapes' mean distances to their ten
  /// nearest references: 1 if two shapes are as far from each other as from the references most like them.
  double distance;
};

/// Evidence for a model in the pose of a scan. Surfaces agree within the resolution of the scanner.
struct ModelEvidence {
  double on_model = 0.0;  ///< share of the scan's points near the model that lie on its surface, in [0, 1]
  double shown = 0.0;     ///< share of the model's surface facing the scanner that was measured, in [0, 1]
};

/// A model that a scan shows, and where.
struct RecognizedModel {
  std::string name;                                                ///< name of the model
  Eigen::Isometry3d T_model_scan = Eigen::Isometry3d::Identity();  ///< maps the frame of the scan to that of the model
  /// How well the scan fits there: support is the share of its points on the surface of the model, within the spacing
  /// and the noise of the scan. The density of the model's points does not matter.
  PoseScore score;
  ModelEvidence evidence;  ///< what the confidence follows from
  /// Probability that the scan shows this model or one of the same shape, in [0, 1]. It follows from the evidence and
  /// from the lead in merit over the best model of another shape, and was fitted to virtual and real scans of objects
  /// in the database and of others. The sum over shapes is at most 1. Two models are of the same shape if they share 90
  /// % of their surfaces where the scan puts them. The best model is judged before rotations about its axes are tried
  /// for a better pose.
  double confidence = 0.0;
};

/// Accepted models, best first. Empty: the object is unknown.
using Recognition = std::vector<RecognizedModel>;

/// The origin of a model; unknown fields are empty.
struct ModelSource {
  std::string path;               ///< file or address
  std::string checksum;           ///< checksum of the content; build() skips models whose checksum is stored
  std::vector<std::string> tags;  ///< its class, or any other words; one line each
};

/// Data stored for a model besides its points.
struct ModelInfo {
  std::string name;            ///< unique in the database
  std::int64_t time = 0;       ///< when it was stored, seconds since 1970 (UTC)
  ModelSource source;          ///< empty where none was given
  std::size_t num_points = 0;  ///< number of stored points
};

/// A model of a long build. Its functions are called by several threads at once.
struct ModelInput {
  std::string name;                                           ///< name of the model in the database
  std::function<ModelSource()> source;                        ///< nothing: no source is stored
  std::function<pcl::PointCloud<pcl::PointXYZ>()> load = {};  ///< called unless the source is stored already
};

/// Result of SymmetryDatabase::build().
struct BuildReport {
  std::size_t num_added = 0;                                  ///< models that were stored
  std::size_t num_kept = 0;                                   ///< models whose source was stored before
  std::vector<std::pair<std::string, std::string>> failures;  ///< name and reason, in the order of the inputs
  bool cancelled = false;                                     ///< whether the progress function ended the build
};

/// Receives the share of the work that is done, in [0, 1]; returns whether to continue.
using BuildProgress = std::function<bool(double)>;

/// Models in a file, found by their symmetry (Section 5.2): match() finds models of similar shape, recognize() the
/// model that a scan shows.
///
/// The file is a database of SQLite. What a function changes is on the disk when it returns, whole or not at all, also
/// if the program is killed. Several programs may read while one writes; a second writer waits, see
/// DatabaseOptions::lock_timeout. A database that is open shows the state of its first reading, or that after its own
/// last change, until refresh(). While it is open, SQLite keeps FILE-wal and FILE-shm beside the file.
///
/// Parts of models are read when a query needs them. An object may be used by several threads for queries, or by one
/// for changes. Clouds that hold no answer (fewer than 20 distinct points, or all of them on one line) give an empty
/// result and a PCL_WARN.
///
/// \code
/// pcl_symmetry::SymmetryDatabase database("models.db");
/// database.add("milk", cloud);
/// for (const auto& model : database.recognize(scan)) std::cout << model.name << ' ' << model.confidence << '\n';
/// \endcode
class SymmetryDatabase {
public:
  using Cloud = pcl::PointCloud<pcl::PointXYZ>;

  /// Opens a database. A file that is missing is an empty database, and is made by the first change.
  /// \param file ":memory:" = no file: the models are gone with the object.
  /// \throws pcl::IOException naming file and reason: not a database of this library, of a newer or older version,
  /// damaged.
  /// \throws pcl::BadArgumentException for bad options, and for another unit than the database has.
  explicit SymmetryDatabase(const std::string& file, const DatabaseOptions& options = {});
  ~SymmetryDatabase();
  SymmetryDatabase(SymmetryDatabase&&) noexcept;             ///< the other one may only be destroyed or assigned to
  SymmetryDatabase& operator=(SymmetryDatabase&&) noexcept;  ///< as above

  /// \return names of all models, sorted by their bytes.
  std::vector<std::string> names() const;
  std::size_t size() const;                      ///< number of models
  bool contains(const std::string& name) const;  ///< whether there is such a model
  /// Data of a model besides its shape.
  /// \throws pcl::BadArgumentException if there is no such model.
  ModelInfo info(const std::string& name) const;
  /// \return the unit that the database was made with.
  std::string unit() const;
  /// Reads the changes that others have made since.
  void refresh();

  /// Stores a model, or replaces the model of that name. It is found at once.
  /// \param name 1 to 200 bytes of UTF-8 without "/" and control characters; the first one is not ".".
  /// \param cloud the object seen from all sides.
  /// \throws pcl::BadArgumentException for another name or a cloud that holds no answer: it would never be found.
  /// \throws pcl::IOException naming file and reason; the database is unchanged then.
  void add(const std::string& name, const Cloud& cloud, const ModelSource& source = {});
  /// Removes a model.
  /// \throws pcl::BadArgumentException if there is no such model.
  /// \throws pcl::IOException naming file and reason; the database is unchanged then.
  void remove(const std::string& name);
  /// Stores many models, each as soon as it is described, and fits the compact forms as save() does, unless
  /// DatabaseOptions::is_part. Models that cannot be used are reported, and the others stored. An interrupted build
  /// goes on where it stopped: a model of the same name and the same source checksum is kept.
  /// \throws pcl::IOException naming file and reason; earlier changes stay stored.
  BuildReport build(const std::vector<ModelInput>& models, const BuildProgress& progress = {});
  /// Adds the models of other databases, such as parts that several machines built, and fits the compact forms as
  /// save() does. Models are copied, not described again, in one change: all of them or none. The result answers like a
  /// database built of all models at once. A database that has no file yet takes the unit of the others.
  /// \param progress where it returns false, nothing is changed.
  /// \return the number of models that were added.
  /// \throws pcl::IOException naming file and reason: missing, damaged, of another version or unit, or with a model
  /// whose name is that of another one; this database is unchanged then.
  std::size_t merge(const std::vector<std::string>& files, const BuildProgress& progress = {});
  /// Stores what models are found by: compact forms are fitted again if they were fitted to models other than those
  /// that DatabaseOptions::num_references draws now, and missing ones are added. Otherwise each program that queries
  /// the database does so for itself. Distances depend on the models that are stored, not on the order of changes.
  /// \throws pcl::IOException naming file and reason; the database is unchanged then.
  void save();
  /// Fits the compact forms anew to the models that are there now.
  /// \throws pcl::IOException naming file and reason; the database is unchanged then.
  void rebuild();

  /// \return the damages, a sentence each; empty if there are none.
  /// \throws pcl::IOException naming file and reason where it cannot be read at all.
  static std::vector<std::string> check(const std::string& file);

  /// \return the cloud of a model, at most DatabaseOptions::max_points points. Coordinates differ from those that were
  /// added by at most 7.7e-6 of the greatest extent; points have another order.
  /// \throws pcl::BadArgumentException if there is no such model.
  /// \throws pcl::IOException naming file and reason.
  Cloud cloud(const std::string& name) const;

  /// Models of similar shape, whatever their size and pose.
  /// \param cloud the object seen from all sides, or a scan.
  /// \param num_nearest >= 1.
  /// \param viewpoint where the scanner stood.
  /// \return nearest first, at most \p num_nearest.
  /// \throws pcl::BadArgumentException for bad parameters.
  /// \throws pcl::IOException naming file and reason.
  std::vector<ModelMatch> match(const Cloud& cloud, int num_nearest = 10, const Viewpoint& viewpoint = {}) const;

  /// Prepares what recognize() needs for scans from a viewpoint, once, on all threads of DatabaseOptions; otherwise its
  /// first call does. A call after a change adds the new models.
  /// \throws pcl::IOException naming file and reason.
  void prepare() const;

  /// Finds the models that a scan may show. The scan has the unit of the models. Candidates look like the scan from
  /// some side; without a viewpoint, candidates are of similar shape.
  /// \param scan at least two different finite points.
  /// \param viewpoint where the scanner stood.
  /// \return accepted models, best first.
  /// \throws pcl::BadArgumentException for bad options.
  /// \throws pcl::IOException naming file and reason.
  Recognition recognize(const Cloud& scan, const RecognitionOptions& options = {},
                        const Viewpoint& viewpoint = {}) const;

  /// The same for an object of a scene.
  /// \param scene all that the scanner measured.
  /// \param cluster the points of the object, indices into the scene. Other objects in front may hide much of it.
  /// \param seen what the scanners saw of the scene, determined once for all its clusters; null: determined from \p
  /// scene.
  /// \throws pcl::BadArgumentException for bad options, and for indices that the scene does not have.
  Recognition recognize(const Cloud& scene, const pcl::Indices& cluster, const RecognitionOptions& options = {},
                        const SeenSpace::ConstPtr& seen = nullptr) const;

  /// The same for clouds of other point types; colors and other fields are not used.
  template <typename PointT>
  void add(const std::string& name, const pcl::PointCloud<PointT>& cloud, const ModelSource& source = {}) {
    add(name, *detail::positionsOf(cloud), source);
  }
  /// As match() of a Cloud.
  template <typename PointT>
  std::vector<ModelMatch> match(const pcl::PointCloud<PointT>& cloud, int num_nearest = 10,
                                const Viewpoint& viewpoint = {}) const {
    return match(*detail::positionsOf(cloud), num_nearest, viewpoint);
  }
  /// As recognize() of a Cloud.
  template <typename PointT>
  Recognition recognize(const pcl::PointCloud<PointT>& scan, const RecognitionOptions& options = {},
                        const Viewpoint& viewpoint = {}) const {
    return recognize(*detail::positionsOf(scan), options, viewpoint);
  }

private:
  std::unique_ptr<detail::DatabaseParts> parts_;
};

}  // namespace pcl_symmetry
