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

TimeFilterOptions time_filter_options(const py::dict& values) {
  TimeFilterOptions options;
  read_options(values, "time_filter", options);
  options.validate();
  return options;
}

namespace {

/// Raw numbers and of how many each is the mean, of frames that `filtered(frame, progress)` gives.
template <typename Filtered>
py::tuple filter_frames(const py::array& raw_numbers, bool is_planar, int measurement_count,
                        const py::object& averaged_before, const py::object& callback,
                        const Filtered& filtered) {
  RawArray raw = view_raw(raw_numbers, is_planar, measurement_count);
  const Floats means = averaged_before.is_none() ? Floats() : Floats::ensure(averaged_before);
  if (!averaged_before.is_none()) raw.set_averaged(means);
  const auto pixels = static_cast<std::size_t>(raw.frames.front().pixels());
  const auto measurements = static_cast<std::size_t>(measurement_count);
  std::vector<float> numbers(raw.frames.size() * pixels * measurements);
  std::vector<float> averaged(raw.frames.size() * pixels);
  without_gil(callback, [&](const Progress& progress) {
    const ProgressParts parts(progress, raw.frames.size());
    for (std::size_t f = 0; f < raw.frames.size(); ++f) {
      const RawView view = filtered(raw.frames[f], parts[f]);
      copy_pixels(view, 0, view.pixels(), numbers.data() + f * pixels * measurements);
      std::copy_n(view.averaged, pixels, averaged.data() + f * pixels);
    }
  });
  std::vector<py::ssize_t> shape = raw.plane_shape();
  const py::array_t<float> planes = adopt(std::move(averaged), shape);
  shape.push_back(measurement_count);
  return py::make_tuple(adopt(std::move(numbers), std::move(shape)), planes);
}

py::tuple apply_filter(const Filter& filter, const py::array& raw_numbers, bool is_planar,
                       const py::object& averaged, const py::object& callback) {
  FilteredFrame filtered;
  return filter_frames(raw_numbers, is_planar, filter.measurements(), averaged, callback,
                       [&](const RawView& raw, const Progress& progress) {
                         filter.apply(raw, filtered, progress);
                         return filtered.view();
                       });
}

py::tuple add_to_filter(TimeFilter& filter, const py::array& raw_numbers, bool is_planar,
                        const py::object& averaged, const py::object& callback) {
  return filter_frames(raw_numbers, is_planar, filter.measurements(), averaged, callback,
                       [&](const RawView& raw, const Progress& progress) {
                         const RawView added = filter.add(raw);
                         report(progress, 1.0, "filtering");
                         return added;
                       });
}

py::tuple merge_frames(const DecodingTable& table, const py::array& raw_numbers, bool is_planar,
                       const py::object& averaged, const std::vector<double>& exposures) {
  RawArray raw = view_raw(raw_numbers, is_planar, table.measurements());
  const Floats means = averaged.is_none() ? Floats() : Floats::ensure(averaged);
  if (!averaged.is_none()) raw.set_averaged(means);
  MergedExposures merged;
  {
    const py::gil_scoped_release release;
    merge_exposures(raw.frames, exposures, table, merged);
  }
  return py::make_tuple(
      adopt(std::move(merged.values.values), {raw.height, raw.width, table.measurements()}),
      adopt(std::move(merged.averaged.pixels), {raw.height, raw.width}));
}

py::array_t<float> without_stray_light(const DecodingTable& table, const py::array& raw_numbers,
                                       bool is_planar, const py::object& kernel) {
  const RawArray raw = view_raw(raw_numbers, is_planar, table.measurements());
  StrayLight stray_light(to_image(kernel, "kernel"));
  std::vector<float> numbers;
  {
    const py::gil_scoped_release release;
    RawFrames clean;
    for (const RawView& frame : raw.frames) {
      stray_light.remove(frame, table, clean);
      numbers.insert(numbers.end(), clean.values.begin(), clean.values.end());
    }
  }
  std::vector<py::ssize_t> shape = raw.plane_shape();
  shape.push_back(table.measurements());
  return adopt(std::move(numbers), std::move(shape));
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
  py::class_<TimeFilter>(module, "TimeFilter")
      .def(py::init([](const DecodingTable& table, const py::dict& values) {
        const TimeFilterOptions options = time_filter_options(values);
        const py::gil_scoped_release release;
        return TimeFilter(table, options);
      }))
      .def("table", [](const TimeFilter& filter) { return filter.table(); })
      .def("options", [](const TimeFilter& filter) { return fields_dict(filter.options()); })
      .def("add", &add_to_filter)
      .def("forget", &TimeFilter::forget);
  module.def("merge_exposures", &merge_frames);
  module.def("without_stray_light", &without_stray_light);
  module.def("filter_strengths", [] {
    std::vector<std::string> names;
    for (const FilterStrength strength : all_filter_strengths)
      names.emplace_back(name_of(strength));
    return names;
  });
}

}  // namespace tofsmith::python
