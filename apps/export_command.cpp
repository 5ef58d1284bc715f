// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "commands.hpp"
#include "generator_json.hpp"
#include "number_checks.hpp"
#include "tap_arguments.hpp"
#include "terminal_progress.hpp"
#include "tofsmith/camera/generator_report.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/instrument/upload.hpp"
#include "tofsmith/io/atomic_file.hpp"
#include "tofsmith/io/code_file.hpp"
#include "tofsmith/io/decoding_table_file.hpp"
#include "tofsmith/report/export_report.hpp"
#include "tofsmith/waveforms/waveform_export.hpp"

namespace tofsmith::apps {

namespace {

struct ExportArguments {
  std::string code, output;
  CameraArguments camera;
  TapArguments taps;
  ExportOptions options;
  std::vector<double> volts;
  EvaluateOptions evaluate{.trials = 2000};
  bool no_loss = false;
};

/// What is written, and where.
struct Product {
  std::filesystem::path path;
  std::string_view text;
};

const WaveformFormat& chosen_format(const std::string& name) {
  try {
    return waveform_format(name);
  } catch (const std::invalid_argument& error) {
    throw UsageError(fmt::format("--format: {}", error.what()));
  }
}

/// A single file, or all files, the manifest and the report in a directory.
bool is_one_file(const ExportArguments& arguments, const WaveformFormat& format) {
  const std::filesystem::path path = arguments.output;
  if (std::filesystem::is_directory(path) || !path.has_extension()) return false;
  if (path.extension() != format.extension)
    throw UsageError(fmt::format("-o {}: found the extension {}; expected {} of {}, or a directory",
                                 arguments.output, path.extension().string(), format.extension,
                                 format.name));
  return true;
}

std::string_view text_of(const std::vector<std::byte>& bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

void write_all(const std::vector<Product>& products, const Session& session) {
  for (const Product& product : products) session.check_output(product.path);
  for (const Product& product : products)
    write_file_atomically(product.path, product.text, session.output_policy());
}

nlohmann::ordered_json estimate_json(const Estimate& estimate) {
  return {{"value_m", estimate.value}, {"se_m", estimate.standard_error}};
}

nlohmann::ordered_json loss_json(const GeneratorLoss& loss, DepthErrorKind kind) {
  nlohmann::ordered_json json = {
      {"error", name_of(kind)},
      {"trials", loss.nominal.trials},
      {"seed", loss.nominal.seed},
      {"nominal", estimate_json(loss.nominal.of(kind).geometric_mean_m)},
      {"actual", estimate_json(loss.actual.of(kind).geometric_mean_m)},
      {"uncalibrated", estimate_json(loss.uncalibrated.of(kind).geometric_mean_m)},
      {"actual_over_nominal", loss.ratio(kind)},
      {"uncalibrated_over_nominal", loss.uncalibrated_ratio(kind)},
      {"correlation_change", loss.correlation_change}};
  for (std::size_t i = 0; i < loss.nominal.points.size(); ++i) {
    const auto mde = [&](const DepthErrorReport& report) {
      const PointDepthError& p = report.points[i];
      return kind == DepthErrorKind::linear ? p.linear_mde_m.value : p.circular_mde_m.value;
    };
    json["points"].push_back({{"signal_e_per_s", loss.nominal.points[i].point.signal_e_per_s},
                              {"ambient_e_per_s", loss.nominal.points[i].point.ambient_e_per_s},
                              {"nominal_m", mde(loss.nominal)},
                              {"actual_m", mde(loss.actual)},
                              {"uncalibrated_m", mde(loss.uncalibrated)}});
  }
  return json;
}

void say_report(const Session& session, const std::vector<GeneratorReport>& reports,
                const std::optional<GeneratorLoss>& loss, const Camera& actual) {
  session.say("Nominal and actual waveforms of the hardware, ahead of the arms' responses:\n" +
              text_table(generator_report_rows(reports)));
  if (!loss) return;
  const DepthErrorKind kind = actual.operating.error;
  session.say(fmt::format("{} depth error, {} trials each, same depths and noise:\n{}",
                          kind == DepthErrorKind::linear ? "Linear" : "Circular",
                          loss->nominal.trials, text_table(generator_loss_rows(*loss, kind))));
}

/// Where nobody said how fast the hardware is: files that no generator known here could play.
std::vector<std::string> rate_notes(const WaveformExport& exported, const Camera& camera,
                                    const ExportOptions& options) {
  const double max_hz = fastest_sample_rate_hz(exported.format.name);
  const double rate_hz = std::max(camera.light.generator ? 0.0 : exported.light.sample_rate_hz,
                                  camera.sensor.generator ? 0.0 : exported.sensor.sample_rate_hz);
  if (options.sample_rate_hz || rate_hz <= max_hz) return {};
  return {fmt::format(
      "the sample rate is {} MHz, and the fastest generator known here that could play these files "
      "has {} MHz; say how fast yours is with --rate, such as --rate {:g}",
      plain_number(1e-6 * rate_hz, 4), plain_number(1e-6 * max_hz, 4), max_hz)};
}

void run(ExportArguments& arguments, const Session& session) {
  const WaveformFormat& format = chosen_format(arguments.options.format);
  if (!arguments.volts.empty()) {
    arguments.options.low_v = arguments.volts[0];
    arguments.options.high_v = arguments.volts[1];
  }
  const bool one_file = is_one_file(arguments, format);
  const Camera camera = arguments.camera.load();
  require_no_measured_table(arguments.code);
  const CodeSet code =
      load_code(arguments.code, camera, arguments.taps.file_options()).resampled(camera.samples);
  const Camera actual = exporting_camera(code, camera, arguments.options);
  const WaveformExport exported = export_waveforms(code, actual, arguments.options);
  const std::vector<ExportedFile> files = export_files(exported);
  if (one_file && files.size() > 1)
    throw UsageError(
        fmt::format("-o {}: {} has one waveform per file and {} has {}; expected a "
                    "directory",
                    arguments.output, format.name, code.name(), files.size()));
  std::optional<GeneratorLoss> loss;
  if (!arguments.no_loss)
    loss = generator_loss(code, actual, arguments.evaluate, terminal_progress("evaluating"));
  const std::vector<GeneratorReport> reports = generator_report(code, actual);
  const std::string manifest = export_manifest(exported, files);

  const std::filesystem::path output = arguments.output;
  check_not_input(output, {arguments.code, arguments.camera.name});
  if (one_file) {
    write_all({{output, text_of(files.front().bytes)}}, session);
  } else {
    const std::string page =
        render(export_page(code, actual, exported, loss, session.command_line));
    make_output_directory(output);
    std::vector<Product> products;
    for (const ExportedFile& file : files)
      products.push_back({output / file.name, text_of(file.bytes)});
    products.push_back({output / "manifest.json", manifest});
    products.push_back({output / "report.html", page});
    write_all(products, session);
  }

  nlohmann::ordered_json document = {{"output", arguments.output},
                                     {"manifest", nlohmann::ordered_json::parse(manifest)},
                                     {"generators", generators_json(reports)}};
  if (loss) document["depth_error"] = loss_json(*loss, actual.operating.error);
  const std::vector<std::string> notes = rate_notes(exported, camera, arguments.options);
  document["notes"] = notes;
  session.print_json(document);
  say_report(session, reports, loss, actual);
  session.say(one_file ? fmt::format("wrote {}", arguments.output)
                       : fmt::format("wrote {} file{} of {}, manifest.json and report.html to {}",
                                     files.size(), files.size() == 1 ? "" : "s", format.name,
                                     arguments.output));
  for (const std::string& note : notes) session.say("note: " + note);
}

std::string format_list() {
  std::string text = "Formats:\n";
  for (const WaveformFormat& format : waveform_formats()) {
    text += fmt::format("  {:15} {}\n", format.name, format.description);
    if (format.variants.empty()) continue;
    std::string names;
    for (const FormatVariant& variant : format.variants)
      names += (names.empty() ? "" : ", ") + variant.name;
    text += fmt::format("  {:15} --variant {}\n", "", names);
  }
  return text;
}

}  // namespace

void add_export_command(CLI::App& app, Session& session) {
  auto arguments = std::make_shared<ExportArguments>();
  CLI::App* command = app.add_subcommand(
      "export",
      "waveforms as files for generators and pattern memories, and what their limits cost");
  ExportOptions& options = arguments->options;
  command->add_option("CODE", arguments->code, "a family or a code file (.code.json, .npz)")
      ->required();
  command->add_option("--format", options.format, "format of the files, see below")->required();
  command->add_option("--variant", options.variant,
                      "of the format, where sources disagree about it, see below");
  arguments->camera.add_to(*command);
  arguments->taps.add_to(*command);
  command->add_option("--samples", options.samples, "points of the table that holds one period");
  command->add_option("--bits", options.bits, "amplitude bits of the hardware (1 = on and off)");
  command
      ->add_option("--rate", options.sample_rate_hz, "most points per second of the hardware [1/s]")
      ->check(positive_number());
  command
      ->add_option("--edge-grid", options.edge_grid_s,
                   "on and off switch at multiples of this time only [s]")
      ->check(positive_number());
  command->add_option("--periods", options.periods,
                      "periods in a table (as few as the format takes)");
  command
      ->add_option("--volts", arguments->volts,
                   "LOW,HIGH: output at no light and no gain, and at peak light and full gain [V] "
                   "(0,1)")
      ->delimiter(',')
      ->expected(2);
  command->add_option("--trials", arguments->evaluate.trials, "trials per operating point")
      ->check(CLI::Range(std::int64_t{2}, std::int64_t{4'000'000'000}))
      ->capture_default_str();
  command->add_option("--seed", arguments->evaluate.seed, "seed of all trials")
      ->capture_default_str();
  command->add_flag("--no-loss", arguments->no_loss, "do not measure what it costs in depth error");
  command
      ->add_option("-o,--output", arguments->output,
                   "a directory: all files, manifest.json and report.html; or one file, of formats "
                   "that hold all waveforms in one")
      ->required();
  command->footer(format_list());
  command->callback([arguments, &session] { run(*arguments, session); });
}

}  // namespace tofsmith::apps
