// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/waveforms/write_export.hpp"
#include "tofsmith/waveforms/export_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <span>
#include <string_view>
#include <utility>

#include "io/documents/shared/document_text.hpp"
#include "io/shared/read_file.hpp"
#include "report/shared/table_of_rows.hpp"
#include "tofsmith/camera/generator_report.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/core/units.hpp"
#include "tofsmith/report/code_figures.hpp"
#include "tofsmith/report/figure.hpp"
#include "tofsmith/version.hpp"

namespace tofsmith {

namespace {

/// Warns if files exceed the rate of every known generator.
std::vector<std::string> rate_notes(const WaveformExport& exported, const Camera& camera,
                                    const ExportOptions& options) {
  const double max_hz = fastest_sample_rate_hz(exported.format.name);
  const double rate_hz = std::max(camera.light.generator ? 0.0 : exported.light.sample_rate_hz,
                                  camera.sensor.generator ? 0.0 : exported.sensor.sample_rate_hz);
  if (options.sample_rate_hz || rate_hz <= max_hz) return {};
  return {
      fmt::format("the sample rate is {} MHz, but the fastest known generator for these files has "
                  "{} MHz; specify the rate of your generator with --rate, such as --rate {:g}",
                  plain_number(1e-6 * rate_hz, 4), plain_number(1e-6 * max_hz, 4), max_hz)};
}

constexpr double max_duty_change = 0.01;  // relative; larger changes are noted
constexpr int max_points_away = 128;      // for alternative tables

double duty_change(const GeneratorReport& report) {
  return report.duty_nominal > 0.0 ? std::abs(report.duty_actual / report.duty_nominal - 1.0) : 0.0;
}

const GeneratorReport& most_changed(const std::vector<GeneratorReport>& reports) {
  return *std::ranges::max_element(reports, {}, duty_change);
}

/// Returns true if tables with `points` per period are valid and keep all duties.
bool keeps_duties(const CodeSet& code, const Camera& camera, ExportOptions options, int points) {
  options.samples = points;
  try {
    const Camera actual = exporting_camera(code, camera, options);
    export_waveforms(code, actual, options);
    return duty_change(most_changed(generator_report(code, actual))) <= max_duty_change;
  } catch (const std::invalid_argument&) {
    return false;
  }
}

/// Suggests tables if rounding to points changes the width of pulses.
std::vector<std::string> duty_notes(const ExportedCode& exported, const Camera& camera,
                                    const ExportOptions& options) {
  if (exported.generators.empty()) return {};
  const GeneratorReport& worst = most_changed(exported.generators);
  if (duty_change(worst) <= max_duty_change) return {};
  const int points = worst.points_per_period;
  std::vector<std::string> others;
  for (const int step : {-1, 1})
    for (int away = 1; away <= max_points_away && points + step * away >= 2; ++away)
      if (keeps_duties(exported.code, camera, options, points + step * away)) {
        others.push_back(fmt::format("--samples {}", points + step * away));
        break;
      }
  return {fmt::format(
      "with {} points per period, the duty of {} {} is {:.4g} instead of {:.4g}; {}", points,
      worst.arm == Arm::light ? "modulation" : "demodulation", worst.index + 1, worst.duty_actual,
      worst.duty_nominal,
      others.empty() ? fmt::format("no --samples within {} of this number preserves all duties",
                                   max_points_away)
                     : fmt::format("{} would preserve all duties", fmt::join(others, " or ")))};
}

using Product = std::pair<std::filesystem::path, std::span<const std::byte>>;

std::span<const std::byte> bytes_of(std::string_view text) {
  return std::as_bytes(std::span(text.data(), text.size()));
}

/// Returns true for a file of an interrupted run.
bool is_written(const Product& product) {
  const auto& [path, content] = product;
  std::error_code ignored;
  if (std::filesystem::file_size(path, ignored) != content.size() || ignored) return false;
  return std::ranges::equal(read_binary_file(path), content);
}

/// Completes an interrupted run. If all files exist already, `policy` applies.
void write_all(std::vector<Product> products, OutputPolicy policy) {
  if (!std::ranges::all_of(products, is_written)) std::erase_if(products, is_written);
  for (const auto& [path, content] : products) const AtomicFile probe(path, policy);
  for (const auto& [path, content] : products) write_file_atomically(path, content, policy);
}

}  // namespace

bool ExportRequest::is_one_file() const {
  const WaveformFormat& format = waveform_format(options.format);
  if (std::filesystem::is_directory(output) || !output.has_extension()) return false;
  require(output.extension() == format.extension, "output", output.string(),
          fmt::format("expected {} of {}, or a directory", format.extension, format.name));
  require(format.content != FormatContent::one_waveform, "output", output.string(),
          fmt::format("{} has one waveform per file; expected a directory", format.name));
  return true;
}

ExportedCode write_export(const CodeSet& code, const Camera& camera, const ExportRequest& request,
                          const Progress& progress) {
  const bool one_file = request.is_one_file();
  const CodeSet resampled = code.resampled(camera.samples);
  const Camera actual = exporting_camera(resampled, camera, request.options);
  ExportedCode exported{.code = resampled,
                        .actual = actual,
                        .waveforms = export_waveforms(resampled, actual, request.options),
                        .output = request.output};
  const std::vector<ExportedFile> files = export_files(exported.waveforms);
  exported.manifest = export_manifest(exported.waveforms, files);
  if (request.loss) exported.loss = generator_loss(resampled, actual, *request.loss, progress);
  exported.generators = generator_report(resampled, actual);
  exported.notes = rate_notes(exported.waveforms, camera, request.options);
  ExportedScripts scripts = export_scripts(exported.waveforms);
  exported.scripts = std::move(scripts.files);
  if (!scripts.problem.empty())
    exported.notes.push_back("no SCPI script was written: " + scripts.problem);
  for (std::string& note : duty_notes(exported, camera, request.options))
    exported.notes.push_back(std::move(note));

  std::string page;
  std::vector<Product> products;
  if (one_file) {
    products = {{request.output, files.front().bytes}};
  } else {
    if (request.page) page = request.page(exported);
    make_output_directory(request.output);
    for (const ExportedFile& file : files)
      products.emplace_back(request.output / file.name, file.bytes);
    for (const ExportedScript& script : exported.scripts)
      products.emplace_back(request.output / script.name, bytes_of(script.text));
    products.emplace_back(request.output / "manifest.json", bytes_of(exported.manifest));
    if (request.page) products.emplace_back(request.output / "report.html", bytes_of(page));
  }
  write_all(products, request.policy);
  for (const auto& [path, content] : products) exported.files.push_back(path);
  return exported;
}

std::string export_document(const ExportedCode& exported) {
  using Json = nlohmann::ordered_json;
  Json document = {{"output", exported.output.string()},
                   {"manifest", Json::parse(exported.manifest)},
                   {"generators", generators_json(exported.generators)}};
  if (exported.loss)
    document["depth_error"] = generator_loss_json(*exported.loss, exported.actual.operating.error);
  document["notes"] = exported.notes;
  return document.dump(2, ' ', false, Json::error_handler_t::replace);
}

namespace {

using Row = std::vector<std::string>;

KeyValueList description(const WaveformExport& exported) {
  const double frequency_hz = exported.fundamental_frequency_hz;
  KeyValueList list;
  const auto add = [&](std::string key, std::string value) {
    list.entries.push_back({std::move(key), std::move(value)});
  };
  add("format", fmt::format("{}: {}", exported.format.name, exported.format.description));
  add("code", exported.code);
  add("frequency", fmt::format("{:.9g} Hz", frequency_hz));
  for (const auto* generator : {&exported.light, &exported.sensor})
    add(generator == &exported.light ? "light" : "sensor",
        fmt::format("table of {} points, {} of them used, {:.6g} MS/s, {} bits{}",
                    generator->points_in_table(frequency_hz),
                    generator->points_per_period(frequency_hz), generator->sample_rate_hz / 1e6,
                    generator->amplitude_bits,
                    generator->edge_grid_s
                        ? fmt::format(", edges on {:.6g} ns", *generator->edge_grid_s * 1e9)
                        : ""));
  add("tables",
      fmt::format("{} of {} points ({} periods)", exported.waveforms.size(),
                  exported.waveforms.front().points(), exported.waveforms.front().periods));
  return list;
}

}  // namespace

std::vector<Row> generator_report_rows(const std::vector<GeneratorReport>& reports) {
  std::vector<Row> rows{{"generator", "points", "clock (MHz)", "duty nominal", "actual",
                         "mean nominal", "actual", "edge shift (ns)", "rms change"}};
  for (const GeneratorReport& r : reports)
    rows.push_back(
        {fmt::format("{}{}", r.arm == Arm::light ? "m" : "d", r.index + 1),
         fmt::format("{}", r.points_per_period), fmt::format("{:.4g}", r.clock_hz / 1e6),
         fmt::format("{:.4f}", r.duty_nominal), fmt::format("{:.4f}", r.duty_actual),
         fmt::format("{:.4f}", r.mean_nominal), fmt::format("{:.4f}", r.mean_actual),
         r.largest_edge_move_s ? fmt::format("{:.3f}", *r.largest_edge_move_s * 1e9) : "-",
         fmt::format("{:.4g}", r.rms_difference)});
  return rows;
}

std::vector<Row> generator_loss_rows(const GeneratorLoss& loss, DepthErrorKind kind) {
  std::vector<Row> rows{{"signal, ambient (e/s)", "nominal (mm)", "actual (mm)", "/ nominal",
                         "uncalibrated (mm)", "/ nominal"}};
  const auto row = [](std::string name, const Estimate& nominal, const Estimate& actual,
                      const Estimate& uncalibrated) {
    return Row{std::move(name),
               estimate_mm_text(nominal),
               estimate_mm_text(actual),
               fmt::format("{:.3f}", actual.value / nominal.value),
               estimate_mm_text(uncalibrated),
               fmt::format("{:.3f}", uncalibrated.value / nominal.value)};
  };
  const auto error = kind == DepthErrorKind::linear ? &PointDepthError::linear_mde_m
                                                    : &PointDepthError::circular_mde_m;
  for (std::size_t i = 0; i < loss.nominal.points.size(); ++i) {
    const OperatingPoint& point = loss.nominal.points[i].point;
    rows.push_back(row(fmt::format("{:.3g}, {:.3g}", point.signal_e_per_s, point.ambient_e_per_s),
                       loss.nominal.points[i].*error, loss.actual.points[i].*error,
                       loss.uncalibrated.points[i].*error));
  }
  rows.push_back(row("geometric mean", loss.nominal.of(kind).geometric_mean_m,
                     loss.actual.of(kind).geometric_mean_m,
                     loss.uncalibrated.of(kind).geometric_mean_m));
  return rows;
}

Page export_page(const ExportedCode& exported, const std::string& command_line) {
  const CodeSet& code = exported.code;
  const Camera& actual = exported.actual;
  const std::optional<GeneratorLoss>& loss = exported.loss;
  const DepthErrorKind kind = actual.operating.error;
  Page page{.title = fmt::format("{} as {}", code.name(), exported.waveforms.format.name),
            .subtitle = fmt::format("effect of the hardware's limits on {}", actual.name),
            .footer = "tofsmith " TOFSMITH_VERSION};
  page.sections.push_back({"Export", {description(exported.waveforms)}});
  page.sections.push_back(
      {"Waveforms",
       {table_of_rows("generators",
                      "Each waveform as designed (nominal) and as the generator outputs it "
                      "(actual), before the impulse responses.",
                      generator_report_rows(exported.generators), {0}),
        waveform_figure({.id = "waveforms",
                         .title = "Waveforms and correlation functions",
                         .caption = "One row per measurement, over one period. Dotted: as "
                                    "designed, if the generator changes it."},
                        code, actual),
        correlation_figure({.id = "correlation",
                            .title = "Correlation functions",
                            .caption = "Lines: with the waveforms of the generator."},
                           code, actual)}});
  if (loss)
    page.sections.push_back(
        {"Depth error",
         {table_of_rows(
             "loss",
             fmt::format(
                 "{} depth error with nominal waveforms, with actual waveforms, and with actual "
                 "waveforms that are decoded as if they were nominal (uncalibrated). The depths "
                 "and the noise are the same, with {} trials per operating point and seed {}.",
                 kind == DepthErrorKind::linear ? "Linear" : "Circular", loss->nominal.trials,
                 loss->nominal.seed),
             generator_loss_rows(*loss, kind), {0})}});
  if (!command_line.empty()) page.sections.push_back({"Command", {CodeBlock{command_line}}});
  return page;
}

}  // namespace tofsmith
