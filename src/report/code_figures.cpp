// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/report/code_figures.hpp"

#include <fmt/format.h>

#include "camera/shared/actual_code.hpp"
#include "camera/shared/depth_prior.hpp"
#include "tofsmith/camera/forward_model.hpp"
#include "tofsmith/code/families.hpp"
#include "tofsmith/report/figure.hpp"
#include "tofsmith/version.hpp"

namespace tofsmith {

namespace {

constexpr int curve_points = 240;  // per plotted period

Series stepped(const std::string& name, const Waveform& waveform, double period_ns,
               const LineStyle& style) {
  const StepFunction steps = waveform.steps();
  Series series{.name = name, .period = period_ns, .mark = Mark::steps, .style = style};
  for (std::size_t i = 0; i < steps.values.size(); ++i) {
    series.x.push_back(steps.breakpoints[i] * period_ns);
    series.y.push_back(steps.values[i]);
  }
  return series;
}

/// Returns `points` equidistant values in [0, end).
std::vector<double> axis_values(int points, double end) {
  std::vector<double> values(static_cast<std::size_t>(points));
  for (int j = 0; j < points; ++j) values[static_cast<std::size_t>(j)] = end * j / points;
  return values;
}

/// Returns one period [ns]: "as designed" (dotted, only if a generator changes it), "waveform"
/// (thin if there is an impulse response) and "after the impulse response".
std::vector<Series> arm_series(const Waveform& nominal, const Waveform& actual,
                               const ImpulseResponse& response, double fundamental_frequency_hz,
                               const LineStyle& style) {
  const double period_ns = 1e9 / fundamental_frequency_hz;
  LineStyle faint = style;
  faint.width_px = 1.0;
  std::vector<Series> series;
  if (!(nominal == actual))
    series.push_back(stepped("as designed", nominal, period_ns, reference_style()));
  if (response.kind == ImpulseResponse::Kind::none) {
    series.push_back(stepped("waveform", actual, period_ns, style));
    return series;
  }
  series.push_back(stepped("waveform", actual, period_ns, faint));
  series.push_back(
      {.name = "after the impulse response",
       .x = axis_values(curve_points, period_ns),
       .y = to_values(arm_output(actual, response, fundamental_frequency_hz, curve_points)),
       .period = period_ns,
       .style = style});
  return series;
}

/// Converts drives x to weights 2 x - 1.
std::vector<Series> weight_series(std::vector<Series> drive) {
  for (Series& series : drive)
    for (auto& value : series.y) value = 2 * value - 1;
  return drive;
}

Series correlation_series(std::string name, const Eigen::VectorXd& values, double range_m,
                          const LineStyle& style) {
  return {.name = std::move(name),
          .x = axis_values(static_cast<int>(values.size()), range_m),
          .y = to_values(values),
          .period = range_m,
          .style = style};
}

std::vector<PanelColumn> waveform_columns(bool is_signed) {
  return {{.title = "Modulation",
           .x = {.label = "time", .unit = "ns"},
           .y = {.label = "power / average", .from_zero = true}},
          {.title = "Demodulation",
           .x = {.label = "time", .unit = "ns"},
           .y = {.label = is_signed ? "weight" : "gain", .from_zero = true}},
          {.title = "Correlation",
           .x = {.label = "depth", .unit = "m"},
           .y = {.label = "value", .from_zero = true}}};
}

std::string response_text(const ImpulseResponse& response) {
  switch (response.kind) {
    case ImpulseResponse::Kind::none:
      return "none";
    case ImpulseResponse::Kind::hann:
      return fmt::format("Hann window, f_max {:.4g} MHz", response.f_max_hz / 1e6);
    case ImpulseResponse::Kind::gaussian:
    case ImpulseResponse::Kind::lowpass:
      return fmt::format("{}, -3 dB at {:.4g} MHz", name_of(response.kind),
                         response.cutoff_hz / 1e6);
    case ImpulseResponse::Kind::file:
      return fmt::format("measured, {}{} samples",
                         response.file.empty() ? "" : response.file + ", ",
                         response.samples.size());
  }
  return "";
}

std::string jitter_text(double edge_jitter_s) {
  return edge_jitter_s > 0.0 ? fmt::format("; edge jitter {:.4g} ps", edge_jitter_s * 1e12) : "";
}

std::string arm_text(bool binary) { return binary ? "binary" : "analog"; }

std::string generator_text(const std::optional<Generator>& generator, double frequency_hz) {
  if (!generator) return "";
  return fmt::format("; generator: {:.4g} MS/s, {} bits, {} points per period",
                     generator->sample_rate_hz / 1e6, generator->amplitude_bits,
                     generator->points_per_period(frequency_hz));
}

/// Returns true if the second bucket is open exactly while the first is not.
bool has_complementary_buckets(const CodeSet& code) {
  if (code.taps() != 2 || code.is_rows()) return false;
  const Eigen::MatrixXd gains = code.demodulation_samples();
  for (int e = 0; e < code.exposures(); ++e)
    if ((gains.col(2 * e) + gains.col(2 * e + 1)).minCoeff() < 1.0 - 1e-9) return false;
  return true;
}

}  // namespace

std::string figure_id(const std::string& prefix, const std::string& name) {
  std::string id = prefix + "-";
  for (const char c : name) {
    const bool plain =
        (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-';
    id += plain ? std::string(1, c) : fmt::format("-x{:02x}-", static_cast<unsigned char>(c));
  }
  return id;
}

Figure waveform_figure(FigureText text, const CodeSet& code, const Camera& camera,
                       const Eigen::MatrixXd& target) {
  ColourAssignment colours;
  const LineStyle light = colours.style("light"), sensor = colours.style("sensor"),
                  correlation = colours.style("correlation");
  const double frequency_hz = camera.fundamental_frequency_hz;
  const ForwardModel model(code, camera);
  const ActualCode actual = actual_code(code, camera);
  const Eigen::MatrixXd table = code.is_signed() ? model.correlation_table(curve_points)
                                                 : model.tap_correlation_table(curve_points);
  const double range_m = camera.range_m();

  const bool omits_complements = has_complementary_buckets(code);
  if (omits_complements) text.caption += " Second buckets are not shown.";
  std::vector<PanelRow> rows;
  for (int i = 0; i < code.measurements(); i += omits_complements ? 2 : 1) {
    std::vector<Series> correlations{
        correlation_series("correlation function", table.col(i), range_m, correlation)};
    const int target_column = code.exposure_of(i);
    if (i % code.taps() == 0 && target_column < target.cols())
      correlations.push_back(
          correlation_series("target", target.col(target_column), range_m, reference_style()));
    std::vector<Series> gates =
        arm_series(code.demodulation(i), actual.demodulation[static_cast<std::size_t>(i)],
                   camera.sensor.impulse_response, frequency_hz, sensor);
    if (code.is_signed()) gates = weight_series(std::move(gates));
    rows.push_back(
        {.title = fmt::format("{}", i + 1),
         .panels = {arm_series(code.modulation_of(i),
                               actual.modulation[static_cast<std::size_t>(code.exposure_of(i))],
                               camera.light.impulse_response, frequency_hz, light),
                    std::move(gates), std::move(correlations)}});
  }
  return small_multiples(std::move(text), waveform_columns(code.is_signed()), rows);
}

Figure correlation_figure(FigureText text, const CodeSet& code, const Camera& camera) {
  Camera ideal = camera;
  ideal.light.generator.reset();
  ideal.sensor.generator.reset();
  const Eigen::MatrixXd designed = ForwardModel(code, ideal).correlation_table(curve_points),
                        generated = ForwardModel(code, camera).correlation_table(curve_points);
  std::vector<Series> series;
  ColourAssignment colours;
  for (Eigen::Index k = 0; k < designed.cols(); ++k) {
    const std::string name = fmt::format("measurement {}", k + 1);
    series.push_back(
        correlation_series("as designed", designed.col(k), camera.range_m(), reference_style()));
    series.push_back(
        correlation_series(name, generated.col(k), camera.range_m(), colours.style(name)));
  }
  return line_figure(std::move(text), series, {.label = "depth", .unit = "m"},
                     {.label = "correlation"});
}

Figure coding_curve_figure(FigureText text, const std::vector<CodeSet>& codes,
                           const Camera& camera) {
  std::vector<Curve3d> curves;
  Eigen::VectorXd depth_m(curve_points);
  for (int j = 0; j < curve_points; ++j) depth_m[j] = camera.range_m() * j / curve_points;
  for (const CodeSet& code : codes) {
    const Eigen::MatrixXd table = ForwardModel(code, camera).correlation_table(curve_points);
    curves.push_back(
        {.title = fmt::format("{} (length {:.2f})", code.name(), coding_curve_length(table)),
         .points = coding_curve_in_space(table),
         .values = depth_m});
  }
  return curve_3d_figure(
      std::move(text), curves,
      {Axis{.label = "axis 1"}, Axis{.label = "axis 2"}, Axis{.label = "axis 3"}},
      {.label = "depth", .unit = "m"});
}

KeyValueList camera_description(const Camera& camera) {
  KeyValueList list;
  const auto add = [&](std::string key, std::string value) {
    list.entries.push_back({std::move(key), std::move(value)});
  };
  add("name", camera.name);
  add("fundamental frequency",
      fmt::format("{:.4g} MHz (range {:.3f} m)", camera.fundamental_frequency_hz / 1e6,
                  camera.range_m()));
  add("exposure", camera.exposure_s.each_s.empty()
                      ? fmt::format("{:.4g} ms in total", camera.exposure_s.total_s * 1e3)
                      : fmt::format("{} listed exposures", camera.exposure_s.each_s.size()));
  add("samples per period", fmt::format("{}", camera.samples));
  add("peak power / average power", fmt::format("{:.4g}", camera.light.peak_factor));
  add("light source", arm_text(camera.light.binary) +
                          "; response: " + response_text(camera.light.impulse_response) +
                          jitter_text(camera.light.edge_jitter_s) +
                          generator_text(camera.light.generator, camera.fundamental_frequency_hz));
  const std::string receiver =
      camera.sensor.is_signed()
          ? "a mixer with weights from -1 to 1"
          : fmt::format("{} tap{}", camera.sensor.taps, camera.sensor.taps > 1 ? "s" : "");
  add("sensor", fmt::format("{}, {}; response: {}", receiver, arm_text(camera.sensor.binary),
                            response_text(camera.sensor.impulse_response)) +
                    jitter_text(camera.sensor.edge_jitter_s) +
                    generator_text(camera.sensor.generator, camera.fundamental_frequency_hz));
  if (camera.sensor.tap_mismatch != 0.0)
    add("tap mismatch", fmt::format("{:.3g} %", 100 * camera.sensor.tap_mismatch));
  add("noise", fmt::format("{} shot noise, read noise {:.4g} e",
                           camera.sensor.noise == NoiseModel::poisson ? "Poisson" : "Gaussian",
                           camera.sensor.read_noise_e));
  add("ranked by",
      fmt::format("mean {} depth error at {} signal levels x {} ambient levels",
                  name_of(camera.operating.error), camera.operating.signal_e_per_s.size(),
                  camera.operating.ambient_e_per_s.size()));
  if (!DepthPrior(camera).is_uniform()) add("true depths", true_depths_in_words(camera));
  return list;
}

Section camera_section(const Camera& camera) {
  Section section{"Camera", {camera_description(camera)}};
  const DepthPrior depths(camera);
  if (depths.is_uniform()) return section;
  constexpr int parts = 2000;
  const Eigen::VectorXd masses = depths.masses(parts);
  Series density{.name = "true depths", .mark = Mark::steps};
  for (int i = 0; i < parts; ++i) {
    density.x.push_back(camera.range_m() * i / parts);
    density.y.push_back(parts * masses[i]);
  }
  section.blocks.push_back(line_figure(
      {.id = "true-depths",
       .title = "Distribution of true depths",
       .caption = "1: as frequent as in a uniform distribution. Errors and Cramer-Rao bounds are "
                  "means over this distribution; the decoder does not use it."},
      {std::move(density)}, {.label = "depth", .unit = "m"},
      {.label = "density of true depths", .from_zero = true}));
  return section;
}

std::string true_depths_in_words(const Camera& camera) {
  const OperatingRange& range = camera.operating;
  std::string where = range.working_distance_m
                          ? fmt::format("from {:.4g} to {:.4g} m", (*range.working_distance_m)[0],
                                        (*range.working_distance_m)[1])
                          : "anywhere in the range";
  if (!range.depths || DepthPrior::are_alike(*range.depths)) return where;
  return fmt::format("{}, distributed by {} weights", where, range.depths->size());
}

Page code_page(const CodeSet& code, const Camera& camera, const std::string& command_line) {
  Page page{.title = code.name(),
            .subtitle = fmt::format("{} measurements on {}", code.measurements(), camera.name),
            .footer = "tofsmith " TOFSMITH_VERSION};
  page.sections.push_back(
      {"Waveforms",
       {waveform_figure({.id = "waveforms",
                         .title = "Waveforms and correlation functions",
                         .caption = "One row per measurement, over one period."},
                        code, camera),
        coding_curve_figure(
            {.id = "coding-curve",
             .title = "Coding curve",
             .caption = "Curve of the correlation values as depth varies over the range."},
            {code}, camera)}});
  page.sections.push_back(camera_section(camera));
  if (!command_line.empty()) page.sections.push_back({"Command", {CodeBlock{command_line}}});
  return page;
}

}  // namespace tofsmith
