// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "sweep/store_file.hpp"

#include <fmt/format.h>
#include <sys/statfs.h>

#include <array>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <system_error>
#include <thread>
#include <utility>

#include "tofsmith/core/error.hpp"
#include "tofsmith/sweep/run_sweep.hpp"
#include "tofsmith/version.hpp"

namespace tofsmith {

namespace {

/// From linux/magic.h and the sources of the file systems.
constexpr std::array<std::pair<std::uint32_t, const char*>, 18> network_file_systems = {{
    {0x6969, "NFS"},
    {0x517b, "SMB"},
    {0xff534d42, "CIFS"},
    {0xfe534d42, "SMB2"},
    {0x0bd00bd0, "Lustre"},
    {0x65735546, "FUSE"},
    {0x47504653, "GPFS"},
    {0x00c36400, "Ceph"},
    {0x5346414f, "AFS"},
    {0x6b414653, "kAFS"},
    {0x01021997, "9P"},
    {0x7461636f, "OCFS2"},
    {0x01161970, "GFS2"},
    {0x19830326, "BeeGFS"},
    {0xaad7aaea, "PanFS"},
    {0x73757245, "Coda"},
    {0x564c, "NCP"},
    {0x20030528, "OrangeFS"},
}};

}  // namespace

std::string network_file_system(std::uint32_t magic) {
  for (const auto& [number, name] : network_file_systems)
    if (number == magic) return name;
  return "";
}

std::string network_file_system_at(const std::filesystem::path& path) {
  struct statfs found {};
  const std::filesystem::path absolute = std::filesystem::absolute(path);
  if (::statfs(absolute.c_str(), &found) != 0 &&
      ::statfs(absolute.parent_path().c_str(), &found) != 0)
    return "";
  return network_file_system(static_cast<std::uint32_t>(found.f_type));
}

namespace {

constexpr int patience_ms = 60'000;

std::string_view advice(int code) {
  switch (code) {
    case SQLITE_FULL:
      return "; free disk space and run again (finished items are kept)";
    case SQLITE_IOERR:
      return "; run again (finished items are kept)";
    case SQLITE_READONLY:
      return "; it can be read with --status";
    case SQLITE_BUSY:
      return "; another process has locked it";
    case SQLITE_CORRUPT:
      return "; the file is damaged: restore a copy, or use another store";
    case SQLITE_NOTADB:
      return "; expected a store of tofsmith sweep";
    default:
      return "";
  }
}

}  // namespace

SqliteDatabase::SqliteDatabase(const std::filesystem::path& path, Access access) : path_(path) {
  if (const std::string name = path.string(); name.empty() || name.starts_with(':'))
    throw IoError(name.empty() ? "store" : name,
                  "expected the name of a file, because a database in memory would be lost");
  sqlite3* connection = nullptr;
  const int flags =
      access == Access::read ? SQLITE_OPEN_READONLY : SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE;
  const int code = sqlite3_open_v2(path.c_str(), &connection, flags, nullptr);
  connection_.reset(connection);
  if (code != SQLITE_OK) fail("cannot open");
  sqlite3_busy_timeout(connection, patience_ms);
}

void SqliteDatabase::fail(std::string_view what) const {
  sqlite3* const connection = connection_.get();
  const int code = sqlite3_errcode(connection) & 0xff;
  const int system = connection == nullptr ? 0 : sqlite3_system_errno(connection);
  const bool tell = system != 0 && (code == SQLITE_IOERR || code == SQLITE_CANTOPEN);
  throw IoError(
      path_.string(),
      fmt::format("{}: {}{}{}", what, sqlite3_errmsg(connection),
                  tell ? fmt::format(" ({})", std::generic_category().message(system)) : "",
                  advice(code)));
}

int SqliteDatabase::try_execute(const std::string& statements) {
  return sqlite3_exec(connection_.get(), statements.c_str(), nullptr, nullptr, nullptr);
}

void SqliteDatabase::execute(const std::string& statements) {
  if (try_execute(statements) != SQLITE_OK) fail("cannot write");
}

SqliteStatement SqliteDatabase::prepare(std::string_view statement) {
  sqlite3_stmt* prepared = nullptr;
  if (sqlite3_prepare_v2(connection_.get(), statement.data(), static_cast<int>(statement.size()),
                         &prepared, nullptr) != SQLITE_OK)
    fail("cannot read");
  return {*this, prepared};
}

std::string SqliteDatabase::text_of(std::string_view query) {
  SqliteStatement statement = prepare(query);
  return statement.step() ? statement.text(0) : "";
}

SqliteStatement& SqliteStatement::bind(int parameter, std::string_view text) {
  if (sqlite3_bind_text64(statement_.get(), parameter, text.data(), text.size(), SQLITE_TRANSIENT,
                          SQLITE_UTF8) != SQLITE_OK)
    database_->fail("cannot bind");
  return *this;
}

SqliteStatement& SqliteStatement::bind(int parameter, double number) {
  if (sqlite3_bind_double(statement_.get(), parameter, number) != SQLITE_OK)
    database_->fail("cannot bind");
  return *this;
}

bool SqliteStatement::step() {
  const int code = sqlite3_step(statement_.get());
  if (code == SQLITE_ROW) return true;
  if (code != SQLITE_DONE) database_->fail("cannot read or write");
  sqlite3_reset(statement_.get());
  return false;
}

void SqliteStatement::run() {
  while (step()) {
  }
}

std::string SqliteStatement::text(int column) const {
  const unsigned char* text = sqlite3_column_text(statement_.get(), column);
  if (text == nullptr) return "";
  return {reinterpret_cast<const char*>(text),
          static_cast<std::size_t>(sqlite3_column_bytes(statement_.get(), column))};
}

namespace {

constexpr int application_id = 0x746f6673;  // "tofs"
/// Version 1 had more columns and a table of processes; it can be continued.
constexpr int schema_version = 2, oldest_schema_version = 1;
constexpr std::size_t header_bytes = 100;
constexpr std::string_view sqlite_magic("SQLite format 3\0", 16);

std::string header_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::string header(header_bytes, '\0');
  file.read(header.data(), static_cast<std::streamsize>(header.size()));
  header.resize(static_cast<std::size_t>(file.gcount()));
  return header;
}

/// Rejects files that are not databases before SQLite touches them.
void require_database(const std::filesystem::path& path) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) return;
  if (!std::filesystem::is_regular_file(status))
    throw IoError(path.string(), "is not a regular file; expected a store of tofsmith sweep");
  const std::string header = header_of(path);
  if (!header.empty() && !header.starts_with(sqlite_magic))
    throw IoError(path.string(), "is not an SQLite file; expected a store of tofsmith sweep");
}

