// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tofsmith/core/error.hpp"
#include "tofsmith/core/progress.hpp"
#include "tofsmith/design/design.hpp"
#include "tofsmith/io/camera_toml.hpp"
#include "tofsmith/io/npy.hpp"
#include "tofsmith/simulate/depth_error.hpp"

namespace tofsmith {

/// A parameter that varies.
struct SweepAxis {
  /// A key of the camera such as "light.peak_factor", or camera, code, exposures, method,
  /// signal_e_per_s, ambient_e_per_s, seed or trials.
  std::string key;
  std::vector<SettingValue> values;  ///< at least one
  std::string place;                 ///< where the axis was defined, for errors
  bool crossed = false;              ///< combined with every other axis, even if those are zipped
  bool linked = false;               ///< advances together with the previous axis
  std::string group = {};            ///< axes of a group are combined first; "" for none
};

/// Combination of the values of several axes or groups.
enum class SweepCombination {
  product,  ///< all combinations; the last axis varies fastest
  zip,      ///< first with first, second with second, ...; equal lengths required
};

/// Definition of a sweep: a list of depth errors to compute. As TOML:
///
///     camera = "paper-10f0"        # a built-in name, or a file next to this one
///     set = ["samples=120"]        # keys of the camera to override
///     codes = ["hamiltonian-k4", "mine.code.json"]   # or code = "hamiltonian-k{exposures}"
///     method = "zncc"
///     trials = 20000               # or target_standard_error = 0.01, max_trials = 50000000
///     seed = 1
///     effort = 0.1                 # for codes to design, such as "optimized-k{exposures}"
///     outlier_threshold_m = 0.5
///     combine = "product"
///
///     [[axis]]
///     key = "light.peak_factor"
///     values = [5, 10, 15]
///
///     [[axis]]
///     key = "signal_e_per_s"       # replaces the camera's operating.signal_e_per_s
///     from = 1e3
///     to = 1e5
///     count = 9                    # logarithmic; or step = 500
///
///     [[axis]]
///     key = "exposure_s"
///     file = "times.txt"           # one value per line
///
///     [[axis]]                     # one axis that sets several keys
///     keys = ["light.impulse_response.f_max_hz", "sensor.impulse_response.f_max_hz"]
///     values = [1e8, [2e8, 1e8]]   # one for all keys, or one for each
///
///     [[axis]]
///     key = "samples"
///     values = [120, 240]
///     group = "speed"              # axes of a group are combined first, by default zipped
///
///     [[group]]                    # groups and other axes are then combined by `combine`
///     name = "speed"
///     combine = "product"
struct SweepSpec {
  std::string source_name;          ///< name in errors
  std::filesystem::path directory;  ///< base of relative names of cameras and codes
  std::string camera = std::string(default_camera_name);
  std::vector<std::string> settings;  ///< overrides of the camera, as for load_camera()
  std::string code;                   ///< used if no axis has the key "code"
  EvaluateOptions options;
  double effort = 1.0;  ///< of designs, see with_effort()
  SweepCombination combine = SweepCombination::product;
  std::vector<SweepAxis> axes;  ///< keys of one [[axis]] are consecutive, all but the first linked
  std::map<std::string, SweepCombination> groups = {};  ///< by name; zip if absent

