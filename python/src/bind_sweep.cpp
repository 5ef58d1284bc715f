// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <pybind11/stl.h>

#include <optional>
#include <stdexcept>
#include <tuple>

#include "bindings.hpp"
#include "options.hpp"
#include "progress.hpp"
#include "tofsmith/core/build_info.hpp"
#include "tofsmith/sweep/run_sweep.hpp"
#include "tofsmith/version.hpp"

namespace tofsmith::python {

namespace {

template <typename Item>
py::array array_of(const NpyArray& array) {
  const auto items = array.as<Item>();
  return adopt(std::vector<Item>(items.begin(), items.end()),
               {array.shape().begin(), array.shape().end()});
}

/// Converts the arrays of an export: doubles, int64 and bytes of texts.
py::dict arrays_dict(const NpzArrays& arrays) {
  py::dict dict;
  for (const auto& [name, array] : arrays) {
    if (array.type() == NpyType::float64)
      dict[py::str(name)] = array_of<double>(array);
    else if (array.type() == NpyType::int64)
      dict[py::str(name)] = array_of<std::int64_t>(array);
    else
      dict[py::str(name)] = array_of<std::uint8_t>(array);
  }
  return dict;
}

/// Contents of a store for the items of a sweep.
struct Stored {
  SweepCounts counts;
  NpzArrays arrays;
  std::vector<std::string> failures;
};

py::dict stored_dict(const Stored& stored, std::int64_t items) {
  py::dict dict;
  dict["items"] = items;
  dict["finished"] = stored.counts.finished;
  dict["failed"] = stored.counts.failed;
  dict["pending"] = stored.counts.pending + stored.counts.running;
  dict["seconds"] = stored.counts.seconds;
  dict["failures"] = stored.failures;
  dict["arrays"] = arrays_dict(stored.arrays);
  return dict;
}

Stored look(const WorkList& list, std::span<const std::string> keys, SweepStore& store) {
  return {store.count(keys), sweep_arrays(list, sweep_results(list, keys, store)), {}};
}

WorkList list_of(const std::string& sweep, bool is_text) {
  return WorkList(is_text ? parse_sweep_toml(sweep, "sweep") : read_sweep_toml(sweep));
}

py::dict run(const std::string& sweep, bool is_text, const std::string& path,
             const py::object& callback) {
  const WorkList list = list_of(sweep, is_text);
  const Stored stored = without_gil(callback, [&](const Progress& progress) {
    const std::vector<std::string> keys = list.keys(progress);
    SweepStore store = SweepStore::open(path);
    const SweepRun done = run_sweep(list, keys, store, {}, progress);
    Stored found = look(list, keys, store);
    found.failures = done.failures;
    return found;
  });
  return stored_dict(stored, list.size());
}

py::dict read(const std::string& sweep, bool is_text, const std::string& path,
              const py::object& callback) {
  const WorkList list = list_of(sweep, is_text);
  const Stored stored = without_gil(callback, [&](const Progress& progress) {
    const std::vector<std::string> keys = list.keys(progress);
    SweepStore store = SweepStore::read(path);
    return look(list, keys, store);
  });
  return stored_dict(stored, list.size());
}

using ItemTuple = std::tuple<std::int64_t, std::string>;
using OutcomeTuple = std::tuple<std::string, std::string, std::string, double>;

std::vector<OutcomeTuple> compute(const WorkList& list, const std::vector<ItemTuple>& items,
                                  int threads) {
  const py::gil_scoped_release release;
  std::vector<ClaimedItem> claimed;
  for (const auto& [item, key] : items) claimed.push_back({item, key});
  const SharedThreadLimit limit(threads);
  std::vector<OutcomeTuple> outcomes;
  for (ItemOutcome& outcome : compute_items(list, claimed))
    outcomes.emplace_back(std::move(outcome.key), std::move(outcome.result),
                          std::move(outcome.message), outcome.seconds);
  return outcomes;
}

/// A sweep with its store and the queue of unfinished items, which may be shared with other
/// processes.
class BoundSweepRun {
 public:
  BoundSweepRun(const std::string& sweep, bool is_text, const std::string& path,
                const py::object& callback)
      : list_(list_of(sweep, is_text)) {
    without_gil(callback, [&](const Progress& progress) {
      keys_ = list_.keys(progress);
      store_.emplace(SweepStore::open(path));
      queue_.emplace(list_, keys_, *store_, SweepShard{}, progress);
    });
  }

  SweepQueue& queue() {
    if (!queue_) throw std::logic_error("the run was released");
    return *queue_;
  }
  std::vector<ItemTuple> claim(std::size_t max_items) {
    const py::gil_scoped_release release;
    std::vector<ItemTuple> items;
    for (ClaimedItem& claimed : queue().claim(max_items))
      items.emplace_back(claimed.item, std::move(claimed.key));
    return items;
  }
  void finish(const std::vector<OutcomeTuple>& tuples) {
    const py::gil_scoped_release release;
    std::vector<ItemOutcome> outcomes;
    for (const auto& [key, result, message, seconds] : tuples)
      outcomes.push_back({key, result, message, seconds});
    queue().finish(outcomes);
  }
  void release() { queue_.reset(); }
  py::dict results() { return stored_dict(look(list_, keys_, *store_), list_.size()); }

 private:
  WorkList list_;
  std::vector<std::string> keys_;
  std::optional<SweepStore> store_;
  std::optional<SweepQueue> queue_;
};

}  // namespace

void bind_sweep(py::module_& module) {
  py::class_<WorkList>(module, "SweepList")
      .def(py::init([](const std::string& text, const std::string& source_name) {
        return WorkList(parse_sweep_toml(text, source_name));
      }))
      .def("compute", &compute);
  py::class_<BoundSweepRun>(module, "SweepRun")
      .def(py::init<const std::string&, bool, const std::string&, const py::object&>())
      .def_property_readonly("size", [](BoundSweepRun& run) { return run.queue().size(); })
      .def_property_readonly("left", [](BoundSweepRun& run) { return run.queue().left(); })
      .def_property_readonly("settled", [](BoundSweepRun& run) { return run.queue().settled(); })
      .def("claim", &BoundSweepRun::claim)
      .def("finish", &BoundSweepRun::finish)
      .def("release", &BoundSweepRun::release)
      .def("results", &BoundSweepRun::results);
  module.def("worker_build", [] {
    return std::pair(fmt::format("{} (results {})", TOFSMITH_VERSION, sweep_result_version),
                     dispatch_target());
  });
  module.def("run_sweep", &run);
  module.def("read_sweep", &read);
}

}  // namespace tofsmith::python
