// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <pybind11/stl.h>

#include <map>
#include <memory>
#include <optional>

#include "arrays.hpp"
#include "bindings.hpp"
#include "bound_filter.hpp"
#include "file_objects.hpp"
#include "options.hpp"
#include "progress.hpp"
#include "reports.hpp"
#include "tofsmith/decode/decoding_table.hpp"
#include "tofsmith/decode/depth_image.hpp"
#include "tofsmith/gpu.hpp"
#include "tofsmith/io/decode_recording.hpp"
#include "tofsmith/io/decoding_table_file.hpp"

namespace tofsmith::python {

namespace {

std::unique_ptr<FrameBackend> backend_of(const DecodingTable& table, const py::dict& values) {
  DecodeMethod method = DecodeMethod::zncc;
  DecodeOptions options;
  UnwrapWeights weights = UnwrapWeights::variance;
  std::string device = "cpu";
  OptionReader reader(values, "");
  reader.value("device", device)
      .word("method", method, parse_decode_method)
      .word("unwrap_weights", weights, parse_unwrap_weights)
      .fields(options);
  const MultipathOptions multipath =
      multipath_options(reader.table("multipath"), "multipath", table.range_m);
  reader.finish();
  const py::gil_scoped_release release;
  return frame_backend(device, make_decoder(method, table, options, weights, multipath));
}

/// The planes of a stack of frames, in arrays allocated by Python.
class Planes {
 public:
  Planes(const py::dict& arrays, const RawArray& raw) : shape_(raw.plane_shape()) {
    for (const PlaneDescription& described : plane_descriptions)
      with_plane(
          described.plane, [&](auto*& plane) { take(arrays, described.member, plane); }, view_);
  }
  const DecodedView& view() const { return view_; }

 private:
  template <typename Item>
  void take(const py::dict& arrays, std::string_view member, Item*& plane) {
    const std::string name(member);
    if (!arrays.contains(name)) return;
    using Stored = std::conditional_t<std::is_enum_v<Item>, std::uint8_t, Item>;
    const py::dtype needs = py::dtype::of<Stored>();
    const std::string argument = "out." + name;
    const py::array array = arrays[py::str(name)];
    if (!array.dtype().is(needs) && !array.dtype().equal(needs))
      refuse(argument, "dtype " + std::string(py::str(static_cast<py::handle>(array.dtype()))),
             std::string(py::str(static_cast<py::handle>(needs))));
    if (std::vector<py::ssize_t>(array.shape(), array.shape() + array.ndim()) != shape_)
      refuse(argument, "shape " + shape_of(array),
             "shape " + std::string(py::str(py::tuple(py::cast(shape_)))));
    if ((array.flags() & py::array::c_style) == 0)
      refuse(argument, "an array with gaps or of another order", "C order without gaps");
    if (!array.writeable()) refuse(argument, "a read-only array", "one that can be written");
    plane = reinterpret_cast<Item*>(const_cast<void*>(array.data()));
  }