  /// Number of items, at most 2^62.
  std::int64_t items() const;
  /// Index of the value of each axis for an item.
  std::vector<std::size_t> value_indices(std::int64_t item) const;
};

/// @param source_name  path of the file, or a name for errors
/// @throws IoError "file:line:column: ..." for invalid TOML, unknown keys and axes (with the most
///         similar known one), empty axes, repeated keys, zipped axes of different lengths, and
///         infinite ranges
SweepSpec parse_sweep_toml(std::string_view text, std::string_view source_name = "sweep.toml");
/// @throws IoError as parse_sweep_toml(), or if the file cannot be read
SweepSpec read_sweep_toml(const std::filesystem::path& path);

struct SweepStoreOptions {
  /// Name of the network file system that the store is on ("NFS"), "" for none; detected if absent.
  std::optional<std::string> network_file_system = {};
};

/// Number of items by status.
struct SweepCounts {
  std::int64_t pending = 0, running = 0, finished = 0, failed = 0;
  double seconds = 0.0;  ///< total computing time of the finished items [s]
};

enum class ItemStatus { pending, running, finished, failed };

/// Record of an item in a store.
struct StoredItem {
  ItemStatus status = ItemStatus::pending;
  std::string settings;  ///< JSON, as added
  std::string result;    ///< JSON, if finished
  std::string message;   ///< why it failed
  double seconds = 0.0;
};

/// Outcome of an item, to be stored.
struct ItemOutcome {
  std::string key;
  std::string result;   ///< JSON; "" if the item failed
  std::string message;  ///< why it failed
  double seconds = 0.0;
};

/// Answer of SweepStore::claim() for one item.
enum class ClaimAnswer {
  ours,      ///< the caller must compute the item
  finished,  ///< no computation needed
  running,   ///< another process computes it, or was terminated while doing so
};

/// Results of sweeps in one SQLite file, stored under the keys of the items. Several processes may
/// share a store; a process that is killed loses only its unfinished items. The file is in WAL
/// mode, or uses a rollback journal on a network file system.
/// @note not thread-safe
class SweepStore {
 public:
  /// Opens a store for writing; creates it if it is missing or empty.
  /// @throws IoError if the file is not a store, is damaged, has another version or instruction
  ///         set, is in WAL mode on a network file system, or cannot be written
  static SweepStore open(const std::filesystem::path& path, const SweepStoreOptions& options = {});
  /// Opens a store for reading; the file and its directory may be read-only.
  /// @throws IoError if the file is missing, not a store, damaged or of another version
  static SweepStore read(const std::filesystem::path& path);
  /// Merges stores into a new one with all their items; an item is finished if it is finished in
  /// any of them. The result does not depend on the order.
  /// @param path  a new or empty file
  /// @throws IoError as open() and read(), or if two stores differ in a result
  static void merge(const std::filesystem::path& path,
                    std::span<const std::filesystem::path> parts);
  ~SweepStore();
  SweepStore(SweepStore&&) noexcept;

  /// Instruction set that the results were computed with, see dispatch_target().
  const std::string& target() const;

  /// Adds items that the store does not contain yet.
  /// @param settings  returns JSON of the i-th item, for display
  void add(std::span<const std::string> keys,
           const std::function<std::string(std::size_t)>& settings);

  /// Marks unfinished items as running. Examines at most the first few thousand of `keys`, and
  /// stops after claiming `max_items`.
  /// @param takes_running  also claim items that are already marked as running
  /// @return answers for the examined keys
  std::vector<ClaimAnswer> claim(std::span<const std::string> keys, std::size_t max_items,
                                 bool takes_running = false);
  /// Stores outcomes of items. A finished item keeps its result.
  void finish(std::span<const ItemOutcome> outcomes);
  /// Removes the marks of unfinished items.
  void release(std::span<const std::string> keys);

  /// @throws IoError if the entry is damaged
  std::optional<StoredItem> find(std::string_view key);
  /// Counts the items with these keys, each once; unknown items are pending.
  SweepCounts count(std::span<const std::string> keys);

