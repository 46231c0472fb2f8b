#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "pcl_symmetry/symmetry_database.h"
#include "recognition/sqlite_connection.h"

namespace pcl_symmetry::detail {

/// Increases by 1 when tables or the bytes in them change.
constexpr int kSchemaVersion = 7;

/// The data by which a model is found and recognized, as bytes, see packed_model.h.
struct PackedModel {
  std::string cloud, signatures, views, surfaces;
  std::size_t num_points = 0;
};

enum class ModelPart { Cloud, Signatures, Views, Surfaces };

struct StoredModel {
  std::int64_t id;  ///< id of one model that was added once; never reused
  std::string name;
};

/// Data fitted to a database, as bytes: CompactForms, and the ViewCoder as packedMatrices().
struct PackedProjection {
  std::int64_t id = 0;
  int num_references = 0;
  std::string values;
  std::string view_coder;
};
/// The forms of a model for these data: bytes of a CompactForm, and packedViewCodes().
struct PackedForms {
  std::int64_t model = 0;
  std::string forms;
  std::string view_codes;
};

/// Selects one of the PackedForms.
enum class FormPart { Compact, ViewCodes };
/// \return how messages name the part of a model, up to its number.
inline const char* nameOf(FormPart part) {
  return part == FormPart::Compact ? "the compact form of model " : "the code of views of model ";
}

/// The file of a database. Every function throws pcl::IOException, which names the file and the reason.
/// Until refresh() or a change by this store, all reads see the state of the first one. When a
/// function returns, its changes are on the disk, all of them or none.
class ModelStore {
public:
  /// Receives the id of a model and its bytes.
  using EachBytes = std::function<void(std::int64_t, const std::string&)>;

  /// Nothing is written before the first change: a missing file is an empty database.
  /// \param file ":memory:" = no file.
  /// \param unit unit to store in a new database; for an existing one, its unit or empty.
  ModelStore(const std::string& file, double lock_timeout, const std::string& unit);

  const std::string& file() const { return file_; }
  /// Whether there is a file.
  bool exists() const { return connection_.has_value(); }
  /// Reads the newest state from now on.
  void refresh();
  /// A number that changes with the state that is read.
  std::uint64_t version();
  /// Facts about the database: "library_version", "unit".
  std::string fact(const std::string& key);

  /// Sorted by name.
  const std::vector<StoredModel>& models();
  std::int64_t size();
  /// The id of a model, and where it comes from. It takes as long for many models as for few.
  std::optional<std::pair<std::int64_t, ModelInfo>> find(const std::string& name);
  std::string part(ModelPart part, const StoredModel& model);
  /// The id of the projection that was stored last; 0 = none.
  std::int64_t projectionId();
  std::vector<StoredModel> modelsWithoutForms();
  std::optional<PackedProjection> projection();
  /// The forms of the models for a projection, by ascending id of the model.
  void each(FormPart part, std::int64_t projection, const EachBytes& take);

  /// Adds a model, or replaces the model of that name.
  /// \param projection projection that the forms were made with; 0 = there are no forms.
  /// \param forms forms of this model, with any id.
  /// \return the id of the new model.
  std::int64_t add(const ModelInfo& info, const PackedModel& model, std::int64_t projection, PackedForms forms);
  /// \return whether there was a model of that name.
  bool remove(const std::string& name);
  /// Replaces the projection and everything that was made with it. Deleted models are skipped.
  void setProjection(const PackedProjection& projection, const std::vector<PackedForms>& forms);
  /// Adds all models of other databases in one change, as they are stored there; forms and projections are not copied.
  /// If there is no file yet, the new one has their unit.
  /// \return the number of models; nothing if the progress function cancels, and then nothing is changed.
  std::optional<std::size_t> merge(const std::vector<std::string>& files, const BuildProgress& progress);
  /// Adds missing forms. Nothing happens if the projection is no longer the stored one.
  void addForms(std::int64_t projection, const std::vector<PackedForms>& forms);

  /// The errors in the contents, one sentence each.
  std::vector<std::string> damages();

private:
  bool startReading();
  void endReading();
  void open();
  using Fill = std::function<void(const SQLiteConnection&)>;

  void create(const Fill& fill = {});
  void makeTables(const SQLiteConnection& connection, const Fill& fill) const;
  template <typename Body>
  void change(const Body& body);
  std::size_t checkBeforeMerge(const std::vector<std::string>& files);
  void insertForms(std::int64_t projection, const std::vector<PackedForms>& forms);

  std::string file_, unit_;
  double lock_timeout_;
  std::optional<SQLiteConnection> connection_;
  std::vector<StoredModel> models_;
  std::uint64_t version_ = 1, models_version_ = 0;
  std::int64_t data_version_ = -1;  // SQLite's count of changes by others
};

/// A part of a model, which \p unpack makes from its bytes.
/// \param name name of the part in the message if \p unpack throws std::invalid_argument.
/// \param mutex held while the store is read.
template <typename Unpack>
auto unpackedPart(ModelStore& store, ModelPart part, const std::string& name, const StoredModel& model,
                  std::mutex& mutex, const Unpack& unpack) {
  std::unique_lock<std::mutex> lock(mutex);
  const std::string bytes = store.part(part, model);
  lock.unlock();
  try {
    return unpack(bytes);
  } catch (const std::invalid_argument& error) {
    failIO(store.file(), "the " + name + " of model '" + model.name + "' " + error.what());
  }
}

}  // namespace pcl_symmetry::detail