void require_ours(SqliteDatabase& database, const std::filesystem::path& path) {
  if (database.text_of("PRAGMA application_id") != fmt::format("{}", application_id))
    throw IoError(path.string(),
                  "is an SQLite file of another program; expected a store of tofsmith sweep");
}

std::string schema(const std::string& target) {
  return fmt::format(
      "PRAGMA application_id = {};"
      "PRAGMA user_version = {};"
      "CREATE TABLE meta (name TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID;"
      "INSERT INTO meta VALUES ('tofsmith', '{}'), ('results', '{}'), ('target', '{}');"
      "CREATE TABLE items (key TEXT PRIMARY KEY, settings TEXT NOT NULL, status TEXT NOT NULL,"
      " result TEXT, checksum TEXT, message TEXT, finished TEXT, seconds REAL);",
      application_id, schema_version, TOFSMITH_VERSION, sweep_result_version, target);
}

void create_if_empty(SqliteDatabase& database, const std::string& target) {
  const auto is_empty = [&] {
    return database.text_of("SELECT count(*) FROM sqlite_master") == "0" &&
           database.text_of("PRAGMA application_id") == "0";
  };
  if (!is_empty()) return;
  SqliteTransaction transaction(database);
  if (is_empty()) database.execute(schema(target));
  transaction.commit();
}

