// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <limits>
#include <nlohmann/json.hpp>
#include <optional>

#include "commands.hpp"
#include "described_options.hpp"
#include "help_pages.hpp"
#include "number_checks.hpp"
#include "python_module.hpp"
#include "session.hpp"
#include "tap_arguments.hpp"
#include "terminal_progress.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/io/camera_toml.hpp"
#include "tofsmith/io/code_file.hpp"
#include "tofsmith/io/decoding_table_file.hpp"
#include "tofsmith/waveforms/upload_script.hpp"

namespace tofsmith::apps {

namespace {

struct UploadArguments {
  std::string code, address, model, load = "50";
  CameraArguments camera;
  TapArguments taps;
  ExportOptions options;
  UploadRequest request;
  UploadSelection selection;
  double timeout_s = 5.0;
  bool dry_run = false;
};

void check_usage(const UploadArguments& arguments) {
  if (arguments.address.empty() && !arguments.dry_run)
    throw UsageError("found no --instrument; expected its address, such as 192.168.1.7");
  if (arguments.dry_run && arguments.model.empty())
    throw UsageError("--dry-run does not query the instrument; expected --model NAME");
  if (arguments.selection.light_channel == 0 && arguments.selection.sensor_channel == 0)
    throw UsageError(
        "found --channel-light 0 and --channel-sensor 0; expected at least one channel");
}

/// Converts failures to usage errors.
template <typename Function>
auto as_usage(Function function) {
  try {
    return function();
  } catch (const std::invalid_argument& error) {
    throw UsageError(error.what());
  }
}

double load_in(const std::string& text) {
  if (text == "inf") return std::numeric_limits<double>::infinity();
  double ohm = 0.0;
  if (!CLI::detail::lexical_cast(text, ohm))
    throw UsageError(fmt::format("--load: found {}; expected ohms, or inf", text));
  return ohm;
}

nlohmann::ordered_json channels_json(const UploadRequest& request) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const UploadChannel& channel : request.channels) {
    const QuantizedWaveform& w = channel.selected_waveform();
    nlohmann::ordered_json stored = nlohmann::ordered_json::array();
    for (const QuantizedWaveform& waveform : channel.stored) stored.push_back(waveform.name);
    json.push_back({{"channel", channel.channel},
                    {"arm", name_of(w.arm)},
                    {"waveform", w.name},
                    {"stored", std::move(stored)},
                    {"points", w.points()},
                    {"periods", w.periods},
                    {"sample_rate_hz", w.sample_rate_hz},
                    {"repetition_hz", w.repetition_hz()},
                    {"low_v", w.low_v},
                    {"high_v", w.high_v},
                    {"full_scale", w.full_scale}});
  }
  return json;
}

void show_dry_run(const UploadArguments& arguments, const CodeSet& code, const Camera& camera,
                  const Session& session) {
  const GeneratorModel model = as_usage([&] { return generator_model(arguments.model); });
  UploadRequest request = arguments.request;
  request.load_ohm = load_in(arguments.load);
  const WaveformExport exported =
      export_for_model(code, camera, model, arguments.options, request.true_arb);
  request.channels = as_usage([&] { return selected_channels(exported, arguments.selection); });
  const UploadScript script = upload_script(model, request);
  nlohmann::ordered_json messages = nlohmann::ordered_json::array();
  for (const UploadStep& step : script.steps)
    messages.push_back(
        {{"what", step.what}, {"message", step.message}, {"data_bytes", step.data.size()}});
  session.print_json({{"model", model.name},
                      {"dry_run", true},
                      {"channels", channels_json(request)},
                      {"messages", std::move(messages)}});
  std::string text = script_text(script);
  text.pop_back();
  session.say(text);
}

/// Adds the numbers and words of a struct to a JSON object.
template <typename Struct>
void add_fields(nlohmann::ordered_json& json, const Struct& its) {
  for_each_field(its, [&](const auto& field) {
    using Value = std::remove_cvref_t<decltype(field.value)>;
    if constexpr (HasWords<Value>) {
      json[field.name] = name_of(field.value);
    } else if constexpr (is_optional<Value>) {
      if (field.value) json[field.name] = *field.value;
    } else if constexpr (std::is_arithmetic_v<Value>) {
      json[field.name] = field.value;
    }
  });
}

