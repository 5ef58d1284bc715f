// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "sweep/sqlite.hpp"

namespace tofsmith {

/// What a store says of itself.
struct StoreHead {
  std::string target;  ///< instruction set of the results
};

/// Whether a database file says that it is in WAL mode.
bool is_in_wal_mode(const std::filesystem::path& path);

/// Opens a store's file to write to it; makes it if it is missing or empty.
/// @param target   recorded in a new store
/// @param network  name of the network file system it is on, or "": then WAL mode
/// @throws IoError if it is no store, or as SweepStore::open()
SqliteDatabase open_store_file(const std::filesystem::path& path, const std::string& target,
                               const std::string& network);

/// A store's file opened to read it: the file itself or, where logs of a killed process are beside
/// it and nothing may be written there, a copy that goes with this object.
struct ReadableStore {
  struct Directory {
    std::filesystem::path path;
    ~Directory();
  };
  std::unique_ptr<Directory> copy;  // outlives the database
  SqliteDatabase database;
};
/// @throws IoError as SweepStore::read()
ReadableStore read_store_file(const std::filesystem::path& path);

/// @throws IoError if the store is damaged or of another version
StoreHead read_store_head(SqliteDatabase& database, const std::filesystem::path& path);

}  // namespace tofsmith
