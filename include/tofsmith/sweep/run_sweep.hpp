// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tofsmith/core/fields.hpp"
#include "tofsmith/core/hidden.hpp"
#include "tofsmith/core/progress.hpp"
#include "tofsmith/design/design.hpp"
#include "tofsmith/io/camera_toml.hpp"
#include "tofsmith/io/npy.hpp"
#include "tofsmith/simulate/depth_error.hpp"

namespace tofsmith {

/// A parameter that varies.
struct SweepAxis {
  /// A key of the camera such as "light.peak_factor", a field of EvaluateOptions or OperatingPoint,
  /// or camera, code or exposures.
  std::string key;
  std::vector<SettingValue> values;
  std::string place;       ///< for errors
  bool crossed = false;    ///< combined with every other axis, even if those are zipped
  bool linked = false;     ///< advances together with the previous axis
  std::string group = {};  ///< combined first; "" for none
};

/// Combination of the values of axes or groups.
enum class SweepCombination {
  product,  ///< all combinations; the last axis varies fastest
  zip,      ///< by index; equal lengths required
};
constexpr auto words_of(SweepCombination /*any*/) { return word_list("product", "zip"); }

/// Definition of a sweep, a list of depth errors to compute; see docs/sweeps.md.
struct SweepSpec {
  std::string source_name;          ///< for errors
  std::filesystem::path directory;  ///< base of relative names
  std::string camera = std::string(default_camera_name);
  std::vector<std::string> settings;
  std::string code;  ///< unless an axis has the key "code"
  EvaluateOptions options;
  double effort = 1.0;
  SweepCombination combine = SweepCombination::product;
  std::vector<SweepAxis> axes;  ///< keys of one [[axis]] are adjacent, all but the first linked
  std::map<std::string, SweepCombination> groups = {};  ///< zip if absent

  /// Number of items, at most 2^62.
  std::int64_t items() const;
  /// Indices of the values of all axes for an item.
  std::vector<std::size_t> value_indices(std::int64_t item) const;
};

/// @throws IoError "file:line:column: ..." for invalid TOML, keys, axes or values
SweepSpec parse_sweep_toml(std::string_view text, std::string_view source_name = "sweep.toml");
SweepSpec read_sweep_toml(const std::filesystem::path& path);

struct SweepStoreOptions {
  /// Network file system of the store ("NFS"), "" for none; detected if absent.
  std::optional<std::string> network_file_system = {};
};

/// Number of items by status.
struct SweepCounts {
  std::int64_t pending = 0, running = 0, finished = 0, failed = 0;
  double seconds = 0.0;  ///< computing time of the finished items
};

enum class ItemStatus { pending, running, finished, failed };

/// Record of an item in a store.
struct StoredItem {
  ItemStatus status = ItemStatus::pending;
  std::string settings;  ///< JSON
  std::string result;
  std::string message;
  double seconds = 0.0;
};

/// Outcome of an item to store.
struct ItemOutcome {
  std::string key;
  std::string result;  ///< JSON; "" if failed
  std::string message;
  double seconds = 0.0;
};

/// Answer of SweepStore::claim() for an item.
enum class ClaimAnswer {
  ours,  ///< the caller must compute it
  finished,
  running,  ///< in another process, or in one that was terminated
};

/// Results of sweeps in one SQLite file by item key. Processes may share a store; a killed process
/// loses only its unfinished items.
/// @note not thread-safe
class SweepStore {
 public:
  /// Opens a store for writing, or creates it.
  /// @throws IoError if the file is not a store, is damaged, or of another version or instruction
  ///         set
  static SweepStore open(const std::filesystem::path& path, const SweepStoreOptions& options = {});
  /// Opens a store for reading, also in a read-only directory. @throws IoError as open()
  static SweepStore read(const std::filesystem::path& path);
  /// Merges stores into a new one. An item is finished if any store has its result. The result does
  /// not depend on the order.
  /// @throws IoError as open() and read(), if `path` is not new or empty, or results differ
  static void merge(const std::filesystem::path& path,
                    std::span<const std::filesystem::path> parts);

  /// Instruction set of the results, see dispatch_target().
  const std::string& target() const;

  /// Adds new items.
  /// @param settings  returns JSON of the i-th item, for display
  void add(std::span<const std::string> keys,
           const std::function<std::string(std::size_t)>& settings);

  /// Marks unfinished items as running. Examines at most the first few thousand `keys` and stops
  /// after claiming `max_items`.
  /// @param takes_running  also claim items already marked as running
  /// @return answers for the examined keys
  std::vector<ClaimAnswer> claim(std::span<const std::string> keys, std::size_t max_items,
                                 bool takes_running = false);
  /// Stores outcomes; a finished item keeps its result.
  void finish(std::span<const ItemOutcome> outcomes);
  /// Unmarks unfinished items.
  void release(std::span<const std::string> keys);

  /// @throws IoError if the entry is damaged
  std::optional<StoredItem> find(std::string_view key);
  /// Counts the items with these keys, each once; unknown items are pending.
  SweepCounts count(std::span<const std::string> keys);

 private:
  struct State;
  explicit SweepStore(Hidden<State> state);
  Hidden<State> state_;
};

/// Increased when the results of equal settings change; invalidates older stores.
inline constexpr int sweep_result_version = 3;

/// One depth error to compute.
struct WorkItem {
  /// Hash of everything that determines the result, but not of names, files or positions (32
  /// hexadecimal digits).
  std::string key;
  Camera camera;
  std::optional<CodeSet> code;  ///< none: to be designed
  EvaluateOptions options;
  /// Options to design the code. "optimized-k4" is the best code with 4 exposures that design()
  /// finds without families.
  std::optional<DesignOptions> design = {};
};

class WorkList {
 public:
  explicit WorkList(SweepSpec spec) : spec_(std::move(spec)), size_(spec_.items()) {}

