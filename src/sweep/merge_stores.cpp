// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "sweep/store_state.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

namespace {

/// Running items become pending.
std::string_view settled(ItemStatus status) {
  if (status == ItemStatus::finished) return "finished";
  return status == ItemStatus::failed ? "failed" : "pending";
}

class Merger {
 public:
  explicit Merger(SqliteDatabase& into)
      : find_(into.prepare("SELECT status, result, seconds FROM items WHERE key = ?")),
        replace_(into.prepare("INSERT OR REPLACE INTO items (key, settings, status, result, "
                              "checksum, message, finished, seconds) "
                              "VALUES (?, ?, ?, ?, ?, ?, ?, ?)")) {}

  void take_all(SqliteDatabase& part, const std::filesystem::path& path) {
    SqliteStatement rows = part.prepare(
        "SELECT key, settings, status, result, checksum, message, seconds, finished FROM items "
        "ORDER BY key");
    while (rows.step()) take(rows, stored_item(rows, path), path);
  }

 private:
  void take(const SqliteStatement& row, const StoredItem& item, const std::filesystem::path& path) {
    const std::string key = row.text(0);
    bool is_better = true;
    if (find_.bind(1, key).step()) {
      const bool was_finished = find_.text(0) == "finished",
                 is = item.status == ItemStatus::finished;
      if (was_finished && is && find_.text(1) != item.result)
        throw IoError(path.string(),
                      fmt::format("item {} ({}) has a different result in a previous store", key,
                                  item.settings));
      // Keep the faster one of two finished items, so that the order of the parts does not matter.
      is_better = is && (!was_finished || item.seconds < find_.number(2));
      find_.reset();
    }
    if (!is_better) return;
    replace_.bind(1, key)
        .bind(2, item.settings)
        .bind(3, settled(item.status))
        .bind(4, item.result)
        .bind(5, row.text(4))
        .bind(6, item.message)
        .bind(7, row.text(7))
        .bind(8, item.seconds)
        .run();
  }

  SqliteStatement find_, replace_;
};

}  // namespace

void SweepStore::merge(const std::filesystem::path& path,
                       std::span<const std::filesystem::path> parts) {
  require(!parts.empty(), "parts", parts.size(), "must be at least one");
  std::string target;
  for (const std::filesystem::path& part : parts) {
    const SweepStore store = read(part);
    if (target.empty()) target = store.target();
    if (store.target() != target)
      throw IoError(part.string(), fmt::format("was computed on {}, but the previous stores on {}",
                                               store.target(), target));
  }
  // A rollback journal leaves a single file, possibly on a network file system.
  SqliteDatabase into = open_store_file(path, target, "any");
  SqliteTransaction transaction(into);
  Merger merger(into);
  for (const std::filesystem::path& part : parts) {
    ReadableStore store = read_store_file(part);
    merger.take_all(store.database, part);
  }
  transaction.commit();
}

}  // namespace tofsmith