  std::vector<py::ssize_t> shape_;
  DecodedView view_;
};

PixelMaps maps_of(const py::object& delay_offset_m, const py::object& gain, const RawArray& raw) {
  PixelMaps maps{to_image(delay_offset_m, "delay_offset_m"), to_image(gain, "gain")};
  maps.validate(raw.height, raw.width);
  return maps;
}

void decode(const FrameBackend& backend, const py::array& raw_numbers, bool is_planar,
            const py::dict& arrays, const py::object& averaged, const py::object& delay_offset_m,
            const py::object& gain, const std::string& mixed, std::optional<double> min_depth_m,
            std::optional<double> max_depth_m, const BoundFilter* filter,
            const py::object& callback) {
  const DecodingTable& table = backend.decoder().table();
  const RawArray raw = view_raw(raw_numbers, is_planar, table.measurements(), averaged);
  const Planes planes(arrays, raw);
  PlaneCorrections corrections{maps_of(delay_offset_m, gain, raw), std::nullopt,
                               depth_limits(table, min_depth_m, max_depth_m)};
  if (!mixed.empty()) corrections.mixed = parse_word<MixedPixels>("mixed", mixed);
  without_gil(callback, [&](const Progress& progress) {
    const auto pixels = static_cast<std::size_t>(raw.frames.front().pixels());
    const ProgressParts parts(progress, raw.frames.size());
    const std::unique_ptr<FramePipeline> pipeline =
        backend.prepare({.filter = filter ? &filter->filter() : nullptr,
                         .keeps_filtered = must_keep_filtered(corrections, planes.view().planes())},
                        raw.height, raw.width);
    for (std::size_t f = 0; f < raw.frames.size(); ++f) {
      pipeline->submit(raw.frames[f]);
      decode_frame(*pipeline, corrections, 0, raw.height, planes.view().from(f * pixels), parts[f]);
    }
  });
}

DecodeRequest request_of(const std::vector<std::string>& raw, const std::string& output,
                         const py::object& lens, const py::dict& values) {
  DecodeRequest request;
  std::filesystem::path rays;
  bool overwrite = false;
  OptionReader reader(values, "");
  reader.fields(request, {"time_filter", "filter"})
      .value("other_inputs", request.other_inputs)
      .value("overwrite", overwrite)
      .path("rays", rays);
  if (const py::dict filter = reader.table("filter"); !filter.empty())
    request.filter = filter_options(filter);
  if (const py::dict filter = reader.table("time_filter"); !filter.empty())
    request.time_filter = time_filter_options(filter);
  reader.finish();
  request.raw.assign(raw.begin(), raw.end());
  request.output = output;
  request.policy = policy_of(overwrite);
  if (!rays.empty())
    request.lens = Lens{.rays = rays};
  else if (!request.view_deg)
    request.lens = to_optional_lens(lens);
  return request;
}

std::map<std::string, std::int64_t> counts_of(const StatusCounts& statuses) {
  std::map<std::string, std::int64_t> counts;
  for (const PixelStatus status : all_pixel_statuses)
    counts.emplace(name_of(status), statuses.of(status));
  return counts;
}

py::dict decode_a_recording(const FrameBackend& backend, const std::vector<std::string>& raw,
                            const std::string& output, const py::object& lens,
                            const py::dict& values, const py::object& callback) {
  const DecodeRequest request = request_of(raw, output, lens, values);
  const DecodedRecording result = without_gil(callback, [&](const Progress& progress) {
    return decode_recording(request, backend, progress);
  });
  std::vector<std::string> files, outputs;
  for (const std::filesystem::path& file : result.files) files.push_back(file.string());
  for (const DecodedPlane plane : result.outputs) outputs.emplace_back(name_of(plane));
  py::list frames;
  for (const StatusCounts& frame : result.frames) frames.append(counts_of(frame));
  py::dict dict;
  dict["height"] = result.height;
  dict["width"] = result.width;
  dict["measurements"] = result.measurements;
  dict["first_frame"] = result.first_frame;
  dict["outputs"] = outputs;
  dict["files"] = files;
  dict["frames"] = frames;
  dict["seconds"] = result.seconds;
  dict["notes"] = result.notes;
  return dict;
}

py::dict decode_a_stream(const FrameBackend& backend, const py::object& source,
                         const py::object& take, const py::object& write, const py::object& lens,
                         const py::dict& values, const py::object& callback) {
  const DecodeRequest request = request_of({}, "", lens, values);
  DecodedStream result;
  FrameSink sink(take, write,
                 request.outputs.empty() ? std::vector{DecodedPlane::depth} : request.outputs,
                 result);
  without_gil(callback, [&](const Progress& progress) {
    try {
      decode_stream(request, backend, reading_from(source), sink.stream(), progress, result);
    } catch (const FrameSink::Stopped&) {
      ++result.frames;  // this frame was taken
    }
  });
  py::dict dict;
  dict["height"] = result.height;
  dict["width"] = result.width;
  dict["frames"] = result.frames;
  dict["statuses"] = counts_of(result.statuses);
  dict["seconds"] = result.seconds;
  return dict;
}

py::array_t<double> decode_depth_bins(const FrameBackend& backend, const Floats& measurements) {
  const DepthDecoder& decoder = backend.decoder();
  const int needed = decoder.table().measurements();
  if (measurements.ndim() != 2 || measurements.shape(1) != needed)
    refuse("measurements", "shape " + shape_of(measurements),
           "(pixels, " + std::to_string(needed) + ")");
  std::vector<double> depth_bin(static_cast<std::size_t>(measurements.shape(0)));
  {
    const py::gil_scoped_release release;
    decoder.decode_depth_bins(measurements.data(), measurements.shape(0), depth_bin.data());
  }
  return adopt(std::move(depth_bin));
}

DecodingTable measured_table(const Doubles& correlation, const Camera& camera,
                             const py::dict& values) {
  MeasuredTable measured;
  measured.correlation = to_matrix(correlation, "correlation");
  std::string ambient;
  OptionReader reader(values, "");
  reader.value("taps", measured.taps).value("ambient", ambient).value("range_m", measured.range_m);
  reader.finish();
  if (!ambient.empty())
    measured.ambient_gain = ambient_gain_of(measured.correlation, parse_measured_ambient(ambient));
  return make_decoding_table(measured, camera);
}

py::tuple load_table(const std::string& code, const Camera& camera, const py::dict& values) {
  DecodingTableOptions options;
  OptionReader(values, "").fields(options.file).fields(options).finish();
  LoadedDecodingTable loaded = load_decoding_table(code, camera, options);
  return py::make_tuple(std::move(loaded.table), loaded.name, loaded.notes);
}

void bind_table(py::module_& module) {
  module.def("load_decoding_table", &load_table);
  py::class_<DecodingTable>(module, "DecodingTable")
      .def_static("of_code",
                  [](const CodeSet& code, const Camera& camera) {
                    return make_decoding_table(ForwardModel(code, camera), camera);
                  })
      .def_static("of_measured", &measured_table)
      .def_static("of_correlation",
                  [](const Doubles& correlation, double range_m) {
                    DecodingTable table =
                        make_decoding_table(to_matrix(correlation, "correlation"), range_m);
                    table.validate();
                    return table;
                  })
      .def("correlation",
           [](const DecodingTable& t) { return adopt(Eigen::MatrixXd(t.correlation)); })
      .def("ambient_gain",
           [](const DecodingTable& t) { return adopt(Eigen::VectorXd(t.ambient_gain)); })
      .def("exposure_s",
           [](const DecodingTable& t) { return adopt(Eigen::VectorXd(t.exposure_s)); })
      .def("range_m", [](const DecodingTable& t) { return t.range_m; })
      .def("ambiguous_depths", [](const DecodingTable& table) {
        const std::vector<AmbiguousDepths> pairs = ambiguous_depths(table);
        Eigen::MatrixXd depths_m(static_cast<Eigen::Index>(pairs.size()), 2);
        for (std::size_t i = 0; i < pairs.size(); ++i)
          depths_m.row(static_cast<Eigen::Index>(i)) << pairs[i].first_m, pairs[i].second_m;
        return adopt(std::move(depths_m));
      });
}

}  // namespace

void bind_decode(py::module_& module) {
  bind_table(module);
  py::class_<FrameBackend>(module, "Decoder")
      .def(py::init(&backend_of))
      .def("device", &FrameBackend::device)
      .def("table", [](const FrameBackend& backend) { return backend.decoder().table(); })
      .def("decode", &decode)
      .def("decode_recording", &decode_a_recording)
      .def("decode_stream", &decode_a_stream)
      .def("decode_depth_bins", &decode_depth_bins);
  module.def("decode_methods", [] { return all_words<DecodeMethod>; });
  module.def("mixed_pixels", [] { return all_words<MixedPixels>; });
}

}  // namespace tofsmith::python
