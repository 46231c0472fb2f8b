#include "recognition/model_store.h"

#include <fcntl.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <exception>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string_view>

#include "pcl_symmetry/impl/cloud_conversion.hpp"

namespace pcl_symmetry::detail {

namespace fs = std::filesystem;

namespace {

/// The name of a database that has no file.
constexpr const char* kNoFile = ":memory:";
constexpr const char* kSelectModels =
    "SELECT id, name, time, source, source_checksum, tags, num_points, checksum FROM models";
constexpr std::int64_t kApplicationId = 0x50537944;  // the letters PSyD

struct Table {
  std::string name, definition;
};
/// A table for each part of a model, so that a query reads what it needs.
std::vector<Table> tables() {
  const std::string model = "(model INTEGER PRIMARY KEY REFERENCES models ON DELETE CASCADE, ",
                    projection = "projection INTEGER NOT NULL REFERENCES projections ON DELETE CASCADE, ",
                    data = "data BLOB NOT NULL, checksum INTEGER NOT NULL)";
  std::vector<Table> tables{
      {"facts", "(key TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID"},
      {"models",
       "(id INTEGER PRIMARY KEY AUTOINCREMENT, name TEXT NOT NULL UNIQUE, time INTEGER NOT NULL, source TEXT NOT NULL, "
       "source_checksum TEXT NOT NULL, tags TEXT NOT NULL, num_points INTEGER NOT NULL, checksum INTEGER NOT NULL)"},
      {"clouds", model + data},
      {"signatures", model + data},
      {"views", model + data},
      {"surfaces", model + data},
      {"projections", "(id INTEGER PRIMARY KEY AUTOINCREMENT, num_references INTEGER NOT NULL, " + data},
      {"compact", model + projection + data},
      {"view_coders", "(projection INTEGER PRIMARY KEY REFERENCES projections ON DELETE CASCADE, " + data},
      {"view_codes", model + projection + data}};
  for (Table& table : tables) table.definition = "CREATE TABLE " + table.name + " " + table.definition;
  return tables;
}

struct PartTable {
  ModelPart part;
  const char* name;
  std::string PackedModel::*data;
};
const PartTable kPartTables[] = {{ModelPart::Cloud, "clouds", &PackedModel::cloud},
                                 {ModelPart::Signatures, "signatures", &PackedModel::signatures},
                                 {ModelPart::Views, "views", &PackedModel::views},
                                 {ModelPart::Surfaces, "surfaces", &PackedModel::surfaces}};

/// Tags as stored: one per line.
std::string joinedTags(const std::vector<std::string>& tags) {
  std::string text;
  for (const std::string& tag : tags) text += (text.empty() ? "" : "\n") + tag;
  return text;
}

/// CRC-32 of texts, each with its end: it detects any change of up to 32 neighboring bits.
std::int64_t checksumOf(std::initializer_list<std::string_view> texts) {
  std::uint32_t value = 0;
  for (const std::string_view text : texts) {
    value = static_cast<std::uint32_t>(crc32_z(value, reinterpret_cast<const Bytef*>(text.data()), text.size()));
    value = static_cast<std::uint32_t>(crc32_z(value, reinterpret_cast<const Bytef*>(""), 1));
  }
  return value;
}

/// Checksums include the table and the number of the model, so that parts of different models cannot be mixed up.
std::int64_t checksumOf(std::int64_t id, const ModelInfo& info) {
  return checksumOf({std::to_string(id), info.name, std::to_string(info.time), info.source.path, info.source.checksum,
                     joinedTags(info.source.tags), std::to_string(info.num_points)});
}

std::int64_t checksumOf(const std::string& table, std::int64_t id, const std::string& data) {
  return checksumOf({table, std::to_string(id), data});
}

void createSchema(const SQLiteConnection& connection, const std::string& unit) {
  for (const Table& table : tables()) connection.run(table.definition);
  SQLiteStatement fact = connection.prepare("INSERT INTO facts VALUES (?, ?)");
  fact.bind(std::string("library_version"), std::string(PCL_SYMMETRY_VERSION)).run();
  fact.bind(std::string("unit"), unit).run();
  connection.run("PRAGMA application_id = " + std::to_string(kApplicationId));
  connection.run("PRAGMA user_version = " + std::to_string(kSchemaVersion));
}

/// Checks the file without SQLite, which would accept any file as its own.
void refuseForeignFile(const std::string& file) {
  std::error_code error;
  if (fs::is_directory(file, error)) failIO(file, "is a folder, must be a file");
  if (!fs::is_regular_file(file, error)) failIO(file, "must be a file");
  std::ifstream stream(file, std::ios::binary);
  std::array<unsigned char, 100> header{};
  stream.read(reinterpret_cast<char*>(header.data()), static_cast<std::streamsize>(header.size()));
  if (!stream && !stream.eof()) failIO(file, std::string("cannot be read, ") + std::strerror(errno));
  std::int64_t id = 0;
  for (std::size_t i = 0; i < 4; ++i) id = id << 8 | header[68 + i];
  if (std::memcmp(header.data(), "SQLite format 3", 16) != 0 || id != kApplicationId)
    failIO(file, "is no database of pcl_symmetry, or its first 100 bytes are damaged; it is left as it is");
}

/// Refuses databases of newer and of older libraries.
void refuseOtherSchema(const SQLiteConnection& connection) {
  const std::int64_t version = connection.integer("PRAGMA user_version");
  if (version > kSchemaVersion)
    failIO(connection.file(), "has version " + std::to_string(version) +
                                  " of the tables, which a newer library wrote; " + PCL_SYMMETRY_VERSION +
                                  " reads version " + std::to_string(kSchemaVersion));
  if (version < kSchemaVersion)
    failIO(connection.file(), "has version " + std::to_string(version) +
                                  " of the tables, which an older library wrote; " + PCL_SYMMETRY_VERSION +
                                  " reads version " + std::to_string(kSchemaVersion) + ": build the database again");
}

/// Finds tables whose definition is not the one that this library writes.
void compareTables(const SQLiteConnection& connection, std::vector<std::string>& damages) {
  for (const Table& table : tables()) {
    SQLiteStatement row = connection.prepare("SELECT sql FROM sqlite_schema WHERE type = 'table' AND name = ?");
    row.bind(table.name);
    if (!row.next() || row.text(0) != table.definition)
      damages.push_back("the definition of table " + table.name + " is damaged");
  }
}

/// Finds blobs whose checksum does not match.
void compareBlobs(const SQLiteConnection& connection, const std::string& table, const std::string& key,
                  std::vector<std::string>& damages) {
  SQLiteStatement row = connection.prepare("SELECT " + key + ", data, checksum FROM " + table);
  while (row.next())
    if (checksumOf(table, row.integer(0), row.blob(1)) != row.integer(2))
      damages.push_back("the " + table + " of number " + std::to_string(row.integer(0)) + " are damaged");
}

/// \param damages errors in the rows of models.
/// \return one sentence per damage.
std::vector<std::string> damagesOf(const SQLiteConnection& connection, std::vector<std::string> damages) {
  compareTables(connection, damages);
  for (const char* pragma : {"PRAGMA integrity_check", "PRAGMA foreign_key_check"}) {
    SQLiteStatement row = connection.prepare(pragma);
    while (row.next())
      if (row.text(0) != "ok") damages.push_back("structure of the file: " + row.text(0));
  }
  for (const PartTable& part : kPartTables) {
    const std::string table = part.name;
    compareBlobs(connection, table, "model", damages);
    SQLiteStatement missing =
        connection.prepare("SELECT name FROM models WHERE id NOT IN (SELECT model FROM " + table + ")");
    while (missing.next()) damages.push_back("the " + table + " of model '" + missing.text(0) + "' are missing");
  }
  compareBlobs(connection, "compact", "model", damages);
  compareBlobs(connection, "view_codes", "model", damages);
  compareBlobs(connection, "projections", "id", damages);
  compareBlobs(connection, "view_coders", "projection", damages);
  return damages;
}

std::vector<std::string> splitLines(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

ModelInfo infoOf(const SQLiteStatement& row) {
  ModelInfo info;
  info.name = row.text(1);
  info.time = row.integer(2);
  info.source = {row.text(3), row.text(4), splitLines(row.text(5))};
  info.num_points = static_cast<std::size_t>(row.integer(6));
  return info;
}

ModelInfo checkedInfo(const SQLiteStatement& row, const std::string& file) {
  ModelInfo info = infoOf(row);
  if (checksumOf(row.integer(0), info) != row.integer(7))
    failIO(file, "the record of model " + std::to_string(row.integer(0)) + " is damaged");
  return info;
}

/// \return the id of the new model.
std::int64_t insertModel(const SQLiteConnection& connection, const ModelInfo& info, const PackedModel& model) {
  // The id is computed before the row exists, because the checksum includes it.
  const std::int64_t id = connection.integer("SELECT seq FROM sqlite_sequence WHERE name = 'models'") + 1;
  connection.prepare("INSERT INTO models VALUES (?, ?, ?, ?, ?, ?, ?, ?)")
      .bind(id, info.name, info.time, info.source.path, info.source.checksum, joinedTags(info.source.tags),
            static_cast<std::int64_t>(info.num_points), checksumOf(id, info))
      .run();
  for (const PartTable& table : kPartTables)
    connection.prepare(std::string("INSERT INTO ") + table.name + " VALUES (?, ?, ?)")
        .bind(id, SQLiteBlob{model.*table.data}, checksumOf(table.name, id, model.*table.data))
        .run();
  return id;
}

}  // namespace

ModelStore::ModelStore(const std::string& file, double lock_timeout, const std::string& unit)
    : file_(file), unit_(unit), lock_timeout_(lock_timeout) {
  if (file_ == kNoFile) {
    connection_.emplace(file_, SQLiteAccess::Memory, lock_timeout_);
    makeTables(*connection_, {});
  } else {
    open();
  }
}

/// Opens the file if it exists. Refuses files that this library did not write, and another unit than the given one.
void ModelStore::open() {
  std::error_code error;
  if (!fs::exists(file_, error) && !error) return;
  if (error) failIO(file_, error.message());
  refuseForeignFile(file_);
  connection_.emplace(file_, SQLiteAccess::Change, lock_timeout_);
  refuseOtherSchema(*connection_);
  SQLiteStatement row = connection_->prepare("SELECT value FROM facts WHERE key = 'unit'");
  const std::string stored = row.next() ? row.text(0) : "";
  if (!unit_.empty() && stored != unit_)
    throwBadArgument("unit = '" + unit_ + "', must be '" + stored + "' as in " + file_);
}

/// Makes an empty database under a temporary name and then renames it: a file of the final name is complete from the
/// start, and one that another program made in the meantime is kept.
void ModelStore::create(const Fill& fill) {
  std::error_code error;
  const fs::path folder = fs::absolute(file_).parent_path();
  if (!fs::is_directory(folder, error)) failIO(file_, "cannot be made: there is no folder " + folder.string());
  if (::faccessat(AT_FDCWD, folder.c_str(), W_OK | X_OK, AT_EACCESS) != 0)
    failIO(file_, "cannot be made: its folder may only be read");
  for (const char* ending : {"-wal", "-shm", "-journal"})
    if (fs::exists(file_ + ending, error))
      failIO(file_ + ending, "must not exist, as a new database needs a file of this name");
  std::string made = file_ + ".new-" + std::to_string(::getpid());
  while (fs::exists(made, error)) made += "_";
  try {
    makeTables(SQLiteConnection(made, SQLiteAccess::Create, lock_timeout_), fill);
    fs::create_hard_link(made, file_, error);
    if (error && !fs::exists(file_, error))
      fs::rename(made, file_);  // for file systems without links
    else if (error && fill)
      failIO(made, "another program has made this file, try again");
  } catch (const fs::filesystem_error& reason) {
    fs::remove(made, error);
    failIO(file_, reason.code().message());
  } catch (const std::exception& reason) {
    for (const char* ending : {"", "-wal", "-shm", "-journal"}) fs::remove(made + ending, error);
    const std::string text = reason.what();
    if (text.rfind(made + ": ", 0) != 0) throw;
    failIO(file_, text.substr(made.size() + 2));
  }
  fs::remove(made, error);
  open();
}

/// The write-ahead log is set up last: without it, each page of the contents is written only once.
void ModelStore::makeTables(const SQLiteConnection& connection, const Fill& fill) const {
  {
    SQLiteTransaction transaction(connection);
    createSchema(connection, unit_);
    if (fill) fill(connection);
    transaction.commit();
  }
  connection.run("PRAGMA journal_mode = WAL");
}

/// \return false if there is nothing to read.
bool ModelStore::startReading() {
  if (!connection_) return false;
  if (connection_->inTransaction()) return true;
  connection_->run("BEGIN");
  connection_->integer("SELECT count(*) FROM facts");  // from here on, the state that is read is fixed
  const std::int64_t data_version = connection_->integer("PRAGMA data_version");
  if (std::exchange(data_version_, data_version) != data_version) ++version_;
  return true;
}

void ModelStore::endReading() {
  if (connection_ && connection_->inTransaction()) connection_->run("ROLLBACK");
}

void ModelStore::refresh() {
  endReading();
  if (!connection_) open();
}

std::uint64_t ModelStore::version() {
  startReading();
  return version_;
}

std::string ModelStore::fact(const std::string& key) {
  if (!startReading()) return key == "unit" ? unit_ : "";
  SQLiteStatement row = connection_->prepare("SELECT value FROM facts WHERE key = ?");
  return row.bind(key).next() ? row.text(0) : "";
}

const std::vector<StoredModel>& ModelStore::models() {
  if (!startReading() || models_version_ == version_) return models_;
  std::vector<StoredModel> models;
  SQLiteStatement row = connection_->prepare(kSelectModels);
  while (row.next()) models.push_back({row.integer(0), checkedInfo(row, file_).name});
  std::sort(models.begin(), models.end(), [](const auto& a, const auto& b) { return a.name < b.name; });
  models_ = std::move(models);
  models_version_ = version_;
  return models_;
}

std::optional<std::pair<std::int64_t, ModelInfo>> ModelStore::find(const std::string& name) {
  if (!startReading()) return std::nullopt;
  SQLiteStatement row = connection_->prepare(std::string(kSelectModels) + " WHERE name = ?");
  if (!row.bind(name).next()) return std::nullopt;
  return std::make_pair(row.integer(0), checkedInfo(row, file_));
}

std::string ModelStore::part(ModelPart part, const StoredModel& model) {
  startReading();
  const std::string table = kPartTables[static_cast<std::size_t>(part)].name;
  const std::string what = "the " + table + " of model '" + model.name + "' ";
  SQLiteStatement row = connection_->prepare("SELECT data, checksum FROM " + table + " WHERE model = ?");
  if (!row.bind(model.id).next()) failIO(file_, what + "are missing");
  std::string data = row.blob(0);
  if (checksumOf(table, model.id, data) != row.integer(1)) failIO(file_, what + "are damaged");
  return data;
}

std::vector<StoredModel> ModelStore::modelsWithoutForms() {
  std::vector<StoredModel> models;
  if (!startReading()) return models;
  SQLiteStatement row = connection_->prepare(
      "SELECT id, name FROM models WHERE id NOT IN (SELECT model FROM compact WHERE projection = ?1) "
      "OR id NOT IN (SELECT model FROM view_codes WHERE projection = ?1) ORDER BY id");
  row.bind(projectionId());
  while (row.next()) models.push_back({row.integer(0), row.text(1)});
  return models;
}

std::int64_t ModelStore::projectionId() {
  return startReading() ? connection_->integer("SELECT max(id) FROM projections") : 0;
}

std::int64_t ModelStore::size() {
  return startReading() ? connection_->integer("SELECT count(*) FROM models") : 0;
}

std::optional<PackedProjection> ModelStore::projection() {
  if (!startReading()) return std::nullopt;
  SQLiteStatement row =
      connection_->prepare("SELECT id, num_references, data, checksum FROM projections ORDER BY id DESC LIMIT 1");
  if (!row.next()) return std::nullopt;
  PackedProjection projection{row.integer(0), static_cast<int>(row.integer(1)), row.blob(2), ""};
  SQLiteStatement coder = connection_->prepare("SELECT data, checksum FROM view_coders WHERE projection = ?");
  const bool found = coder.bind(projection.id).next();
  if (found) projection.view_coder = coder.blob(0);
  if (!found || checksumOf("view_coders", projection.id, projection.view_coder) != coder.integer(1) ||
      checksumOf("projections", projection.id, projection.values) != row.integer(3))
    failIO(file_, "the projection is damaged, pcl_symmetry_database rebuild makes a new one");
  return projection;
}

void ModelStore::each(FormPart part, std::int64_t projection, const EachBytes& take) {
  if (!startReading()) return;
  const std::string table = part == FormPart::Compact ? "compact" : "view_codes";
  SQLiteStatement row =
      connection_->prepare("SELECT model, data, checksum FROM " + table + " WHERE projection = ? ORDER BY model");
  row.bind(projection);
  while (row.next()) {
    const std::int64_t model = row.integer(0);
    const std::string data = row.blob(1);
    if (checksumOf(table, model, data) != row.integer(2))
      failIO(file_, nameOf(part) + std::to_string(model) + " is damaged, pcl_symmetry_database rebuild makes new ones");
    take(model, data);
  }
}

template <typename Body>
void ModelStore::change(const Body& body) {
  endReading();
  if (!connection_) open();
  if (!connection_) create();
  SQLiteTransaction transaction(*connection_);
  body();
  transaction.commit();
  ++version_;
}

std::int64_t ModelStore::add(const ModelInfo& info, const PackedModel& model, std::int64_t projection,
                             PackedForms forms) {
  change([&] {
    connection_->prepare("DELETE FROM models WHERE name = ?").bind(info.name).run();
    forms.model = insertModel(*connection_, info, model);
    if (projection != 0) insertForms(projection, {forms});
  });
  return forms.model;
}

/// \return the number of models.
/// \throws if the databases cannot be merged, before anything is written.
std::size_t ModelStore::checkBeforeMerge(const std::vector<std::string>& files) {
  std::error_code error;
  std::map<std::string, std::string> file_of_model;
  refresh();
  for (const StoredModel& model : models()) file_of_model[model.name] = file_;
  const std::size_t num_before = file_of_model.size();
  std::string unit = fact("unit");
  std::string file_of_unit = exists() || !unit.empty() ? file_ : "";
  for (const std::string& file : files) {
    if (!fs::exists(file, error)) failIO(file, "there is no such file");
    if (fs::equivalent(file, file_, error)) failIO(file, "is the database that others are merged into");
    ModelStore other(file, lock_timeout_, "");
    if (file_of_unit.empty()) {
      file_of_unit = file;
      unit = other.fact("unit");
    }
    if (other.fact("unit") != unit)
      failIO(file, "unit = '" + other.fact("unit") + "', must be '" + unit + "' as in " + file_of_unit);
    for (const StoredModel& model : other.models()) {
      const auto [known, is_new] = file_of_model.emplace(model.name, file);
      if (!is_new) failIO(file, "model '" + model.name + "' is also in " + known->second + ", names must differ");
    }
  }
  unit_ = unit;
  return file_of_model.size() - num_before;
}

std::optional<std::size_t> ModelStore::merge(const std::vector<std::string>& files, const BuildProgress& progress) {
  struct Stopped : std::exception {};
  const std::size_t num_models = checkBeforeMerge(files);
  if (num_models == 0) return 0;
  std::size_t num_done = 0;
  const auto copy = [&](const SQLiteConnection& connection) {
    for (const std::string& file : files) {
      ModelStore other(file, lock_timeout_, "");
      for (const StoredModel& model : other.models()) {
        const ModelInfo info = other.find(model.name).value().second;
        PackedModel parts;
        parts.num_points = info.num_points;
        for (const PartTable& table : kPartTables) parts.*table.data = other.part(table.part, model);
        insertModel(connection, info, parts);
        if (progress && !progress(static_cast<double>(++num_done) / static_cast<double>(num_models))) throw Stopped();
      }
    }
  };
  try {
    if (exists())
      change([&] { copy(*connection_); });
    else
      create(copy);
  } catch (const Stopped&) {
    return std::nullopt;
  }
  return num_models;
}

bool ModelStore::remove(const std::string& name) {
  bool found = false;
  refresh();
  if (!connection_) return false;
  change([&] {
    found = connection_->prepare("SELECT 1 FROM models WHERE name = ?").bind(name).next();
    connection_->prepare("DELETE FROM models WHERE name = ?").bind(name).run();
  });
  return found;
}

void ModelStore::setProjection(const PackedProjection& projection, const std::vector<PackedForms>& forms) {
  change([&] {
    connection_->run("DELETE FROM projections");
    const std::int64_t id = connection_->integer("SELECT seq FROM sqlite_sequence WHERE name = 'projections'") + 1;
    connection_->prepare("INSERT INTO projections VALUES (?, ?, ?, ?)")
        .bind(id, std::int64_t{projection.num_references}, SQLiteBlob{projection.values},
              checksumOf("projections", id, projection.values))
        .run();
    connection_->prepare("INSERT INTO view_coders VALUES (?, ?, ?)")
        .bind(id, SQLiteBlob{projection.view_coder}, checksumOf("view_coders", id, projection.view_coder))
        .run();
    insertForms(id, forms);
  });
}

void ModelStore::addForms(std::int64_t projection, const std::vector<PackedForms>& forms) {
  change([&] { insertForms(projection, forms); });
}

/// Forms of deleted models, or of a deleted projection, are skipped.
void ModelStore::insertForms(std::int64_t projection, const std::vector<PackedForms>& forms) {
  const auto insert = [&](const std::string& table, std::string PackedForms::*data) {
    SQLiteStatement statement =
        connection_->prepare("INSERT OR REPLACE INTO " + table +
                             " SELECT ?1, ?2, ?3, ?4 WHERE EXISTS (SELECT 1 FROM models WHERE id = ?1) " +
                             "AND EXISTS (SELECT 1 FROM projections WHERE id = ?2)");
    for (const PackedForms& packed : forms)
      statement.bind(packed.model, projection, SQLiteBlob{packed.*data}, checksumOf(table, packed.model, packed.*data))
          .run();
  };
  insert("compact", &PackedForms::forms);
  insert("view_codes", &PackedForms::view_codes);
}

std::vector<std::string> ModelStore::damages() {
  if (!startReading()) return {};
  return damagesOf(*connection_, [&] {
    std::vector<std::string> records;
    SQLiteStatement row = connection_->prepare(kSelectModels);
    while (row.next())
      if (checksumOf(row.integer(0), infoOf(row)) != row.integer(7))
        records.push_back("the record of model " + std::to_string(row.integer(0)) + " is damaged");
    return records;
  }());
}

}  // namespace pcl_symmetry::detail