/// Returns the arguments of upload() in python/tofsmith/instruments.py.
nlohmann::ordered_json upload_request(const UploadArguments& arguments, const CodeSet& code,
                                      const Camera& camera, const Session& session) {
  nlohmann::ordered_json tables,
      options = {{"address", arguments.address}, {"timeout_s", arguments.timeout_s}};
  if (!arguments.model.empty()) options["model"] = arguments.model;
  add_fields(tables, arguments.options);
  add_fields(options, arguments.selection);
  add_fields(options, arguments.request);
  options["tables"] = std::move(tables);
  options["load_ohm"] = arguments.load;  // JSON has no infinity
  return {{"code", code_to_json(code)},
          {"camera", camera_to_toml(camera)},
          {"json", session.json},
          {"quiet", is_progress_silent()},
          {"options", std::move(options)}};
}

void run(UploadArguments& arguments, const Session& session) {
  check_usage(arguments);
  load_in(arguments.load);
  if (!arguments.model.empty()) as_usage([&] { return generator_model(arguments.model); });
  const Camera camera = arguments.camera.load();
  require_no_measured_table(arguments.code);
  const CodeSet code = load_code(arguments.code, camera, arguments.taps.file_for({arguments.code}));
  if (arguments.dry_run) return show_dry_run(arguments, code, camera, session);
  const nlohmann::ordered_json request = upload_request(arguments, code, camera, session);
  run_python_module("tofsmith._upload_command",
                    request.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
}

void add_waveform_options(CLI::App& command, UploadArguments& arguments) {
  ExportOptions& options = arguments.options;
  const FieldOptions fields(command, options);
  fields.add("samples");
  fields.add("sample_rate_hz", "--rate");
  fields.add("edge_grid_s", "--edge-grid")->group(for_experts);
  fields.add("periods")->group(for_experts);
  add_volts_option(command, options);
  command.add_option("--load", arguments.load, "load impedance in ohms, or inf")
      ->capture_default_str();
  const FieldOptions selection(command, arguments.selection);
  selection.add("exposure");
  selection.add("tap");
  selection.add("all");
}

void add_family_options(CLI::App& command, UploadArguments& arguments) {
  const FieldOptions request(command, arguments.request);
  request.add("true_arb")->group(for_experts);
  request.add("wave_header")->group(for_experts);
  request.add("filter")->group(for_experts);
}

}  // namespace

void add_upload_command(CLI::App& app, Session& session) {
  auto arguments = std::make_shared<UploadArguments>();
  CLI::App* command = app.add_subcommand(
      "upload",
      "upload a code to a waveform generator over the network, and verify it by reading it back");
  command->add_option("CODE", arguments->code, "family or code file (.code.json .npz .csv)")
      ->required();
  command->add_option(
      "--instrument", arguments->address,
      "host or host:port (default: port 5025), vxi11://host, or a VISA resource name such as "
      "USB0::...::INSTR");
  const FieldOptions selection(*command, arguments->selection);
  selection.add("light_channel", "--channel-light");
  selection.add("sensor_channel", "--channel-sensor");
  arguments->camera.add_to(*command);
  arguments->taps.add_to(*command);
  add_waveform_options(*command, *arguments);
  command->add_option("--model", arguments->model,
                      "model to assume for the instrument, such as SDG2042X, 33522 or AFG3022");
  add_family_options(*command, *arguments);
  command->add_option("--timeout", arguments->timeout_s, "timeout for a reply [s]")
      ->check(positive_number(3600.0))
      ->capture_default_str()
      ->group(for_experts);
  const FieldOptions request(*command, arguments->request);
  request.add("read_back", "!--no-read-back")->group(for_experts);
  request.add("reset", "!--no-reset")->group(for_experts);
  request.add("output_on");
  command->add_flag("--dry-run", arguments->dry_run,
                    "print the commands for --model without connecting");
  command->callback([arguments, &session] { run(*arguments, session); });
}

}  // namespace tofsmith::apps
