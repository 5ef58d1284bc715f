// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <pybind11/stl.h>

#include <array>
#include <filesystem>

#include "bindings.hpp"
#include "options.hpp"
#include "tofsmith/waveforms/upload_script.hpp"
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

/// Selects the waveforms of a code, and sets up the generator.
struct UploadOptions {
  UploadSelection selection;
  UploadRequest request;
  ExportOptions tables;
};

UploadOptions upload_options(const py::dict& values) {
  UploadOptions options;
  OptionReader reader(values, "");
  reader.fields(options.selection).fields(options.request);
  options.tables = export_options("", reader.table("tables"));
  reader.finish();
  options.selection.validate();
  return options;
}

UploadScript script(const CodeSet& code, const Camera& camera, const std::string& model_name,
                    const py::dict& values) {
  const GeneratorModel& model = generator_model(model_name);
  UploadOptions options = upload_options(values);
  options.request.channels = selected_channels(
      export_for_model(code, camera, model, options.tables, options.request.true_arb),
      options.selection);
  return upload_script(model, options.request);
}

const char* name_of(UploadStep::Answer answer) {
  static constexpr std::array names = {"none", "line", "block", "arb_file", "wave_data"};
  return names.at(static_cast<std::size_t>(answer));
}

void bind_model(py::module_& module) {
  py::class_<GeneratorModel>(
      module, "GeneratorModel",
      "Properties of a generator, from its data sheet: sample rate, repetitions of a table per "
      "second\n(0: limited by the sample rate), sample rate without skipping points (0: not "
      "supported), points\nof a table, tables at a time (0: as many as fit), amplitude into 50 ohm "
      "[V]. format is the name\nof its format in waveform_formats().")
      .def_readonly("name", &GeneratorModel::name)
      .def_readonly("vendor", &GeneratorModel::vendor)
      .def_property_readonly("format", &GeneratorModel::format)
      .def_property_readonly("has_error_queue", &GeneratorModel::has_error_queue)
      .def_readonly("channels", &GeneratorModel::channels)
      .def_readonly("sample_rate_hz", &GeneratorModel::sample_rate_hz)
      .def_readonly("max_repetition_hz", &GeneratorModel::max_repetition_hz)
      .def_readonly("true_arb_rate_hz", &GeneratorModel::true_arb_rate_hz)
      .def_readonly("min_points", &GeneratorModel::min_points)
      .def_readonly("max_points", &GeneratorModel::max_points)
      .def_readonly("memories", &GeneratorModel::memories)
      .def_readonly("min_vpp", &GeneratorModel::min_vpp)
      .def_readonly("max_vpp", &GeneratorModel::max_vpp);
}

/// Binds a property of the waveform of a channel.
template <typename Of>
auto of_waveform(Of property) {
  return [property](const UploadChannel& channel) {
    return std::invoke(property, channel.selected_waveform());
  };
}

void bind_channel(py::module_& module) {
  py::class_<UploadChannel>(module, "UploadChannel",
                            "Waveforms of a channel: names of the `stored` tables and of the "
                            "selected `waveform`, with its\n"
                            "arm (light or sensor), points, periods, rates, voltages and "
                            "full_scale (the value at high_v).")
      .def_readonly("channel", &UploadChannel::channel)
      .def_property_readonly("arm",
                             of_waveform([](const auto& w) { return tofsmith::name_of(w.arm); }))
      .def_property_readonly("waveform", of_waveform(&QuantizedWaveform::name))
      .def_property_readonly("stored",
                             [](const UploadChannel& channel) {
                               std::vector<std::string> names;
                               for (const QuantizedWaveform& waveform : channel.stored)
                                 names.push_back(waveform.name);
                               return names;
                             })
      .def_property_readonly("points", of_waveform(&QuantizedWaveform::points))
      .def_property_readonly("periods", of_waveform(&QuantizedWaveform::periods))
      .def_property_readonly("sample_rate_hz", of_waveform(&QuantizedWaveform::sample_rate_hz))
      .def_property_readonly("repetition_hz", of_waveform(&QuantizedWaveform::repetition_hz))
      .def_property_readonly("low_v", of_waveform(&QuantizedWaveform::low_v))
      .def_property_readonly("high_v", of_waveform(&QuantizedWaveform::high_v))
      .def_property_readonly("full_scale", of_waveform(&QuantizedWaveform::full_scale));
}

void bind_step(py::module_& module) {
  py::class_<AnswerCheck>(module, "AnswerCheck", "Expected content of an answer.")
      .def_readonly("channel", &AnswerCheck::channel)
      .def_readonly("quantity", &AnswerCheck::quantity)
      .def_readonly("field", &AnswerCheck::field)
      .def_readonly("wanted", &AnswerCheck::wanted)
      .def_readonly("tolerance", &AnswerCheck::tolerance)
      .def_readonly("texts", &AnswerCheck::texts)
      .def_readonly("within", &AnswerCheck::within);
  py::class_<UploadStep>(module, "UploadStep",
                         "A message: its purpose (what), its text, the data that follow it, and "
                         "the expected answer.")
      .def_readonly("what", &UploadStep::what)
      .def_readonly("message", &UploadStep::message)
      .def_property_readonly("data", [](const UploadStep& step) { return py::bytes(step.data); })
      .def_readonly("line_end", &UploadStep::line_end)
      .def_readonly("switches_on", &UploadStep::switches_on)
      .def_property_readonly("answer", [](const UploadStep& step) { return name_of(step.answer); })
      .def_readonly("checks", &UploadStep::checks)
      .def_property_readonly("expected",
                             [](const UploadStep& step) { return py::bytes(step.expected); })
      .def_readonly("more_s", &UploadStep::more_s)
      .def_readonly("pause_s", &UploadStep::pause_s);
}

void bind_script(py::module_& module) {
  py::class_<UploadScript>(
      module, "UploadScript",
      "All messages of one upload, in order; str() is the text of `tofsmith upload --dry-run`.\n"
      "outputs_off are the messages that switch the outputs off; reads_back: all points are "
      "compared;\ncannot_be_read_back: what no answer confirms.")
      .def_readonly("model", &UploadScript::model)
      .def_readonly("channels", &UploadScript::channels)
      .def_readonly("steps", &UploadScript::steps)
      .def_readonly("outputs_off", &UploadScript::outputs_off)
      .def_readonly("reads_back", &UploadScript::reads_back)
      .def_readonly("cannot_be_read_back", &UploadScript::cannot_be_read_back)
      .def("__str__", &script_text);
}

}  // namespace

void bind_export(py::module_& module) {
  module.def("waveform_formats", [] {
    py::list formats;
    for (const WaveformFormat& format : waveform_formats()) formats.append(format_dict(format));
    return formats;
  });
  module.def("export_waveforms", &write);
  bind_model(module);
  bind_channel(module);
  bind_step(module);
  bind_script(module);
  module.def("generator_models", &generator_models, "All supported models.");
  module.def("generator_model", &generator_model);
  module.def("upload_script", &script);
}

}  // namespace tofsmith::python