/// SQLite does not wait for other connections to change the mode.
void set_journal(SqliteDatabase& database, const std::string& mode) {
  for (int attempt = 0; database.try_execute("PRAGMA journal_mode = " + mode) == SQLITE_BUSY;
       ++attempt) {
    if (attempt >= 1000) database.fail("cannot set the journal mode");
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
}

using FileTime = std::filesystem::file_time_type;

FileTime time_of(const std::filesystem::path& path) {
  std::error_code ignored;
  return std::filesystem::last_write_time(path, ignored);
}

std::filesystem::path log_of(const std::filesystem::path& path) { return path.string() + "-wal"; }

/// Copies a consistent state of database and log.
void copy_store(const std::filesystem::path& from, const std::filesystem::path& to) {
  const auto replace = std::filesystem::copy_options::overwrite_existing;
  for (int attempt = 0; attempt < 10; ++attempt) {
    const FileTime before = time_of(from), log_before = time_of(log_of(from));
    std::error_code no_log;
    std::filesystem::copy_file(log_of(from), log_of(to), replace, no_log);
    std::filesystem::copy_file(from, to, replace);
    if (time_of(from) == before && time_of(log_of(from)) == log_before) return;
  }
  throw IoError(from.string(), "is being written to and cannot be copied; try again");
}

std::filesystem::path make_directory() {
  std::string pattern = (std::filesystem::temp_directory_path() / "tofsmith-sweep-XXXXXX").string();
  if (::mkdtemp(pattern.data()) == nullptr)
    throw IoError(pattern, "cannot create a directory for a copy of the store");
  return pattern;
}

/// In WAL mode even readers must create a file.
bool asks_for_a_writable_place(SqliteDatabase& database) {
  const int code = database.try_execute("SELECT count(*) FROM sqlite_master");
  return code == SQLITE_CANTOPEN || code == SQLITE_READONLY;
}

bool is_in_wal_mode(const std::filesystem::path& path) {
  const std::string header = header_of(path);
  return header.size() == header_bytes && header[18] == 2;
}

}  // namespace

ReadableStore::Directory::~Directory() {
  std::error_code ignored;
  std::filesystem::remove_all(path, ignored);
}

SqliteDatabase open_store_file(const std::filesystem::path& path, const std::string& target,
                               const std::string& network) {
  require_database(path);
  if (!network.empty() && is_in_wal_mode(path))
    throw IoError(
        path.string(),
        fmt::format(
            "is in WAL mode, which does not work on a network file system ({}); copy it to a local "
            "disk, or merge it there into a new store that works here: tofsmith sweep merge "
            "NEW.sqlite {}; or use one store and one shard per machine: --shard i/n",
            network, path.filename().string()));
  SqliteDatabase database(path, SqliteDatabase::Access::write);
  create_if_empty(database, target);
  require_ours(database, path);
  set_journal(database, network.empty() ? "WAL" : "DELETE");
  // In WAL mode the file stays consistent even if a commit is lost.
  database.execute(network.empty() ? "PRAGMA synchronous = NORMAL" : "PRAGMA synchronous = FULL");
  return database;
}

ReadableStore read_store_file(const std::filesystem::path& path) {
  if (!std::filesystem::exists(path)) throw IoError(path.string(), "there is no such store");
  require_database(path);
  ReadableStore store{nullptr, SqliteDatabase(path, SqliteDatabase::Access::read)};
  if (asks_for_a_writable_place(store.database)) {
    auto copy = std::make_unique<ReadableStore::Directory>();
    copy->path = make_directory();
    const std::filesystem::path copied = copy->path / "store.sqlite";
    try {
      copy_store(path, copied);
    } catch (const std::filesystem::filesystem_error& error) {
      throw IoError(path.string(), fmt::format("cannot be read: {}", error.code().message()));
    }
    store = {std::move(copy), SqliteDatabase(copied, SqliteDatabase::Access::write)};
  }
  require_ours(store.database, path);
  return store;
}

std::string read_target(SqliteDatabase& database, const std::filesystem::path& path) {
  const std::string schema = database.text_of("PRAGMA user_version");
  const std::string version = database.text_of("SELECT value FROM meta WHERE name = 'tofsmith'");
  const std::string results = database.text_of("SELECT value FROM meta WHERE name = 'results'");
  if ((schema != fmt::format("{}", schema_version) &&
       schema != fmt::format("{}", oldest_schema_version)) ||
      results != fmt::format("{}", sweep_result_version))
    throw IoError(path.string(),
                  fmt::format("was written by tofsmith {} (store version {}, results {}); this is "
                              "tofsmith {} (store version {}, results {}); use another store",
                              version, schema, results, TOFSMITH_VERSION, schema_version,
                              sweep_result_version));
  if (const std::string damage = database.text_of("PRAGMA quick_check(1)"); damage != "ok")
    throw IoError(path.string(),
                  fmt::format("is damaged ({}); restore a copy, or use another store", damage));
  return database.text_of("SELECT value FROM meta WHERE name = 'target'");
}

}  // namespace tofsmith
