// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <pybind11/stl.h>

#include <filesystem>

#include "bindings.hpp"
#include "export_options.hpp"
#include "options.hpp"
#include "output_policy.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/io/atomic_file.hpp"

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

/// The tables, and the manifest last.
std::vector<ExportedFile> all_files(const WaveformExport& exported) {
  std::vector<ExportedFile> files = export_files(exported);
  const std::string manifest = export_manifest(exported, files);
  const auto* const bytes = reinterpret_cast<const std::byte*>(manifest.data());
  files.push_back({"manifest.json", {bytes, bytes + manifest.size()}, {}});
  return files;
}

py::tuple write_export(const CodeSet& code, const Camera& camera, const std::string& directory,
                       const std::string& format, const py::dict& values, bool overwrite) {
  const ExportOptions options = export_options(format, values);
  const CodeSet resampled = code.resampled(camera.samples);
  const Camera actual = exporting_camera(resampled, camera, options);
  const std::vector<ExportedFile> files = all_files(export_waveforms(resampled, actual, options));
  const std::filesystem::path folder = directory;
  make_output_directory(folder);
  std::vector<std::string> names;
  for (const ExportedFile& file : files) {
    if (!overwrite && std::filesystem::exists(folder / file.name))
      throw IoError((folder / file.name).string(),
                    "the file exists already; choose another directory or pass overwrite=True");
    names.push_back(file.name);
  }
  for (const ExportedFile& file : files)
    write_file_atomically(folder / file.name, file.bytes, policy_of(overwrite));
  const std::vector<std::byte>& manifest = files.back().bytes;
  return py::make_tuple(actual, names,
                        py::str(reinterpret_cast<const char*>(manifest.data()), manifest.size()));
}

}  // namespace

void bind_export(py::module_& module) {
  module.def("waveform_formats", [] {
    py::list formats;
    for (const WaveformFormat& format : waveform_formats()) formats.append(format_dict(format));
    return formats;
  });
  module.def("export_waveforms", &write_export);
}

}  // namespace tofsmith::python
