#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "pcl_symmetry/symmetry_database.h"
#include "recognition/sqlite_connection.h"

namespace pcl_symmetry::detail {

/// Tables of a database, and what may be opened. Every function throws pcl::IOException, which names file and reason.

/// Grows by 1 when tables or the bytes in them change.
constexpr int kSchemaVersion = 7;
/// The name of a database that has no file.
constexpr const char* kNoFile = ":memory:";
constexpr const char* kSelectModels =
    "SELECT id, name, time, source, source_checksum, tags, num_points, checksum FROM models";

void createSchema(const SQLiteConnection& connection, const std::string& unit);

/// Looks at the file without SQLite, which would take any file for its own.
void refuseForeignFile(const std::string& file);
/// Refuses databases of newer and of older libraries.
void refuseOtherSchema(const SQLiteConnection& connection);

/// Tags as they are stored: a line each.
std::string joinedTags(const std::vector<std::string>& tags);

/// Checksums hold the table and the number of the model, so that parts of different models cannot be mixed up.
std::int64_t checksumOf(std::int64_t id, const ModelInfo& info);
std::int64_t checksumOf(const std::string& table, std::int64_t id, const std::string& data);

/// \param records what is wrong with the rows of models.
/// \return a sentence for each damage.
std::vector<std::string> damagesOf(const SQLiteConnection& connection, std::vector<std::string> records);

}  // namespace pcl_symmetry::detail
