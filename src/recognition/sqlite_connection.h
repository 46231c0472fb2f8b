#pragma once

#include <cstdint>
#include <memory>
#include <string>

struct sqlite3;
struct sqlite3_stmt;

namespace pcl_symmetry::detail {

/// Throws pcl::IOException with the text "file: reason" and nothing else. (PCL prepends " : " to its text.)
[[noreturn]] void failIO(const std::string& file, const std::string& reason);

/// Bytes that are bound to a statement.
struct SQLiteBlob {
  const std::string& bytes;
};

/// A statement of SQLite with its values. Every function throws pcl::IOException, which names the file and the reason.
class SQLiteStatement {
public:
  /// Sets all parameters, in their order: integers, texts and blobs.
  template <typename... Values>
  SQLiteStatement& bind(const Values&... values) {
    int index = 0;
    (bindOne(++index, values), ...);
    return *this;
  }

  /// \return whether there is another row.
  bool next();
  /// Runs a statement that has no rows, so that it can be bound and run again.
  void run();

  /// \param column from 0.
  std::int64_t integer(int column) const;
  std::string text(int column) const;
  std::string blob(int column) const;

private:
  friend class SQLiteConnection;
  SQLiteStatement(sqlite3* database, sqlite3_stmt* statement, const std::string& file);
  void bindOne(int index, std::int64_t value);
  void bindOne(int index, const std::string& text);
  void bindOne(int index, const SQLiteBlob& blob);
  void check(int code);

  struct Finalizer {
    void operator()(sqlite3_stmt* statement) const;
  };

  sqlite3* database_;
  std::unique_ptr<sqlite3_stmt, Finalizer> statement_;
  std::string file_;
};

enum class SQLiteAccess {
  Change,  ///< the file exists; it is opened for reading where it cannot be changed
  Create,  ///< the file is made where it is missing
  Memory   ///< no file
};

/// A connection to one file. Foreign keys are enforced, and each change is on the disk when its transaction ends.
class SQLiteConnection {
public:
  /// \param seconds how long a change waits for another program that is writing.
  /// \throws pcl::IOException naming file and reason.
  SQLiteConnection(const std::string& file, SQLiteAccess access, double seconds);

  const std::string& file() const { return file_; }
  SQLiteStatement prepare(const std::string& sql) const;
  /// One or more statements without rows.
  void run(const std::string& sql) const;
  /// The first value of the first row.
  std::int64_t integer(const std::string& sql) const;
  /// True between BEGIN and COMMIT or ROLLBACK.
  bool inTransaction() const;

private:
  struct Closer {
    void operator()(sqlite3* database) const;
  };

  void open(const std::string& name, int flags);
  bool canRead() const;

  std::string file_;
  std::unique_ptr<sqlite3, Closer> database_;
};

/// Undoes all changes unless commit() was called.
class SQLiteTransaction {
public:
  /// Waits for other programs that are writing.
  explicit SQLiteTransaction(const SQLiteConnection& connection);
  ~SQLiteTransaction();
  SQLiteTransaction(const SQLiteTransaction&) = delete;
  SQLiteTransaction& operator=(const SQLiteTransaction&) = delete;

  void commit();

private:
  const SQLiteConnection& connection_;
};

}  // namespace pcl_symmetry::detail
