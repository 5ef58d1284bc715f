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

/// One thing that varies.
struct SweepAxis {
  /// A key of the camera such as "light.peak_factor", or camera, code, exposures, method,
  /// signal_e_per_s, ambient_e_per_s, seed, trials.
  std::string key;
  std::vector<SettingValue> values;  ///< at least one
  std::string place;                 ///< where it was written, as errors name it
  bool crossed = false;              ///< with all others, even where those are zipped
  bool linked = false;               ///< takes its values together with the axis before it
  std::string group = {};            ///< of axes that are combined first; "" for none
};

/// How the values of several axes, or groups of axes, meet.
enum class SweepCombination {
  product,  ///< every value of one with every value of the others; the last axis varies fastest
  zip,      ///< first with first, second with second, ..; all are of one length
};

/// A list of depth errors to find: what stays, and what varies. As TOML:
///
///     camera = "paper-10f0"        # a built-in name, or a file beside this one
///     set = ["samples=120"]        # keys of the camera that are other than there
///     codes = ["hamiltonian-k4", "mine.code.json"]   # or code = "hamiltonian-k{exposures}"
///     method = "zncc"
///     trials = 20000               # or target_standard_error = 0.01, max_trials = 50000000
///     seed = 1
///     effort = 0.1                 # of codes to be designed, such as "optimized-k{exposures}"
///     outlier_threshold_m = 0.5
///     combine = "product"
///
///     [[axis]]
///     key = "light.peak_factor"
///     values = [5, 10, 15]
///
///     [[axis]]
///     key = "signal_e_per_s"       # in place of the camera's operating.signal_e_per_s
///     from = 1e3
///     to = 1e5
///     count = 9                    # logarithmic; or step = 500
///
///     [[axis]]
///     key = "exposure_s"
///     file = "times.txt"           # a value a line
///
///     [[axis]]                     # one axis that sets several keys
///     keys = ["light.impulse_response.f_max_hz", "sensor.impulse_response.f_max_hz"]
///     values = [1e8, [2e8, 1e8]]   # one for all of them, or one for each
///
///     [[axis]]
///     key = "samples"
///     values = [120, 240]
///     group = "speed"              # axes of a group are combined first, zipped unless ..
///
///     [[group]]                    # .. it says otherwise; then groups and other axes by `combine`
///     name = "speed"
///     combine = "product"
struct SweepSpec {
  std::string source_name;          ///< what errors call it
  std::filesystem::path directory;  ///< where relative names of cameras and codes start
  std::string camera = std::string(default_camera_name);
  std::vector<std::string> settings;  ///< of the camera, as for load_camera()
  std::string code;                   ///< when there is no axis of that name
  EvaluateOptions options;
  double effort = 1.0;  ///< of designs, as of with_effort()
  SweepCombination combine = SweepCombination::product;
  std::vector<SweepAxis> axes;  ///< keys of one [[axis]] follow one another, all but one linked
  std::map<std::string, SweepCombination> groups = {};  ///< others are zipped

  /// How many items there are; at most 2^62, beyond which they are not counted.
  std::int64_t items() const;
  /// Which value of each axis an item has.
  std::vector<std::size_t> value_indices(std::int64_t item) const;
};

/// @param source_name  the file's path, or what errors shall call the text
/// @throws IoError "file:line:column: .." for what is no TOML, unknown keys and axes (with the
///         nearest known one), empty axes, keys that come twice, zipped axes of different lengths,
///         ranges without end
SweepSpec parse_sweep_toml(std::string_view text, std::string_view source_name = "sweep.toml");
/// @throws IoError as parse_sweep_toml(), or if the file cannot be read
SweepSpec read_sweep_toml(const std::filesystem::path& path);