  const SweepSpec& spec() const { return spec_; }
  std::int64_t size() const { return size_; }

  /// A family member or a file.
  std::string code_name(std::int64_t item) const;
  /// Distinguishing settings as one line of JSON: {"code": "square-k4", "samples": 120}.
  std::string settings_json(std::int64_t item) const;

  /// Loads and builds an item.
  /// @throws IoError naming the item and place, for unreadable files, invalid values, and codes
  ///         that the camera does not support
  WorkItem item(std::int64_t item) const;

  /// Returns the keys of all items and checks each item.
  /// @throws IoError as item(); Interrupted
  std::vector<std::string> keys(const Progress& progress = {}) const;

 private:
  SweepSpec spec_;
  std::int64_t size_;
};

/// Part of a sweep that is split between machines without a shared store.
struct SweepShard {
  int index = 1;  ///< 1 to count
  int count = 1;

  static constexpr char separator = '/';
  static constexpr std::string_view rule = "index and count with 1 <= index <= count";
  static constexpr std::string_view example = "3/8";
  bool is_valid() const { return index >= 1 && index <= count; }
  /// Returns true if an item belongs to this part, which depends only on its key.
  bool holds(std::string_view key) const;
};
auto fields_of(ConstOrNot<SweepShard> auto& s) {
  return std::tuple(Field("index", s.index), Field("count", s.count));
}

/// An item claimed by this process.
struct ClaimedItem {
  std::int64_t item;
  std::string key;
};

/// Computes items on all threads; failed items have a message instead of a result.
std::vector<ItemOutcome> compute_items(const WorkList& list, std::span<const ClaimedItem> items);

/// Unfinished items of a sweep. Several processes may have a queue of the same store. Items marked
/// as running are claimed last: few are computed twice, but items of a killed process are still
/// computed. The destructor releases unfinished claims.
class SweepQueue {
 public:
  /// @param keys   of all items; must outlive this object, as must the store
  /// @param shard  part that the queue contains
  /// @throws IoError if the store fails; Interrupted
  SweepQueue(const WorkList& list, std::span<const std::string> keys, SweepStore& store,
             const SweepShard& shard = {}, const Progress& progress = {});
  ~SweepQueue();
  SweepQueue(const SweepQueue&) = delete;
  SweepQueue& operator=(const SweepQueue&) = delete;

  /// Claims up to `max_items`; returns none only if nothing is left.
  std::vector<ClaimedItem> claim(std::size_t max_items);
  void finish(std::span<const ItemOutcome> outcomes);

  std::size_t size() const { return size_; }
  /// Number of unclaimed items.
  std::size_t left() const { return items_.size() - next_ + running_.size(); }
  /// Number of finished or failed items.
  std::size_t settled() const { return size_ - left() - claimed_.size(); }

 private:
  std::vector<std::string> keys_of(std::span<const std::int64_t> items) const;

  std::span<const std::string> keys_;
  SweepStore& store_;
  std::vector<std::int64_t> items_;
  std::vector<std::int64_t> running_;  ///< by other processes, when examined
  bool takes_running_ = false;
  std::size_t next_ = 0, size_ = 0;
  std::set<std::string, std::less<>> claimed_;
};

struct SweepRunOptions {
  SweepShard shard;
  double batch_s = 1.0;
};
auto fields_of(ConstOrNot<SweepRunOptions> auto& o) {
  return std::tuple(
      Field(
          "shard", o.shard,
          Help{"index and count of parts: compute only one part of the items; sweep merge combines "
               "the stores of all parts"}),
      Field("batch_s", o.batch_s, above(0).or_infinity(),
            Help{"computing time of the items claimed at a time; lost if killed"}));
}

struct SweepRun {
  std::int64_t computed = 0;          ///< finished by this run
  std::vector<std::string> failures;  ///< one line per failed item
};

/// Computes all unfinished items, with the same bits for any number of threads and processes.
/// @param keys  WorkList::keys()
/// @param progress  finished items are kept if it cancels
/// @throws IoError if the store fails; Interrupted
SweepRun run_sweep(const WorkList& list, std::span<const std::string> keys, SweepStore& store,
                   const SweepRunOptions& options = {}, const Progress& progress = {});

struct SweepResult {
  std::int64_t item = 0;
  std::string key;
  DepthErrorReport error;
  std::optional<CodeSet> code = {};
};

/// Returns the finished items in the order of the list. The same results give the same bytes in
/// every export.
/// @param keys  WorkList::keys()
/// @throws IoError if the store is damaged
std::vector<SweepResult> sweep_results(const WorkList& list, std::span<const std::string> keys,
                                       SweepStore& store);

/// Returns a row per item and operating point: values of all axes, errors and bounds [m].
std::string sweep_csv(const WorkList& list, std::span<const SweepResult> results);

/// Returns axes, settings and results in the format of `tofsmith evaluate`. `designed` contains a
/// designed code in the format of its file.
/// @param target  instruction set of the results
std::string sweep_json(const WorkList& list, std::span<const SweepResult> results,
                       std::string_view target);

/// Returns the columns of the CSV file. A text axis becomes two arrays: `NAME_index` with indices
/// into `NAME_names`, which contains UTF-8 bytes padded with zeros (in NumPy:
/// names.view(f"S{names.shape[1]}").ravel()).
NpzArrays sweep_arrays(const WorkList& list, std::span<const SweepResult> results);

}  // namespace tofsmith
