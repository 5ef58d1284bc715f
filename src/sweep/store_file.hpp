// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sqlite3.h>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "tofsmith/sweep/run_sweep.hpp"

namespace tofsmith {

/// Returns the name of a network file system, such as "NFS", from its number in statfs(); "" for
/// local file systems. Write-ahead logs fail on network file systems, because they require shared
/// memory.
std::string network_file_system(std::uint32_t magic);

/// `path` need not exist.
std::string network_file_system_at(const std::filesystem::path& path);

class SqliteStatement;

/// A connection to an SQLite database; not thread-safe. Members throw IoError with the file and the
/// messages of SQLite and the system.
class SqliteDatabase {
 public:
  enum class Access { read, write };

  /// Access::write creates a missing file. Waits for other processes.
  SqliteDatabase(const std::filesystem::path& path, Access access);

  /// Ignores rows.
  void execute(const std::string& statements);
  /// Returns SQLite's code instead of throwing.
  int try_execute(const std::string& statements);
  SqliteStatement prepare(std::string_view statement);
  /// First column of the first row; "" without rows.
  std::string text_of(std::string_view query);

  /// @throws IoError with SQLite's last error
  [[noreturn]] void fail(std::string_view what) const;

 private:
  struct Close {
    void operator()(sqlite3* connection) const { sqlite3_close_v2(connection); }
  };
  std::filesystem::path path_;
  std::unique_ptr<sqlite3, Close> connection_;
};

/// Parameters count from 1 and columns from 0, as in SQLite.
class SqliteStatement {
 public:
  SqliteStatement& bind(int parameter, std::string_view text);
  SqliteStatement& bind(int parameter, double number);
  /// Returns false after the last row; parameters can then be bound again.
  bool step();
  void run();
  void reset() { sqlite3_reset(statement_.get()); }

  std::string text(int column) const;
  std::int64_t integer(int column) const { return sqlite3_column_int64(statement_.get(), column); }
  double number(int column) const { return sqlite3_column_double(statement_.get(), column); }

 private:
  friend class SqliteDatabase;
  struct Finalize {
    void operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
  };
  SqliteStatement(SqliteDatabase& database, sqlite3_stmt* statement)
      : database_(&database), statement_(statement) {}

  SqliteDatabase* database_;
  std::unique_ptr<sqlite3_stmt, Finalize> statement_;
};

/// Rolls back unless commit() is called.
class SqliteTransaction {
 public:
  explicit SqliteTransaction(SqliteDatabase& database) : database_(&database) {
    database.execute("BEGIN IMMEDIATE");
  }
  ~SqliteTransaction() {
    if (database_ != nullptr) database_->try_execute("ROLLBACK");
  }
  SqliteTransaction(const SqliteTransaction&) = delete;
  SqliteTransaction& operator=(const SqliteTransaction&) = delete;
  void commit() {
    database_->execute("COMMIT");
    database_ = nullptr;
  }

 private:
  SqliteDatabase* database_;
};

/// Creates the file if it is missing or empty.
/// @param target  recorded in a new store
/// @param network  name of its network file system, or "" to use WAL mode
/// @throws IoError if it is not a store, or as SweepStore::open()
SqliteDatabase open_store_file(const std::filesystem::path& path, const std::string& target,
                               const std::string& network);

/// A store opened for reading: the file itself or, if a killed process has left logs and the
/// directory is read-only, a temporary copy.
struct ReadableStore {
  struct Directory {
    std::filesystem::path path;
    ~Directory();
  };
  std::unique_ptr<Directory> copy;  // must outlive the database
  SqliteDatabase database;
};
/// @throws IoError as SweepStore::read()
ReadableStore read_store_file(const std::filesystem::path& path);

/// Returns the instruction set of the results.
/// @throws IoError if the store is damaged or of another version
std::string read_target(SqliteDatabase& database, const std::filesystem::path& path);

}  // namespace tofsmith