/// Options of SweepStore::open().
struct SweepStoreOptions {
  /// Name of the network file system that holds the store ("NFS"), or "" for none; detected if
  /// absent.
  std::optional<std::string> network_file_system = {};
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

/// Answer of SweepStore::claim() for one item.
enum class ClaimAnswer {
  ours,      ///< the caller is to compute it
  finished,  ///< nobody needs to compute it
  running,   ///< another process computes it, or was ended while it did
};

/// Results of sweeps in one SQLite file, under the keys of their items. Many processes may work on
/// one store; a process that is killed loses its unfinished items only. The file is in WAL mode, or
/// has a rollback journal on a network file system.
/// @note one object must not be used by two threads at a time
class SweepStore {
 public:
  /// Opens a store to work on it; creates it if it is missing or empty.
  /// @throws IoError if the file is no store, damaged, of another version or instruction set, in
  ///         WAL mode on a network file system, or if it cannot be written
  static SweepStore open(const std::filesystem::path& path, const SweepStoreOptions& options = {});
  /// Opens a store to read it; the file and its directory may be read-only.
  /// @throws IoError if the file is missing, no store, damaged or of another version
  static SweepStore read(const std::filesystem::path& path);
  /// Creates a store from the content of others: all items, finished where they are finished in
  /// any. It depends on their content alone, not on their order.
  /// @param path  of a new or empty file
  /// @throws IoError as open() and read(), or if two of them differ in a result
  static void merge(const std::filesystem::path& path,
                    std::span<const std::filesystem::path> parts);
  ~SweepStore();
  SweepStore(SweepStore&&) noexcept;

  /// The instruction set that the results were computed on, see dispatch_target().
  const std::string& target() const;

  /// Adds items that are not there yet.
  /// @param settings  returns JSON of the i-th item, for people
  void add(std::span<const std::string> keys,
           const std::function<std::string(std::size_t)>& settings);

  /// Marks unfinished items as running. Looks at the first few thousand of `keys` at most, and at
  /// no further ones once `max_items` are ours.
  /// @param takes_running  whether also items that are marked already become ours
  /// @return answers for the keys that it looked at
  std::vector<ClaimAnswer> claim(std::span<const std::string> keys, std::size_t max_items,
                                 bool takes_running = false);
  /// Stores outcomes of items. A finished item keeps its result.
  void finish(std::span<const ItemOutcome> outcomes);
  /// Removes the marks of items that are still unfinished.
  void release(std::span<const std::string> keys);

  /// @throws IoError if the entry is damaged
  std::optional<StoredItem> find(std::string_view key);
  /// Counts the items with these keys, each once; those not in the store are pending.
  SweepCounts count(std::span<const std::string> keys);

