// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/sweep/run_sweep.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>

#include "core/shared/hash.hpp"
#include "sweep/store_file.hpp"
#include "tofsmith/core/build_info.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

struct SweepStore::State {
  std::filesystem::path path;
  ReadableStore file;
  std::string target;

  SqliteDatabase& database() { return file.database; }
};

namespace {

/// Per transaction, because other processes wait for its end.
constexpr std::size_t max_at_once = 4096;

constexpr std::array<std::string_view, 4> status_words = {"pending", "running", "finished",
                                                          "failed"};
constexpr std::string_view utc_now = "strftime('%Y-%m-%dT%H:%M:%SZ', 'now')";

/// Detects a damaged result.
std::string checksum_of(std::string_view key, std::string_view result) {
  return fmt::format("{:016x}", fnv1a_64(fmt::format("{}\n{}", key, result)));
}

/// Reads a row of `key, settings, status, result, checksum, message, seconds`.
/// @throws IoError if it is damaged
StoredItem stored_item(const SqliteStatement& row, const std::filesystem::path& path) {
  const std::string key = row.text(0);
  const auto damaged = [&](std::string_view how) {
    throw IoError(path.string(), fmt::format("is damaged (item {}: {}); restore a copy, or use "
                                             "another store",
                                             key, how));
  };
  StoredItem item{ItemStatus::pending, row.text(1), row.text(3), row.text(5), row.number(6)};
  const auto word = std::ranges::find(status_words, row.text(2));
  if (word == status_words.end()) damaged(fmt::format("status {}", row.text(2)));
  item.status = static_cast<ItemStatus>(word - status_words.begin());
  if (item.status == ItemStatus::finished && row.text(4) != checksum_of(key, item.result))
    damaged("its checksum does not match");
  return item;
}

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

SweepStore::SweepStore(Hidden<State> state) : state_(std::move(state)) {}

SweepStore SweepStore::open(const std::filesystem::path& path, const SweepStoreOptions& options) {
  const std::string here = dispatch_target();
  const std::string network = options.network_file_system.value_or(network_file_system_at(path));
  auto state = make_hidden<State>(State{path, {nullptr, open_store_file(path, here, network)}, {}});
  state->target = read_target(state->database(), path);
  if (state->target != here)
    throw IoError(
        path.string(),
        fmt::format(
            "was computed on {}, and this process uses {}: results would differ in their last "
            "digits; set TOFSMITH_TARGET={} if this machine supports it, or use another store",
            state->target, here, state->target));
  return SweepStore(std::move(state));
}

SweepStore SweepStore::read(const std::filesystem::path& path) {
  auto state = make_hidden<State>(State{path, read_store_file(path), {}});
  state->target = read_target(state->database(), path);
  return SweepStore(std::move(state));
}

const std::string& SweepStore::target() const { return state_->target; }

void SweepStore::add(std::span<const std::string> keys,
                     const std::function<std::string(std::size_t)>& settings) {
  SqliteDatabase& database = state_->database();
  SqliteStatement find = database.prepare("SELECT 1 FROM items WHERE key = ?");
  SqliteStatement insert = database.prepare(
      "INSERT OR IGNORE INTO items (key, settings, status) VALUES (?, ?, 'pending')");
  for (std::size_t begin = 0; begin < keys.size(); begin += max_at_once) {
    const std::size_t end = std::min(begin + max_at_once, keys.size());
    SqliteTransaction transaction(database);
    for (std::size_t i = begin; i < end; ++i) {
      const bool is_there = find.bind(1, keys[i]).step();
      find.reset();
      if (!is_there) insert.bind(1, keys[i]).bind(2, settings(i)).run();
    }
    transaction.commit();
  }
}

std::vector<ClaimAnswer> SweepStore::claim(std::span<const std::string> keys, std::size_t max_items,
                                           bool takes_running) {
  SqliteDatabase& database = state_->database();
  SqliteTransaction transaction(database);
  SqliteStatement find = database.prepare("SELECT status FROM items WHERE key = ?");
  SqliteStatement mark = database.prepare("UPDATE items SET status = 'running' WHERE key = ?");
  std::vector<ClaimAnswer> answers;
  std::size_t ours = 0;
  for (const std::string& key : keys.first(std::min(keys.size(), max_at_once))) {
    if (ours == max_items) break;
    if (!find.bind(1, key).step())
      throw IoError(state_->path.string(), fmt::format("no longer contains item {}", key));
    const std::string status = find.text(0);
    find.reset();
    if (status == "finished") {
      answers.push_back(ClaimAnswer::finished);
    } else if (status == "running" && !takes_running) {
      answers.push_back(ClaimAnswer::running);
    } else {
      mark.bind(1, key).run();
      answers.push_back(ClaimAnswer::ours);
      ++ours;
    }
  }
  transaction.commit();
  return answers;
}

void SweepStore::finish(std::span<const ItemOutcome> outcomes) {
  if (outcomes.empty()) return;
  SqliteDatabase& database = state_->database();
  SqliteTransaction transaction(database);
  SqliteStatement store = database.prepare(fmt::format(
      "UPDATE items SET status = ?, result = ?, checksum = ?, message = ?, seconds = ?, "
      "finished = {} WHERE key = ? AND status <> 'finished'",
      utc_now));
  for (const ItemOutcome& outcome : outcomes)
    store.bind(1, outcome.result.empty() ? "failed" : "finished")
        .bind(2, outcome.result)
        .bind(3, checksum_of(outcome.key, outcome.result))
        .bind(4, outcome.message)
        .bind(5, outcome.seconds)
        .bind(6, outcome.key)
        .run();
  transaction.commit();
}

void SweepStore::release(std::span<const std::string> keys) {
  if (keys.empty()) return;
  SqliteDatabase& database = state_->database();
  SqliteTransaction transaction(database);
  SqliteStatement unmark =
      database.prepare("UPDATE items SET status = 'pending' WHERE key = ? AND status = 'running'");
  for (const std::string& key : keys) unmark.bind(1, key).run();
  transaction.commit();
}

std::optional<StoredItem> SweepStore::find(std::string_view key) {
  SqliteStatement query = state_->database().prepare(
      "SELECT key, settings, status, result, checksum, message, seconds FROM items WHERE key = ?");
  if (!query.bind(1, key).step()) return std::nullopt;
  return stored_item(query, state_->path);
}

SweepCounts SweepStore::count(std::span<const std::string> keys) {
  SqliteStatement query =
      state_->database().prepare("SELECT status, seconds FROM items WHERE key = ?");
  SweepCounts counts;
  const std::set<std::string_view> distinct(keys.begin(), keys.end());
  for (const std::string_view key : distinct) {
    const std::string status = query.bind(1, key).step() ? query.text(0) : "pending";
    const bool finished = status == "finished";
    if (finished) counts.seconds += query.number(1);
    query.reset();
    ++(finished              ? counts.finished
       : status == "running" ? counts.running
       : status == "failed"  ? counts.failed
                             : counts.pending);
  }
  return counts;
}

}  // namespace tofsmith
