// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <limits>
#include <nlohmann/json.hpp>
#include <optional>

#include "commands.hpp"
#include "help_pages.hpp"
#include "interrupt.hpp"
#include "number_checks.hpp"
#include "session.hpp"
#include "tap_arguments.hpp"
#include "terminal_progress.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/instrument/upload.hpp"
#include "tofsmith/io/decoding_table_file.hpp"

namespace tofsmith::apps {

namespace {

struct UploadArguments {
  std::string code, address, model, load = "50", filter = "step", header = "length";
  CameraArguments camera;
  TapArguments taps;
  ExportOptions options;
  UploadRequest request;
  UploadSelection selection;
  std::vector<double> volts;
  double timeout_s = 5.0;
  bool dry_run = false, no_read_back = false, no_reset = false;
};

void check_usage(const UploadArguments& arguments) {
  if (arguments.address.empty() && !arguments.dry_run)
    throw UsageError("found no --instrument; expected its address, such as 192.168.1.7");
  if (arguments.dry_run && arguments.model.empty())
    throw UsageError("--dry-run asks no instrument what it is; expected --model NAME with it");
  if (arguments.selection.light_channel == 0 && arguments.selection.sensor_channel == 0)
    throw UsageError("found --channel-light 0 and --channel-sensor 0; expected one to play");
}

/// A usage error instead of a failure.
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

WaveformExport exported_for(const UploadArguments& arguments, const GeneratorModel& model) {
  ExportOptions options = arguments.options;
  if (!arguments.volts.empty()) {
    options.low_v = arguments.volts[0];
    options.high_v = arguments.volts[1];
  }
  const Camera camera = arguments.camera.load();
  require_no_measured_table(arguments.code);
  return export_for_model(load_code(arguments.code, camera, arguments.taps.file_options()), camera,
                          model, options, arguments.request.true_arb);
}

/// What the channels get: of one exposure, or of all with one selected.
UploadRequest request_for(const UploadArguments& arguments, const WaveformExport& exported) {
  UploadRequest request = arguments.request;
  request.load_ohm = load_in(arguments.load);
  request.read_back = !arguments.no_read_back;
  request.reset = !arguments.no_reset;
  request.filter = parse_output_filter(arguments.filter);
  request.wave_header = parse_wave_header(arguments.header);
  request.channels = as_usage([&] { return selected_channels(exported, arguments.selection); });
  return request;
}

nlohmann::ordered_json channels_json(const UploadRequest& request, const UploadReport& report) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const UploadChannel& channel : request.channels) {
    const QuantizedWaveform& w = channel.selected_waveform();
    nlohmann::ordered_json stored = nlohmann::ordered_json::array(), numbers;
    for (const QuantizedWaveform& waveform : channel.stored) stored.push_back(waveform.name);
    for (const ReadBackNumber& number : report.numbers)
      if (number.channel == channel.channel)
        numbers[number.quantity] = {{"requested", number.requested},
                                    {"read_back", number.read_back}};
    json.push_back({{"channel", channel.channel},
                    {"arm", name_of(w.arm)},
                    {"plays", w.name},
                    {"stored", std::move(stored)},
                    {"points", w.points()},
                    {"periods", w.periods},
                    {"sample_rate_hz", w.sample_rate_hz},
                    {"repetition_hz", w.repetition_hz()},
                    {"low_v", w.low_v},
                    {"high_v", w.high_v},
                    {"full_scale", w.full_scale},
                    {"numbers", std::move(numbers)}});
  }
  return json;
}

std::vector<std::vector<std::string>> channel_rows(const UploadRequest& request) {
  std::vector<std::vector<std::string>> rows = {
      {"channel", "plays", "points", "periods", "clock [MHz]", "low [V]", "high [V]"}};
  for (const UploadChannel& channel : request.channels) {
    const QuantizedWaveform& w = channel.selected_waveform();
    rows.push_back({fmt::format("{}", channel.channel), w.name, fmt::format("{}", w.points()),
                    fmt::format("{}", w.periods), fmt::format("{:.6g}", w.sample_rate_hz / 1e6),
                    fmt::format("{:.4g}", w.low_v), fmt::format("{:.4g}", w.high_v)});
  }
  return rows;
}

void show_dry_run(const UploadArguments& arguments, const Session& session) {
  const GeneratorModel model = as_usage([&] { return generator_model(arguments.model); });
  const UploadRequest request = request_for(arguments, exported_for(arguments, model));
  const UploadScript script = upload_script(model, request);
  nlohmann::ordered_json messages = nlohmann::ordered_json::array();
  for (const UploadStep& step : script.steps)
    messages.push_back(
        {{"what", step.what}, {"message", step.message}, {"data_bytes", step.data.size()}});
  session.print_json({{"model", model.name},
                      {"dry_run", true},
                      {"channels", channels_json(request, {})},
                      {"messages", std::move(messages)}});
  std::string text = script_text(script);
  text.pop_back();
  session.say(text);
}

