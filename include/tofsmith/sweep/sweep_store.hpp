// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tofsmith {

/// How a store is used.
struct SweepStoreOptions {
  /// A worker of another machine that gave no sign of life for so long is taken for dead, and its
  /// unfinished items are done again [s], > 0. No two clocks are compared: each process times by
  /// its own how long others stay silent.
  double lease_s = 60.0;
  /// What network file system the store is on ("NFS"), or "" for none; found out if absent.
  std::optional<std::string> network_file_system = {};

  /// @throws std::invalid_argument naming field, value and rule
  void validate() const;
};

/// How far items have come.
struct SweepCounts {
  std::int64_t pending = 0, running = 0, finished = 0, failed = 0;
  double seconds = 0.0;  ///< that the finished ones took [s]
};

enum class ItemStatus { pending, running, finished, failed };

/// What a store knows of an item.
struct StoredItem {
  ItemStatus status = ItemStatus::pending;
  std::string settings;  ///< as it was added: JSON
  std::string result;    ///< of a finished one: JSON
  std::string message;   ///< of a failed one
  double seconds = 0.0;
};

/// What became of an item, to be stored.
struct ItemOutcome {
  std::string key;
  std::string result;   ///< JSON; "" if it failed
  std::string message;  ///< why it failed
  double seconds = 0.0;
};

/// Whether an item that was asked for is ours to do.
enum class ClaimAnswer { ours, finished, taken };

/// Results of sweeps in one SQLite file, under the keys of their items. Many processes may work on
/// one store; a killed one, at any moment, loses nothing but its unfinished items. The file is in
/// WAL mode, or with a rollback journal where a network file system holds it.
/// @note one object must not be used by two threads at a time
class SweepStore {
 public:
  /// Opens a store to work on it; makes it if it is missing or empty.
  /// @throws IoError if the file is no store, damaged, of another version or instruction set, in
  ///         WAL mode on a network file system, or if it cannot be written
  static SweepStore open(const std::filesystem::path& path, const SweepStoreOptions& options = {});
  /// Opens a store to look at it; the file and its directory may be read-only.
  /// @throws IoError if the file is missing, no store, damaged or of another version
  static SweepStore read(const std::filesystem::path& path);
  /// Makes a store of what is in others: all items, finished where they are so in any. It depends
  /// on their content alone, not on their order.
  /// @param path  of a new or empty file
  /// @throws IoError as open() and read(), or if two of them differ in a result
  static void merge(const std::filesystem::path& path,
                    std::span<const std::filesystem::path> parts);
  ~SweepStore();
  SweepStore(SweepStore&&) noexcept;

  /// The instruction set that the results were computed on, see dispatch_target().
  const std::string& target() const;

  /// Adds items that are not there yet.
  /// @param settings  JSON of the i-th, for people
  void add(std::span<const std::string> keys,
           const std::function<std::string(std::size_t)>& settings);

  /// Makes unfinished items ours, unless another worker that lives has them. Looks at a few
  /// thousand of `keys` at most, and no further once `most` are ours; answers for those it looked
  /// at.
  std::vector<ClaimAnswer> claim(std::span<const std::string> keys, std::size_t most);
  /// Stores what became of items. One that is finished already stays as it is.
  void finish(std::span<const ItemOutcome> outcomes);
  /// Shows the others that we live; due a few times per lease.
  void beat();
  /// Gives back what is ours and unfinished.
  void release();

  /// @throws IoError if the entry is damaged
  std::optional<StoredItem> find(std::string_view key);
  /// Of the items with these keys, each counted once; those not in the store are pending.
  SweepCounts count(std::span<const std::string> keys);

 private:
  struct State;
  explicit SweepStore(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace tofsmith
