// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "sweep/sqlite.hpp"

namespace tofsmith {

struct StoreHead {
  std::string target;  ///< instruction set of the results
};

bool is_in_wal_mode(const std::filesystem::path& path);

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

/// @throws IoError if the store is damaged or of another version
StoreHead read_store_head(SqliteDatabase& database, const std::filesystem::path& path);

}  // namespace tofsmith