void run(const UploadArguments& arguments, Session& session) {
  check_usage(arguments);
  if (arguments.dry_run) return show_dry_run(arguments, session);
  const InstrumentAddress address =
      as_usage([&] { return parse_instrument_address(arguments.address); });
  const std::optional<GeneratorModel> given =
      arguments.model.empty()
          ? std::nullopt
          : std::optional(as_usage([&] { return generator_model(arguments.model); }));
  const StopCheck check_stop = [] {
    if (interrupted()) throw Interrupted();
  };
  ScpiSession scpi(connect_instrument(address, arguments.timeout_s, check_stop),
                   arguments.timeout_s, check_stop);
  const InstrumentIdentity identity = identify(scpi);
  const GeneratorModel& model = given ? *given : identified_model(identity, scpi.name());
  const UploadRequest request = request_for(arguments, exported_for(arguments, model));
  const UploadScript script = upload_script(model, request);
  session.tells_what_is_kept = true;  // an instrument keeps its last settings
  const UploadReport report = upload(scpi, script, terminal_progress("uploading"));

  nlohmann::ordered_json steps = nlohmann::ordered_json::array();
  for (const UploadedStep& step : report.steps)
    steps.push_back({{"what", step.what}, {"sent", step.sent}, {"answer", step.answer}});
  session.print_json({{"instrument",
                       {{"address", address.text()},
                        {"vendor", identity.vendor},
                        {"model", identity.model},
                        {"serial", identity.serial},
                        {"firmware", identity.firmware},
                        {"treated_as", model.name}}},
                      {"verified", report.verified},
                      {"message", report.message},
                      {"output_on", request.output_on},
                      {"channels", channels_json(request, report)},
                      {"steps", std::move(steps)}});
  session.say(fmt::format("{} {} {} at {}:\n{}", identity.vendor, identity.model, identity.serial,
                          address.text(), text_table(channel_rows(request))));
  session.say(fmt::format("{}.\nOutputs are {}.", report.message,
                          request.output_on ? "on" : "off (--output-on switches them on)"));
}

void add_waveform_options(CLI::App& command, UploadArguments& arguments) {
  ExportOptions& options = arguments.options;
  command.add_option("--samples", options.samples, "points of the table that holds one period");
  command
      .add_option("--rate", options.sample_rate_hz, "most points per second [1/s] (the model's)")
      ->check(positive_number());
  command
      .add_option("--edge-grid", options.edge_grid_s,
                  "on and off switch at multiples of this time only [s]")
      ->check(positive_number())
      ->group(for_experts);
  command.add_option("--periods", options.periods, "periods in a table (as few as fit)")
      ->group(for_experts);
  command
      .add_option("--volts", arguments.volts,
                  "LOW,HIGH: output at no light and no gain, and at peak light and full gain [V] "
                  "(0,1)")
      ->delimiter(',')
      ->expected(2);
  command.add_option("--load", arguments.load, "ohms that the volts are for, or inf")
      ->capture_default_str();
  command
      .add_option("--exposure", arguments.selection.exposure,
                  "which of the K pairs is played, from 1")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command
      .add_option("--tap", arguments.selection.tap, "tap that the sensor's channel plays, from 1")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command.add_flag("--all", arguments.selection.all, "load all K pairs; --exposure is played");
}

void add_family_options(CLI::App& command, UploadArguments& arguments) {
  command
      .add_flag("--true-arb", arguments.request.true_arb,
                "Siglent: play every point instead of skipping some")
      ->group(for_experts);
  command
      .add_option("--wave-header", arguments.header,
                  "Siglent: how a waveform is announced; sources disagree")
      ->check(one_of({"length", "plain", "minimal"}))
      ->capture_default_str()
      ->group(for_experts);
  command.add_option("--filter", arguments.filter, "Keysight: of the output")
      ->check(one_of({"step", "normal", "off"}))
      ->capture_default_str()
      ->group(for_experts);
}

}  // namespace

void add_upload_command(CLI::App& app, Session& session) {
  auto arguments = std::make_shared<UploadArguments>();
  CLI::App* command = app.add_subcommand(
      "upload", "play a code on a generator in the network: load, set, read back and compare");
  command->add_option("CODE", arguments->code, "a family or a code file (.code.json .npz .csv)")
      ->required();
  command->add_option("--instrument", arguments->address,
                      "host, host:port, tcp://host:port, vxi11://host or "
                      "TCPIP::host::port::SOCKET (port 5025)");
  command
      ->add_option("--channel-light", arguments->selection.light_channel,
                   "channel that plays the light; 0: none")
      ->check(CLI::Range(0, 8))
      ->capture_default_str();
  command
      ->add_option("--channel-sensor", arguments->selection.sensor_channel,
                   "channel that plays the sensor's gain; 0: none")
      ->check(CLI::Range(0, 8))
      ->capture_default_str();
  arguments->camera.add_to(*command);
  arguments->taps.add_to(*command);
  add_waveform_options(*command, *arguments);
  command->add_option("--model", arguments->model,
                      "treat the instrument as this one, such as SDG2042X, 33522 or AFG3022");
  add_family_options(*command, *arguments);
  command->add_option("--timeout", arguments->timeout_s, "longest wait for an answer [s]")
      ->check(positive_number(3600.0))
      ->capture_default_str()
      ->group(for_experts);
  command
      ->add_flag("--no-read-back", arguments->no_read_back,
                 "do not compare the points in the instrument: unverified")
      ->group(for_experts);
  command
      ->add_flag("--no-reset", arguments->no_reset,
                 "keep the instrument's other settings, which may change what is played")
      ->group(for_experts);
  command->add_flag("--output-on", arguments->request.output_on,
                    "switch the outputs on when all is verified");
  command->add_flag("--dry-run", arguments->dry_run,
                    "print what would be sent to --model; connect to nothing");
  command->callback([arguments, &session] { run(*arguments, session); });
}

}  // namespace tofsmith::apps
