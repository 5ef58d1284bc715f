// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <pybind11/stl.h>

#include "bindings.hpp"
#include "export_options.hpp"
#include "options.hpp"
#include "progress.hpp"
#include "tofsmith/instrument/upload.hpp"

namespace tofsmith::python {

namespace {

/// Which code goes to the generator, and its settings.
struct UploadOptions {
  UploadSelection selection;
  UploadRequest request;
  ExportOptions tables;
};

UploadOptions upload_options(const py::dict& values) {
  UploadOptions options;
  OptionReader reader(values, "");
  reader.fields(options.selection)
      .fields(options.request, {"filter"})
      .word("filter", options.request.filter, parse_output_filter);
  options.tables = export_options("", reader.table("tables"));
  reader.finish();
  options.selection.validate();
  return options;
}

UploadRequest request_for(const CodeSet& code, const Camera& camera, const GeneratorModel& model,
                          const UploadOptions& options) {
  UploadRequest request = options.request;
  request.channels = selected_channels(
      export_for_model(code, camera, model, options.tables, request.true_arb), options.selection);
  return request;
}

py::dict model_dict(const GeneratorModel& model) {
  py::dict dict;
  dict["name"] = model.name;
  dict["vendor"] = model.vendor;
  dict["format"] = model.format();
  dict["channels"] = model.channels;
  dict["sample_rate_hz"] = model.sample_rate_hz;
  dict["max_repetition_hz"] = model.max_repetition_hz;
  dict["true_arb_rate_hz"] = model.true_arb_rate_hz;
  dict["min_points"] = model.min_points;
  dict["max_points"] = model.max_points;
  dict["memories"] = model.memories;
  dict["min_vpp"] = model.min_vpp;
  dict["max_vpp"] = model.max_vpp;
  return dict;
}

py::list channel_list(const UploadRequest& request) {
  py::list channels;
  for (const UploadChannel& channel : request.channels) {
    const QuantizedWaveform& actual = channel.selected_waveform();
    py::dict dict;
    dict["channel"] = channel.channel;
    dict["arm"] = name_of(actual.arm);
    dict["plays"] = actual.name;
    py::list stored;
    for (const QuantizedWaveform& waveform : channel.stored) stored.append(waveform.name);
    dict["stored"] = stored;
    dict["points"] = actual.points();
    dict["periods"] = actual.periods;
    dict["sample_rate_hz"] = actual.sample_rate_hz;
    dict["repetition_hz"] = actual.repetition_hz();
    dict["low_v"] = actual.low_v;
    dict["high_v"] = actual.high_v;
    channels.append(dict);
  }
  return channels;
}

py::dict script(const CodeSet& code, const Camera& camera, const std::string& model_name,
                const py::dict& values) {
  const GeneratorModel& model = generator_model(model_name);
  const UploadRequest request = request_for(code, camera, model, upload_options(values));
  const UploadScript script = upload_script(model, request);
  py::list messages;
  for (const UploadStep& step : script.steps) {
    py::dict dict;
    dict["what"] = step.what;
    dict["message"] = step.message;
    dict["data"] = py::bytes(step.data);
    messages.append(dict);
  }
  py::dict dict;
  dict["model"] = model.name;
  dict["messages"] = messages;
  dict["channels"] = channel_list(request);
  dict["outputs_off"] = script.outputs_off;
  dict["cannot_be_read_back"] = script.cannot_be_read_back;
  dict["text"] = script_text(script);
  return dict;
}

/// An upload that ended well.
struct Uploaded {
  InstrumentIdentity identity;
  std::string treated_as;
  UploadRequest request;
  UploadReport report;
};

Uploaded upload_code(const CodeSet& code, const Camera& camera, const InstrumentAddress& address,
                     const std::optional<std::string>& model_name, double timeout_s,
                     const UploadOptions& options, const Progress& progress) {
  double done = 0.0;
  const Progress observer = [&](double fraction, std::string_view step) {
    done = fraction;
    return progress(fraction, step);
  };
  const StopCheck check_stop = [&] {
    if (!progress(done, "waiting for the instrument")) throw Interrupted();
  };
  ScpiSession session(connect_instrument(address, timeout_s, check_stop), timeout_s, check_stop);
  Uploaded uploaded{.identity = identify(session)};
  const GeneratorModel& model = model_name ? generator_model(*model_name)
                                           : identified_model(uploaded.identity, session.name());
  uploaded.treated_as = model.name;
  uploaded.request = request_for(code, camera, model, options);
  uploaded.report = upload(session, upload_script(model, uploaded.request), observer);
  return uploaded;
}

py::dict uploaded_dict(const Uploaded& uploaded, const InstrumentAddress& address) {
  py::list steps, numbers;
  for (const UploadedStep& step : uploaded.report.steps)
    steps.append(py::make_tuple(step.what, step.sent, step.answer));
  for (const ReadBackNumber& number : uploaded.report.numbers) {
    py::dict dict;
    dict["channel"] = number.channel;
    dict["quantity"] = number.quantity;
    dict["requested"] = number.requested;
    dict["read_back"] = number.read_back;
    numbers.append(dict);
  }
  py::dict dict;
  dict["address"] = address.text();
  dict["vendor"] = uploaded.identity.vendor;
  dict["model"] = uploaded.identity.model;
  dict["serial"] = uploaded.identity.serial;
  dict["firmware"] = uploaded.identity.firmware;
  dict["treated_as"] = uploaded.treated_as;
  dict["verified"] = uploaded.report.verified;
  dict["message"] = uploaded.report.message;
  dict["channels"] = channel_list(uploaded.request);
  dict["numbers"] = numbers;
  dict["steps"] = steps;
  return dict;
}

}  // namespace

void bind_instrument(py::module_& module) {
  module.def("generator_models", [] {
    py::list models;
    for (const GeneratorModel& model : generator_models()) models.append(model_dict(model));
    return models;
  });
  module.def("upload_script", &script);
  module.def("upload", [](const CodeSet& code, const Camera& camera, const std::string& address,
                          const std::optional<std::string>& model, double timeout_s,
                          const py::dict& values, const py::object& callback) {
    const InstrumentAddress place = parse_instrument_address(address);
    if (model) static_cast<void>(generator_model(*model));  // refused before anything is sent
    const UploadOptions options = upload_options(values);
    const Uploaded uploaded = without_gil(callback, [&](const Progress& progress) {
      return upload_code(code, camera, place, model, timeout_s, options, progress);
    });
    return uploaded_dict(uploaded, place);
  });
}

}  // namespace tofsmith::python