 private:
  struct State;
  explicit SweepStore(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

/// Increased whenever the results for the same settings change, which invalidates older stores.
inline constexpr int sweep_result_version = 3;

/// One depth error to compute.
struct WorkItem {
  /// 32 hexadecimal digits: a hash of everything that determines the result (camera with its
  /// responses as samples, waveforms, decoder, operating points, seed, trials, version of results),
  /// but not of names, files or positions in a list.
  std::string key;
  Camera camera;
  std::optional<CodeSet> code;  ///< none: to be designed
  EvaluateOptions options;
  /// How the code is designed for this item's camera. "optimized-k4" is the best code with 4
  /// exposures that design() finds by optimization, without families.
  std::optional<DesignOptions> design = {};
};

class WorkList {
 public:
  explicit WorkList(SweepSpec spec) : spec_(std::move(spec)), size_(spec_.items()) {}

  const SweepSpec& spec() const { return spec_; }
  std::int64_t size() const { return size_; }

  /// Name of an item's code in the sweep: a family member or a file.
  std::string code_name(std::int64_t item) const;
  /// Distinguishing settings of an item as one line of JSON: {"code": "square-k4", "samples": 120}.
  std::string settings_json(std::int64_t item) const;

  /// Loads and builds an item.
  /// @throws IoError for unreadable files, invalid camera values, and codes that the camera does
  ///         not support; names the item and where the value was written
  WorkItem item(std::int64_t item) const;

  /// Returns the keys of all items, and thereby checks each item.
  /// @throws IoError as item(); Interrupted if `progress` cancels
  std::vector<std::string> keys(const Progress& progress = {}) const;

 private:
  SweepSpec spec_;
  std::int64_t size_;
};

/// One part of a sweep that is split between machines without a shared store.
struct SweepShard {
  int index = 1;  ///< 1 to count
  int count = 1;

  /// Returns true if an item belongs to this part. This depends only on its key, so items keep
  /// their part when axes grow.
  bool holds(std::string_view key) const;
  /// Returns the violated rule; none if valid.
  std::optional<BrokenRule> broken_rule() const;
  /// @throws InvalidArgument with broken_rule()
  void validate() const;
};

/// An item that this process has claimed.
struct ClaimedItem {
  std::int64_t item;  ///< position in the list
  std::string key;
};

/// Computes items on all threads. An item that fails has a message instead of a result.
std::vector<ItemOutcome> compute_items(const WorkList& list, std::span<const ClaimedItem> items);

/// The unfinished items of a sweep. Several processes may have a queue of the same store. Items
/// marked as running are claimed last, so that few items are computed twice and the items of a
/// killed process are still computed. The destructor releases items that were claimed but not
/// finished.
class SweepQueue {
 public:
  /// Adds the items to the store.
  /// @param keys   of all items of the list; must outlive this object, as must the store
  /// @param shard  part of the items that the queue contains
  /// @throws IoError if the store fails; Interrupted if `progress` cancels
  SweepQueue(const WorkList& list, std::span<const std::string> keys, SweepStore& store,
             const SweepShard& shard = {}, const Progress& progress = {});
  ~SweepQueue();
  SweepQueue(const SweepQueue&) = delete;
  SweepQueue& operator=(const SweepQueue&) = delete;

  /// Claims up to `max_items`; returns none only if nothing is left to compute.
  std::vector<ClaimedItem> claim(std::size_t max_items);
  void finish(std::span<const ItemOutcome> outcomes);

  std::size_t size() const { return size_; }  ///< number of items in this part
  /// Number of items that are not claimed yet.
  std::size_t left() const { return items_.size() - next_ + running_.size(); }
  /// Number of finished or failed items.
  std::size_t settled() const { return size_ - left() - claimed_.size(); }

 private:
  std::vector<std::string> keys_of(std::span<const std::int64_t> items) const;

  std::span<const std::string> keys_;
  SweepStore& store_;
  std::vector<std::int64_t> items_;    ///< to examine, from next_ on
  std::vector<std::int64_t> running_;  ///< marked by other processes when examined
  bool takes_running_ = false;
  std::size_t next_ = 0, size_ = 0;
  std::set<std::string, std::less<>> claimed_;
};

struct SweepRunOptions {
  SweepShard shard;
  double batch_s = 1.0;  ///< work claimed at a time, lost if killed [s], > 0

  /// @throws std::invalid_argument
  void validate() const;
};

struct SweepRun {
  std::int64_t computed = 0;          ///< items finished by this run
  std::vector<std::string> failures;  ///< one line per item that failed in this run
};

/// Computes all unfinished items of a sweep on all threads. Results have the same bits for any
/// number of threads and processes.
/// @param keys      of all items, WorkList::keys()
/// @param progress  called about 20 times per second; finished items are kept if it cancels
/// @throws IoError if the store fails; Interrupted if `progress` cancels
SweepRun run_sweep(const WorkList& list, std::span<const std::string> keys, SweepStore& store,
                   const SweepRunOptions& options = {}, const Progress& progress = {});

struct SweepResult {
  std::int64_t item = 0;
  std::string key;
  DepthErrorReport error;
  std::optional<CodeSet> code = {};  ///< if it was designed
};

/// Returns the finished items in the order of the list. The same results give the same bytes in
/// every export, regardless of when and where they were computed.
/// @param keys  of all items, WorkList::keys()
/// @throws IoError if the store is damaged
std::vector<SweepResult> sweep_results(const WorkList& list, std::span<const std::string> keys,
                                       SweepStore& store);

/// Returns a table with a row per item and operating point: values of all axes, errors and bounds
/// in metres.
std::string sweep_csv(const WorkList& list, std::span<const SweepResult> results);

/// Returns the axes, and per item its settings and the result in the format of `tofsmith evaluate`.
/// `designed` contains a designed code in the format of its file.
/// @param target  instruction set of the results
std::string sweep_json(const WorkList& list, std::span<const SweepResult> results,
                       std::string_view target);

/// Returns the columns of the CSV file as arrays of equal length. A text axis is stored as two
/// arrays: `NAME_index` contains indices into `NAME_names`, and `NAME_names` contains UTF-8 bytes
/// padded with zeros (in NumPy: names.view(f"S{names.shape[1]}").ravel()).
NpzArrays sweep_arrays(const WorkList& list, std::span<const SweepResult> results);

}  // namespace tofsmith