 private:
  struct State;
  explicit SweepStore(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

/// Changes whenever the same settings give other results, so that old stores are not trusted.
inline constexpr int sweep_result_version = 3;

/// One depth error to find.
struct WorkItem {
  /// 32 hexadecimal digits: a hash of everything that determines the result (the camera with its
  /// responses as samples, the code's waveforms, decoder, operating points, seed, trials, version
  /// of results), and of nothing else: not of names, files or places in a list.
  std::string key;
  Camera camera;
  std::optional<CodeSet> code;  ///< none: it is to be designed
  EvaluateOptions options;
  /// How the code is designed, for this item's camera alone: one of the name "optimized-k4", the
  /// best of 4 exposures that design() finds by optimizing, without families.
  std::optional<DesignOptions> design = {};
};

/// The items of a sweep.
class WorkList {
 public:
  explicit WorkList(SweepSpec spec) : spec_(std::move(spec)), size_(spec_.items()) {}

  const SweepSpec& spec() const { return spec_; }
  std::int64_t size() const { return size_; }

  /// The code of an item, as it is called there: a family's name or a file.
  std::string code_name(std::int64_t item) const;
  /// What is particular about an item, as one line of JSON: {"code": "square-k4", "samples": 120}.
  std::string settings_json(std::int64_t item) const;

  /// Reads and builds what an item needs.
  /// @throws IoError for files that cannot be read, values that no camera can have and codes that
  ///         its camera cannot play, naming the value's place and the item
  WorkItem item(std::int64_t item) const;

  /// The keys of all items, each of which is so checked.
  /// @throws IoError as item(); Interrupted if progress says so
  std::vector<std::string> keys(const Progress& progress = {}) const;

 private:
  SweepSpec spec_;
  std::int64_t size_;
};

/// One part of a sweep that is cut in parts for machines that share nothing.
struct SweepShard {
  int index = 1;  ///< 1 .. count
  int count = 1;

  /// Whether an item belongs to this part. That depends on its key alone, so it stays where it is
  /// when axes grow.
  bool holds(std::string_view key) const;
  /// The rule that it breaks; none: it is a part of count.
  std::optional<BrokenRule> broken_rule() const;
  /// @throws InvalidArgument of broken_rule(), if there is one
  void validate() const;
};

/// An item that was claimed to be computed.
struct ClaimedItem {
  std::int64_t item;  ///< its place in the list
  std::string key;
};

/// Computes items on all threads. An item that fails has a message instead of a result.
std::vector<ItemOutcome> compute_items(const WorkList& list, std::span<const ClaimedItem> items);

/// The unfinished items of a sweep, for a process that computes them or has them computed. Several
/// processes may have a queue of one store: items that are marked as running come last, so two
/// processes compute few items twice, and the items of a process that was killed are computed by
/// the others. The destructor gives back the items that were claimed and not finished.
class SweepQueue {
 public:
  /// Adds the items to the store.
  /// @param keys   of all items of the list; must outlive this, as must the store
  /// @param shard  the part of the items that the queue contains
  /// @throws IoError if the store fails; Interrupted if progress asks to stop
  SweepQueue(const WorkList& list, std::span<const std::string> keys, SweepStore& store,
             const SweepShard& shard = {}, const Progress& progress = {});
  ~SweepQueue();
  SweepQueue(const SweepQueue&) = delete;
  SweepQueue& operator=(const SweepQueue&) = delete;

  /// Claims up to `max_items`; none only if no item is left to compute.
  std::vector<ClaimedItem> claim(std::size_t max_items);
  /// Stores outcomes of claimed items.
  void finish(std::span<const ItemOutcome> outcomes);

  std::size_t size() const { return size_; }  ///< items of this part
  /// Items that were not claimed yet.
  std::size_t left() const { return items_.size() - next_ + running_.size(); }
  /// Items that are finished or failed.
  std::size_t settled() const { return size_ - left() - claimed_.size(); }

 private:
  std::vector<std::string> keys_of(std::span<const std::int64_t> items) const;

  std::span<const std::string> keys_;
  SweepStore& store_;
  std::vector<std::int64_t> items_;    ///< to ask the store for, from next_ on
  std::vector<std::int64_t> running_;  ///< marked by others when the store was asked
  bool takes_running_ = false;
  std::size_t next_ = 0, size_ = 0;
  std::set<std::string, std::less<>> claimed_;
};

struct SweepRunOptions {
  SweepShard shard;
  double batch_s = 1.0;  ///< work that is claimed at a time, so lost when killed [s], > 0

  /// @throws std::invalid_argument naming field, value and rule
  void validate() const;
};

/// Result of run_sweep().
struct SweepRun {
  std::int64_t computed = 0;          ///< items that this run finished
  std::vector<std::string> failures;  ///< one line for each item that this run could not finish
};

/// Computes all unfinished items of a sweep on all threads. Results have the same bits whatever the
/// number of threads and processes.
/// @param keys      of all items, WorkList::keys()
/// @param progress  called about 20 times a second. When it asks to stop, what is finished is kept
/// @throws IoError if the store fails; Interrupted if progress asks to stop
SweepRun run_sweep(const WorkList& list, std::span<const std::string> keys, SweepStore& store,
                   const SweepRunOptions& options = {}, const Progress& progress = {});

/// A finished item of a sweep.
struct SweepResult {
  std::int64_t item = 0;
  std::string key;
  DepthErrorReport error;
  std::optional<CodeSet> code = {};  ///< that was designed
};

/// The finished items, in the order of the list: whenever and by whomever they were computed, the
/// same results give the same bytes in every export.
/// @param keys  of all items, WorkList::keys()
/// @throws IoError if the store is damaged
std::vector<SweepResult> sweep_results(const WorkList& list, std::span<const std::string> keys,
                                       SweepStore& store);

/// A row for each item and operating point: the value of every axis, errors and bounds in metres.
std::string sweep_csv(const WorkList& list, std::span<const SweepResult> results);

/// The axes, and one entry per item with its settings and its result as `tofsmith evaluate` gives
/// them; `designed` is a code that was designed, as in its file.
/// @param target  instruction set of the results
std::string sweep_json(const WorkList& list, std::span<const SweepResult> results,
                       std::string_view target);

/// The columns of the CSV file as arrays of one length. An axis of texts is `NAME_index` into
/// `NAME_names`, an array of UTF-8 bytes, padded with zeros (in NumPy:
/// names.view(f"S{names.shape[1]}").ravel()).
NpzArrays sweep_arrays(const WorkList& list, std::span<const SweepResult> results);

}  // namespace tofsmith
