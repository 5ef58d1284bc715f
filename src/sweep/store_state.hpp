// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sweep/store_file.hpp"
#include "tofsmith/sweep/run_sweep.hpp"

namespace tofsmith {

struct SweepStore::State {
  std::filesystem::path path;
  ReadableStore file;
  StoreHead head;

  SqliteDatabase& database() { return file.database; }
};

/// Detects a damaged result.
std::string checksum_of(std::string_view key, std::string_view result);

/// Reads a row of `key, settings, status, result, checksum, message, seconds`.
/// @throws IoError if it is damaged
StoredItem stored_item(const SqliteStatement& row, const std::filesystem::path& path);

}  // namespace tofsmith
