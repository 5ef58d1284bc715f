// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <pybind11/stl.h>

#include "bindings.hpp"
#include "options.hpp"
#include "progress.hpp"
#include "tofsmith/sweep/run_sweep.hpp"

namespace tofsmith::python {

namespace {

template <typename Item>
py::array array_of(const NpyArray& array) {
  const auto items = array.as<Item>();
  return adopt(std::vector<Item>(items.begin(), items.end()),
               {array.shape().begin(), array.shape().end()});
}

/// The arrays of an export, which hold doubles, int64 and bytes of texts.
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

/// What is in a store of the items of a sweep.
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

}  // namespace

void bind_sweep(py::module_& module) {
  module.def("run_sweep", &run);
  module.def("read_sweep", &read);
}

}  // namespace tofsmith::python
