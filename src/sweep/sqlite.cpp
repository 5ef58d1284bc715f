// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "sweep/sqlite.hpp"

#include <fmt/format.h>

#include <system_error>

#include "tofsmith/core/error.hpp"

namespace tofsmith {

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

SqliteStatement& SqliteStatement::bind(int parameter, std::int64_t number) {
  if (sqlite3_bind_int64(statement_.get(), parameter, number) != SQLITE_OK)
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

}  // namespace tofsmith
