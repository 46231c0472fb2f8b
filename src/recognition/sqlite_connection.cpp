#include "recognition/sqlite_connection.h"

#include <pcl/exceptions.h>
#include <sqlite3.h>

#include <cctype>
#include <cmath>
#include <filesystem>
#include <system_error>

#include "plain_exception.h"

namespace pcl_symmetry::detail {

namespace {

/// The meaning of an error of SQLite for the user of a file.
std::string reasonOf(sqlite3* database) {
  const int code = sqlite3_extended_errcode(database), system_error = sqlite3_system_errno(database);
  const std::string system =
      system_error != 0 ? " (" + std::error_code(system_error, std::generic_category()).message() + ")" : "";
  switch (code & 0xff) {
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      return "another program is changing it, try again when that is done";
    case SQLITE_FULL:
      return "cannot be written: the disk is full; the database is unchanged";
    case SQLITE_READONLY:
    case SQLITE_PERM:
      return "cannot be written: the file or its folder may only be read";
    case SQLITE_CANTOPEN:
      return "cannot be opened" + system;
    case SQLITE_IOERR:
      return "cannot be read or written" + system + "; the database is unchanged";
    case SQLITE_CORRUPT:
    case SQLITE_NOTADB:
      return "is damaged (" + std::string(sqlite3_errmsg(database)) + ")";
    case SQLITE_NOMEM:
      return "is too large for the memory of this machine";
    default:
      return sqlite3_errmsg(database);
  }
}

/// A name for sqlite3_open_v2() that declares the file unchanging, so that no file is made beside it.
std::string immutableName(const std::string& file) {
  std::string name = "file:";
  for (const unsigned char c : std::filesystem::absolute(file).string()) {
    static const char* const digits = "0123456789ABCDEF";
    if (std::isalnum(c) || c == '/' || c == '_' || c == '-' || c == '.')
      name += static_cast<char>(c);
    else
      name += std::string("%") + digits[c >> 4] + digits[c & 15];
  }
  return name + "?immutable=1";
}

}  // namespace

void failIO(const std::string& file, const std::string& reason) {
  throw Plain<pcl::IOException>(file + ": " + reason);
}

void SQLiteStatement::Finalizer::operator()(sqlite3_stmt* statement) const {
  sqlite3_finalize(statement);
}

SQLiteStatement::SQLiteStatement(sqlite3* database, sqlite3_stmt* statement, const std::string& file)
    : database_(database), statement_(statement), file_(file) {}

void SQLiteStatement::check(int code) {
  if (code != SQLITE_OK) failIO(file_, reasonOf(database_));
}

void SQLiteStatement::bindOne(int index, std::int64_t value) {
  check(sqlite3_bind_int64(statement_.get(), index, value));
}

void SQLiteStatement::bindOne(int index, const std::string& text) {
  check(sqlite3_bind_text64(statement_.get(), index, text.data(), text.size(), SQLITE_TRANSIENT, SQLITE_UTF8));
}

void SQLiteStatement::bindOne(int index, const SQLiteBlob& blob) {
  check(sqlite3_bind_blob64(statement_.get(), index, blob.bytes.data(), blob.bytes.size(), SQLITE_TRANSIENT));
}

bool SQLiteStatement::next() {
  const int code = sqlite3_step(statement_.get());
  if (code == SQLITE_ROW) return true;
  if (code != SQLITE_DONE) {
    const std::string reason = reasonOf(database_);
    sqlite3_reset(statement_.get());
    failIO(file_, reason);
  }
  sqlite3_reset(statement_.get());
  return false;
}

void SQLiteStatement::run() {
  next();
  sqlite3_reset(statement_.get());
}

std::int64_t SQLiteStatement::integer(int column) const {
  return sqlite3_column_int64(statement_.get(), column);
}

std::string SQLiteStatement::text(int column) const {
  const auto* text = reinterpret_cast<const char*>(sqlite3_column_text(statement_.get(), column));
  return text ? std::string(text, static_cast<std::size_t>(sqlite3_column_bytes(statement_.get(), column)))
              : std::string();
}

std::string SQLiteStatement::blob(int column) const {
  const auto* bytes = static_cast<const char*>(sqlite3_column_blob(statement_.get(), column));
  return bytes ? std::string(bytes, static_cast<std::size_t>(sqlite3_column_bytes(statement_.get(), column)))
               : std::string();
}

void SQLiteConnection::Closer::operator()(sqlite3* database) const {
  sqlite3_close_v2(database);
}

SQLiteConnection::SQLiteConnection(const std::string& file, SQLiteAccess access, double seconds) : file_(file) {
  if (access == SQLiteAccess::Memory)
    open(":memory:", SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE | SQLITE_OPEN_MEMORY);
  else
    open(file, SQLITE_OPEN_READWRITE | (access == SQLiteAccess::Create ? SQLITE_OPEN_CREATE : 0));
  sqlite3_busy_timeout(database_.get(), static_cast<int>(std::lround(1000.0 * seconds)));
  if (access == SQLiteAccess::Change && !canRead()) {
    // SQLite needs two files beside a database that can be changed. If they cannot be made, nobody else can write
    // either.
    std::error_code error;
    const std::uintmax_t waiting = std::filesystem::file_size(file + "-wal", error);
    if (!error && waiting > 0)
      failIO(file, "its folder may only be read, but must be writable once: changes in " + file +
                       "-wal have not been moved into the database yet");
    open(immutableName(file), SQLITE_OPEN_READONLY | SQLITE_OPEN_URI);
  }
  run("PRAGMA foreign_keys = ON; PRAGMA trusted_schema = OFF; PRAGMA cell_size_check = ON; PRAGMA synchronous = FULL");
}

void SQLiteConnection::open(const std::string& name, int flags) {
  sqlite3* database = nullptr;
  const int code = sqlite3_open_v2(name.c_str(), &database, flags | SQLITE_OPEN_NOMUTEX, nullptr);
  database_.reset(database);
  if (code != SQLITE_OK) failIO(file_, database ? reasonOf(database) : "cannot be opened");
  sqlite3_extended_result_codes(database, 1);
}

/// False if a file of SQLite cannot be read because its folder is not writable.
bool SQLiteConnection::canRead() const {
  const int code =
      sqlite3_exec(database_.get(), "SELECT count(*) FROM sqlite_schema", nullptr, nullptr, nullptr) & 0xff;
  return code != SQLITE_CANTOPEN && code != SQLITE_READONLY;
}

SQLiteStatement SQLiteConnection::prepare(const std::string& sql) const {
  sqlite3_stmt* statement = nullptr;
  if (sqlite3_prepare_v2(database_.get(), sql.c_str(), static_cast<int>(sql.size()), &statement, nullptr) != SQLITE_OK)
    failIO(file_, reasonOf(database_.get()));
  return {database_.get(), statement, file_};
}

void SQLiteConnection::run(const std::string& sql) const {
  if (sqlite3_exec(database_.get(), sql.c_str(), nullptr, nullptr, nullptr) != SQLITE_OK)
    failIO(file_, reasonOf(database_.get()));
}

std::int64_t SQLiteConnection::integer(const std::string& sql) const {
  SQLiteStatement statement = prepare(sql);
  return statement.next() ? statement.integer(0) : 0;
}

bool SQLiteConnection::inTransaction() const {
  return sqlite3_get_autocommit(database_.get()) == 0;
}

SQLiteTransaction::SQLiteTransaction(const SQLiteConnection& connection) : connection_(connection) {
  connection_.run("BEGIN IMMEDIATE");
}

SQLiteTransaction::~SQLiteTransaction() {
  try {
    if (connection_.inTransaction()) connection_.run("ROLLBACK");
  } catch (const std::exception&) {
    // SQLite rolls back an unfinished transaction when the file is opened next.
  }
}

void SQLiteTransaction::commit() {
  connection_.run("COMMIT");
}

}  // namespace pcl_symmetry::detail
