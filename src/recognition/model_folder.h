#pragma once

#include <Eigen/Core>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/matching/signature_projection.h"
#include "recognition/database_files.h"

namespace pcl_symmetry::detail {

/// Compact forms of each model: one for each of the signatureFrames().
constexpr int kFormsPerModel = 2;  // derived: the number of signatureFrames()

/// A model of a database. Its cloud, signatures and views are in memory until they are stored, then in its files.
struct Model {
  std::string file;            ///< name of its files without extension; empty: not stored yet
  PositionCloud cloud;         ///< empty where it is stored
  Eigen::MatrixXf signatures;  ///< kSignatureSize x kFormsPerModel; empty where they are stored
  std::vector<View> views;     ///< empty where they are stored
  Eigen::MatrixXf compact;     ///< dimensions of the projection x kFormsPerModel; empty: not made yet
};

/// Models by name.
using Models = std::map<std::string, Model>;

/// True for 1 to 100 letters, digits and "_-.", where the first one is not ".".
bool isModelName(const std::string& name);

/// The contents of manifest.txt: which files hold the database.
struct Manifest {
  int next_file = 1;                         ///< number of the next file that is written
  int num_references = 0;                    ///< models that the projection was fitted to
  std::string common_file;                   ///< name of the projection and the compact forms, without extension
  std::map<std::string, std::string> files;  ///< from the name of a model to that of its files, without extension

  /// Names of all files, with their extensions.
  std::set<std::string> allFiles() const;
};

/// The folder of a database.
///
/// A save never touches a file that the current manifest names. It first writes the new manifest as manifest.txt.new,
/// then the new files, then renames the manifest: a save that is interrupted before that leaves the old state whole,
/// and the next save removes the files that only manifest.txt.new names. Files are removed only where an earlier
/// manifest, current or new, named them: other files in the folder belong to the user and are neither removed nor
/// overwritten.
class ModelFolder {
public:
  /// Reads the manifest; without one, the folder must be missing or empty.
  /// \throws pcl::IOException naming file and reason.
  explicit ModelFolder(const std::string& path);

  const Manifest& manifest() const { return manifest_; }

  /// \throws pcl::IOException naming file and reason.
  SignatureProjection projection() const;
  /// \return the models of the manifest, with their compact forms.
  /// \throws pcl::IOException naming file and reason.
  Models models(const SignatureProjection& projection) const;

  /// What a model holds, from memory or from its file.
  /// \throws pcl::IOException naming file and reason.
  PositionCloud cloud(const Model& model) const;
  Eigen::MatrixXf signatures(const Model& model) const;
  std::vector<View> views(const Model& model) const;

  /// Writes the models that are not stored yet and all compact forms, and removes the files that are no longer needed.
  /// \throws pcl::IOException naming file and reason; the models are unchanged then.
  void save(Models& models, const SignatureProjection& projection, int num_references);

private:
  std::string pathOf(const std::string& file) const;
  bool exists(const std::string& file) const;
  std::optional<Manifest> interruptedSave() const;
  Manifest nextManifest(const Models& models, int num_references) const;
  void writeManifest(const std::string& file, const Manifest& manifest) const;
  void writeModel(const std::string& file, const Model& model) const;
  void writeCompactForms(const std::string& file, const Models& models, const SignatureProjection& projection) const;
  void removeFiles(const Manifest& outdated) const;

  std::string path_;
  Manifest manifest_;
};

}  // namespace pcl_symmetry::detail
