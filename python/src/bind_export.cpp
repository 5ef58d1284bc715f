// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <pybind11/stl.h>

#include <filesystem>

#include "bindings.hpp"
#include "export_options.hpp"
#include "options.hpp"
#include "output_policy.hpp"
#include "tofsmith/waveforms/write_export.hpp"

namespace tofsmith::python {

ExportOptions export_options(const std::string& format, const py::dict& values) {
  ExportOptions options;
  options.format = format;
  OptionReader(values, "").fields(options, {"format"}).finish();
  return options;
}

namespace {

py::dict format_dict(const WaveformFormat& format) {
  std::vector<std::string> variants;
  for (const FormatVariant& variant : format.variants) variants.push_back(variant.name);
  py::dict dict;
  dict["name"] = format.name;
  dict["extension"] = format.extension;
  dict["description"] = format.description;
  dict["min_points"] = format.min_points;
  dict["max_points"] = format.max_points;
  dict["multiple_of"] = format.multiple_of;
  dict["max_bits"] = format.max_bits;
  dict["variants"] = variants;
  return dict;
}

py::tuple write(const CodeSet& code, const Camera& camera, const std::string& output,
                const std::string& format, const py::dict& values, bool overwrite) {
  const ExportedCode exported = write_export(code, camera,
                                             {.options = export_options(format, values),
                                              .output = output,
                                              .policy = policy_of(overwrite)});
  std::vector<std::string> files;
  for (const std::filesystem::path& file : exported.files) files.push_back(file.string());
  return py::make_tuple(exported.actual, files, exported.manifest, exported.notes);
}

}  // namespace

void bind_export(py::module_& module) {
  module.def("waveform_formats", [] {
    py::list formats;
    for (const WaveformFormat& format : waveform_formats()) formats.append(format_dict(format));
    return formats;
  });
  module.def("export_waveforms", &write);
}

}  // namespace tofsmith::python
