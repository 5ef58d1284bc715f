// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <pybind11/stl.h>

#include <optional>

#include "arrays.hpp"
#include "bindings.hpp"
#include "bound_filter.hpp"
#include "field_dicts.hpp"
#include "options.hpp"
#include "progress.hpp"
#include "tofsmith/decode/filter.hpp"
#include "tofsmith/decode/merge_exposures.hpp"
#include "tofsmith/decode/stray_light.hpp"

namespace tofsmith::python {

FilterOptions filter_options(const py::dict& values) {
  const py::dict fields(values.attr("copy")());
  const py::object strength = fields.attr("pop")("strength", py::none());
  FilterOptions options = FilterOptions::of(
      strength.is_none()
          ? FilterStrength::normal
          : parse_word<FilterStrength>("filter strength", std::string(py::str(strength))));
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

/// Raw numbers of consecutive frames, with the number of averaged measurements.
class FilteredFrames {
 public:
  explicit FilteredFrames(int measurements) : measurements_(measurements) {}

  void add(const RawView& frame) {
    height_ = frame.height;
    width_ = frame.width;
    const auto pixels = static_cast<std::size_t>(frame.pixels());
    const std::size_t first = numbers_.size();
    numbers_.resize(first + pixels * static_cast<std::size_t>(measurements_));
    copy_pixels(frame, 0, frame.pixels(), numbers_.data() + first);
    averaged_.insert(averaged_.end(), frame.averaged, frame.averaged + pixels);
    ++frames_;
  }
  /// Returns arrays of shape (H, W, K) and (H, W) for a single frame if `alone`, else (F, H, W, K)
  /// and (F, H, W).
  py::tuple arrays(bool alone) {
    std::vector<py::ssize_t> shape = {frames_, height_, width_};
    if (alone) shape.erase(shape.begin());
    const py::array_t<float> planes = adopt(std::move(averaged_), shape);
    shape.push_back(measurements_);
    return py::make_tuple(adopt(std::move(numbers_), std::move(shape)), planes);
  }

 private:
  py::ssize_t measurements_, frames_ = 0, height_ = 0, width_ = 0;
  std::vector<float> numbers_, averaged_;
};

/// Calls `filter(frame, progress)` for each frame and collects the results, if any.
template <typename FilterFrame>
py::tuple filter_frames(const py::array& raw_numbers, bool is_planar, int measurement_count,
                        const py::object& averaged_before, const py::object& callback,
                        bool gives_stacks, const FilterFrame& filter) {
  const RawArray raw = view_raw(raw_numbers, is_planar, measurement_count, averaged_before);
  FilteredFrames filtered(measurement_count);
  without_gil(callback, [&](const Progress& progress) {
    const ProgressParts parts(progress, raw.frames.size());
    for (std::size_t f = 0; f < raw.frames.size(); ++f)
      if (const std::optional<RawView> frame = filter(raw.frames[f], parts[f]))
        filtered.add(*frame);
  });
  return filtered.arrays(!gives_stacks && raw.plane_shape().size() == 2);
}

py::tuple apply_filter(const BoundFilter& filter, const py::array& raw_numbers, bool is_planar,
                       const py::object& averaged, const py::object& callback) {
  std::unique_ptr<FramePipeline> pipeline;
  return filter_frames(raw_numbers, is_planar, filter.filter().measurements(), averaged, callback,
                       false,
                       [&](const RawView& raw, const Progress& progress) -> std::optional<RawView> {
                         if (!pipeline) pipeline = filter.pipeline(raw.height, raw.width);
                         pipeline->submit(raw);
                         return pipeline->numbers(progress);
                       });
}

py::tuple add_to_filter(TimeFilter& filter, const py::array& raw_numbers, bool is_planar,
                        const py::object& averaged, const py::object& callback) {
  return filter_frames(raw_numbers, is_planar, filter.measurements(), averaged, callback,
                       filter.options().look_ahead > 0,
                       [&](const RawView& raw, const Progress& progress) {
                         const std::optional<RawView> added = filter.add(raw);
                         report(progress, 1.0, "filtering");
                         return added;
                       });
}

py::tuple end_filter(TimeFilter& filter, const py::object& callback) {
  FilteredFrames filtered(filter.measurements());
  without_gil(callback, [&](const Progress& progress) {
    while (const std::optional<RawView> frame = filter.add_end()) {
      filtered.add(*frame);
      report(progress, 0.0, "filtering");
    }
  });
  return filtered.arrays(false);
}

py::tuple merge_frames(const DecodingTable& table, const py::array& raw_numbers, bool is_planar,
                       const py::object& averaged, const std::vector<double>& exposures) {
  const RawArray raw = view_raw(raw_numbers, is_planar, table.measurements(), averaged);
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
  py::class_<BoundFilter>(module, "Filter")
      .def(py::init(
          [](const DecodingTable& table, const py::dict& values, const std::string& device) {
            const FilterOptions options = filter_options(values);
            const py::gil_scoped_release release;
            return BoundFilter(Filter(table, options), device);
          }))
      .def("device", &BoundFilter::device)
      .def("table", [](const BoundFilter& bound) { return bound.filter().table(); })
      .def("options",
           [](const BoundFilter& bound) { return fields_dict(bound.filter().options()); })
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
      .def("end", &end_filter)
      .def("forget", &TimeFilter::forget);
  module.def("merge_exposures", &merge_frames);
  module.def("without_stray_light", &without_stray_light);
  module.def("filter_strengths", [] { return all_words<FilterStrength>; });
}

}  // namespace tofsmith::python
