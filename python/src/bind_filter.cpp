// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <pybind11/stl.h>

#include "bindings.hpp"
#include "field_dicts.hpp"
#include "filter_options.hpp"
#include "options.hpp"
#include "progress.hpp"
#include "raw_array.hpp"
#include "tofsmith/decode/filter.hpp"

namespace tofsmith::python {

FilterOptions filter_options(const py::dict& values) {
  const py::dict fields(values.attr("copy")());
  const py::object strength = fields.attr("pop")("strength", py::none());
  FilterOptions options =
      FilterOptions::of(strength.is_none() ? FilterStrength::normal
                                           : parse_filter_strength(std::string(py::str(strength))));
  read_options(fields, "filter", options);
  options.validate();
  return options;
}

namespace {

py::tuple apply_filter(const Filter& filter, const py::array& raw_numbers, bool is_planar,
                       const py::object& averaged_before, const py::object& callback) {
  RawArray raw = view_raw(raw_numbers, is_planar, filter.measurements());
  const Floats means = averaged_before.is_none() ? Floats() : Floats::ensure(averaged_before);
  if (!averaged_before.is_none()) raw.set_averaged(means);
  const auto pixels = static_cast<std::size_t>(raw.frames.front().pixels());
  const auto measurements = static_cast<std::size_t>(filter.measurements());
  std::vector<float> numbers(raw.frames.size() * pixels * measurements);
  std::vector<float> averaged(raw.frames.size() * pixels);
  without_gil(callback, [&](const Progress& progress) {
    const ProgressParts parts(progress, raw.frames.size());
    FilteredFrame filtered;
    for (std::size_t f = 0; f < raw.frames.size(); ++f) {
      filter.apply(raw.frames[f], filtered, parts[f]);
      copy_pixels(filtered.view(), 0, filtered.view().pixels(),
                  numbers.data() + f * pixels * measurements);
      std::ranges::copy(filtered.averaged().pixels,
                        averaged.begin() + static_cast<std::ptrdiff_t>(f * pixels));
    }
  });
  std::vector<py::ssize_t> shape = raw.plane_shape();
  const py::array_t<float> planes = adopt(std::move(averaged), shape);
  shape.push_back(filter.measurements());
  return py::make_tuple(adopt(std::move(numbers), std::move(shape)), planes);
}

}  // namespace

void bind_filter(py::module_& module) {
  py::class_<Filter>(module, "Filter")
      .def(py::init([](const DecodingTable& table, const py::dict& values) {
        const FilterOptions options = filter_options(values);
        const py::gil_scoped_release release;
        return Filter(table, options);
      }))
      .def("table", [](const Filter& filter) { return filter.table(); })
      .def("options", [](const Filter& filter) { return fields_dict(filter.options()); })
      .def("apply", &apply_filter);
  module.def("filter_strengths", [] {
    std::vector<std::string> names;
    for (const FilterStrength strength : all_filter_strengths)
      names.emplace_back(name_of(strength));
    return names;
  });
}

}  // namespace tofsmith::python
