#include "recognition/database_schema.h"

#include <zlib.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <string_view>

namespace pcl_symmetry::detail {

namespace fs = std::filesystem;

namespace {

constexpr std::int64_t kApplicationId = 0x50537944;  // the letters PSyD

struct Table {
  const char* name;
  const char* definition;
};
// A table for each part of a model, so that a query reads what it needs.
constexpr Table kTables[] = {
    {"facts", "CREATE TABLE facts (key TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID"},
    {"models",
     "CREATE TABLE models (id INTEGER PRIMARY KEY AUTOINCREMENT, name TEXT NOT NULL UNIQUE, time INTEGER NOT NULL, "
     "source TEXT NOT NULL, source_checksum TEXT NOT NULL, tags TEXT NOT NULL, num_points INTEGER NOT NULL, "
     "checksum INTEGER NOT NULL)"},
    {"clouds",
     "CREATE TABLE clouds (model INTEGER PRIMARY KEY REFERENCES models ON DELETE CASCADE, data BLOB NOT NULL, "
     "checksum INTEGER NOT NULL)"},
    {"signatures",
     "CREATE TABLE signatures (model INTEGER PRIMARY KEY REFERENCES models ON DELETE CASCADE, data BLOB NOT NULL, "
     "checksum INTEGER NOT NULL)"},
    {"views",
     "CREATE TABLE views (model INTEGER PRIMARY KEY REFERENCES models ON DELETE CASCADE, data BLOB NOT NULL, "
     "checksum INTEGER NOT NULL)"},
    {"surfaces",
     "CREATE TABLE surfaces (model INTEGER PRIMARY KEY REFERENCES models ON DELETE CASCADE, data BLOB NOT NULL, "
     "checksum INTEGER NOT NULL)"},
    {"projections",
     "CREATE TABLE projections (id INTEGER PRIMARY KEY AUTOINCREMENT, num_references INTEGER NOT NULL, "
     "data BLOB NOT NULL, checksum INTEGER NOT NULL)"},
    {"compact",
     "CREATE TABLE compact (model INTEGER PRIMARY KEY REFERENCES models ON DELETE CASCADE, projection INTEGER NOT NULL "
     "REFERENCES projections ON DELETE CASCADE, data BLOB NOT NULL, checksum INTEGER NOT NULL)"},
    {"view_coders",
     "CREATE TABLE view_coders (projection INTEGER PRIMARY KEY REFERENCES projections ON DELETE CASCADE, "
     "data BLOB NOT NULL, checksum INTEGER NOT NULL)"},
    {"view_codes",
     "CREATE TABLE view_codes (model INTEGER PRIMARY KEY REFERENCES models ON DELETE CASCADE, projection INTEGER "
     "NOT NULL REFERENCES projections ON DELETE CASCADE, data BLOB NOT NULL, checksum INTEGER NOT NULL)"},
};

/// Tables whose definition is not the one that this library wrote.
void compareTables(const SQLiteConnection& connection, std::vector<std::string>& damages) {
  for (const Table& table : kTables) {
    SQLiteStatement row = connection.prepare("SELECT sql FROM sqlite_schema WHERE type = 'table' AND name = ?");
    row.bind(std::string(table.name));
    if (!row.next() || row.text(0) != table.definition)
      damages.push_back(std::string("the definition of table ") + table.name + " is damaged");
  }
}

/// Blobs that are missing, or whose bytes are not those of their checksum.
void compareBlobs(const SQLiteConnection& connection, const std::string& table, const std::string& key,
                  std::vector<std::string>& damages) {
  SQLiteStatement row = connection.prepare("SELECT " + key + ", data, checksum FROM " + table);
  while (row.next())
    if (checksumOf(table, row.integer(0), row.blob(1)) != row.integer(2))
      damages.push_back("the " + table + " of number " + std::to_string(row.integer(0)) + " are damaged");
  if (table != "clouds" && table != "signatures" && table != "views" && table != "surfaces") return;
  SQLiteStatement missing =
      connection.prepare("SELECT name FROM models WHERE id NOT IN (SELECT model FROM " + table + ")");
  while (missing.next()) damages.push_back("the " + table + " of model '" + missing.text(0) + "' are missing");
}

/// CRC-32 of texts, each with its end: any change of up to 32 neighboring bits changes it.
std::int64_t checksumOf(std::initializer_list<std::string_view> texts) {
  std::uint32_t value = 0;
  for (const std::string_view text : texts) {
    value = static_cast<std::uint32_t>(crc32_z(value, reinterpret_cast<const Bytef*>(text.data()), text.size()));
    value = static_cast<std::uint32_t>(crc32_z(value, reinterpret_cast<const Bytef*>(""), 1));
  }
  return value;
}

}  // namespace

void createSchema(const SQLiteConnection& connection, const std::string& unit) {
  for (const Table& table : kTables) connection.run(table.definition);
  SQLiteStatement fact = connection.prepare("INSERT INTO facts VALUES (?, ?)");
  fact.bind(std::string("library_version"), std::string(PCL_SYMMETRY_VERSION)).run();
  fact.bind(std::string("unit"), unit).run();
  connection.run("PRAGMA application_id = " + std::to_string(kApplicationId));
  connection.run("PRAGMA user_version = " + std::to_string(kSchemaVersion));
}

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

std::string joinedTags(const std::vector<std::string>& tags) {
  std::string text;
  for (const std::string& tag : tags) text += (text.empty() ? "" : "\n") + tag;
  return text;
}

std::int64_t checksumOf(std::int64_t id, const ModelInfo& info) {
  return checksumOf({std::to_string(id), info.name, std::to_string(info.time), info.source.path, info.source.checksum,
                     joinedTags(info.source.tags), std::to_string(info.num_points)});
}

std::int64_t checksumOf(const std::string& table, std::int64_t id, const std::string& data) {
  return checksumOf({table, std::to_string(id), data});
}

std::vector<std::string> damagesOf(const SQLiteConnection& connection, std::vector<std::string> damages) {
  compareTables(connection, damages);
  for (const char* pragma : {"PRAGMA integrity_check", "PRAGMA foreign_key_check"}) {
    SQLiteStatement row = connection.prepare(pragma);
    while (row.next())
      if (row.text(0) != "ok") damages.push_back("structure of the file: " + row.text(0));
  }
  for (const char* table : {"clouds", "signatures", "views", "surfaces", "compact", "view_codes"})
    compareBlobs(connection, table, "model", damages);
  compareBlobs(connection, "projections", "id", damages);
  compareBlobs(connection, "view_coders", "projection", damages);
  return damages;
}

}  // namespace pcl_symmetry::detail
