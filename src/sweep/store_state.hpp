// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <map>

#include "sweep/store_file.hpp"
#include "sweep/worker_identity.hpp"
#include "tofsmith/sweep/run_sweep.hpp"

namespace tofsmith {

/// Which other workers are alive, by watching their beats from here.
class WorkerWatch {
 public:
  WorkerWatch(WorkerIdentity own, double lease_s) : own_(std::move(own)), lease_s_(lease_s) {}

  const WorkerIdentity& own() const { return own_; }
  /// Whether `id` may still work. Ask again and again: silence is counted from the first time on.
  bool may_live(SqliteDatabase& database, const std::string& id);

 private:
  using Clock = std::chrono::steady_clock;
  struct Seen {
    std::int64_t beat;
    Clock::time_point since;
  };
  WorkerIdentity own_;
  double lease_s_;
  std::map<std::string, Seen> seen_;
};

struct SweepStore::State {
  std::filesystem::path path;
  ReadableStore file;
  StoreHead head;
  WorkerWatch watch;
  bool is_registered = false;

  SqliteDatabase& database() { return file.database; }
  void register_worker();
};

/// Proves that a result is the one that was stored.
std::string checksum_of(std::string_view key, std::string_view result);

/// The columns of find() from a row of `key, settings, status, result, checksum, message, seconds`.
/// @throws IoError if it is damaged
StoredItem stored_item(const SqliteStatement& row, const std::filesystem::path& path);

}  // namespace tofsmith
