// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/waveforms/waveform_export.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "camera/shared/actual_code.hpp"
#include "core/shared/text_numbers.hpp"
#include "tofsmith/core/error.hpp"
#include "waveforms/generator_formats.hpp"

namespace tofsmith {

namespace {

WaveformFormat memory_format(std::string name, std::string extension, std::string description) {
  return {.name = std::move(name),
          .extension = std::move(extension),
          .description = std::move(description),
          .content = FormatContent::words,
          .default_bits = 1,
          .trigger = "top bit of every word"};
}

std::vector<WaveformFormat> generator_formats() {
  return {
      {.name = "siglent-csv",
       .extension = ".csv",
       .description = "Siglent SDG, EasyWave CSV of 16384 rows",
       .min_points = 16384,
       .max_points = 16384,
       .skips_points = true,
       .variants = {{"easywave", "\"data length\", empty lines, rows counted from 1"},
                    {"lenth", "\"data lenth\", empty lines, rows by time"},
                    {"commas", "\"data length\", lines of one comma, rows by time"}}},
      {.name = "siglent-wvdt14",
       .extension = ".wvdt",
       .description = "Siglent SDG800 to SDG5000, WVDT command of 14 bits",
       .min_points = 16384,
       .max_points = 16384,
       .levels = 1 << 14,
       .max_bits = 14,
       .skips_points = true,
       .variants = {{"little-endian", "low byte first"}, {"big-endian", "high byte first"}}},
      {.name = "siglent-wvdt16",
       .extension = ".wvdt",
       .description = "Siglent SDG X series, WVDT command of 16 bits",
       .levels = 1 << 16,
       .default_bits = 16,
       .skips_points = true},
      {.name = "keysight-arb",
       .extension = ".arb",
       .description = "Keysight 33500 and 33600, .arb text",
       .min_points = 8,
       .max_points = 1'000'000,
       .levels = keysight_levels,
       .default_bits = 16,
       .trigger = "Marker Point: sync is high before it",
       .variants = {{"lf", "lines end with LF"}, {"crlf", "lines end with CR LF"}}},
      {.name = "tek-tfw",
       .extension = ".tfw",
       .description = "Tektronix AFG1000 to AFG31000, .tfw",
       .max_points = 131072,
       .levels = tektronix_afg_levels,
       .max_bits = 14,
       .skips_points = true,
       .variants = {{"16382", "codes 0 .. 16382"}, {"16383", "codes 0 .. 16383"}}},
      {.name = "tek-wfm",
       .extension = ".wfm",
       .description = "Tektronix AWG400 to AWG700, .wfm \"MAGIC 1000\"",
       .min_points = 256,
       .multiple_of = 4,
       .trigger = "marker 1; marker 2 is the first point",
       .variants = {{"crlf", "lines end with CR LF"},
                    {"lf", "lines end with LF"},
                    {"blank-crlf", "lines end with a blank and CR LF"}}},
  };
}

std::vector<WaveformFormat> make_formats() {
  std::vector<WaveformFormat> formats = generator_formats();
  formats.push_back(memory_format("xilinx-coe", ".coe", "Xilinx coefficient file"));
  formats.push_back(memory_format("intel-mif", ".mif", "Intel memory initialization file"));
  formats.push_back(memory_format("verilog-mem", ".mem", "words for Verilog's $readmemh"));
  formats.push_back(memory_format("systemverilog", ".sv", "SystemVerilog package"));
  formats.push_back(memory_format("vhdl", ".vhd", "VHDL package"));
  formats.push_back(memory_format("c-header", ".h", "C99 header"));
  formats.push_back({.name = "csv",
                     .extension = ".csv",
                     .description = "plain table: time, trigger, all waveforms",
                     .content = FormatContent::all_columns,
                     .max_bits = 24,
                     .trigger = "column trigger"});
  return formats;
}

}  // namespace

const std::vector<WaveformFormat>& waveform_formats() {
  static const std::vector<WaveformFormat> formats = make_formats();
  return formats;
}

const WaveformFormat& waveform_format(std::string_view name) {
  std::vector<std::string> names;
  for (const WaveformFormat& format : waveform_formats()) {
    if (format.name == name) return format;
    names.push_back(format.name);
  }
  const std::string near = nearest_word(name, names);
  reject("format", name,
         fmt::format("must be one of {}{}", fmt::join(names, ", "),
                     near.empty() ? "" : fmt::format(" (did you mean {}?)", near)));
}

int variant_index(const WaveformFormat& format, std::string_view variant) {
  if (variant.empty()) return 0;
  std::vector<std::string> names;
  for (const FormatVariant& known : format.variants) {
    if (known.name == variant) return static_cast<int>(names.size());
    names.push_back(known.name);
  }
  reject("variant", variant,
         names.empty()
             ? fmt::format("{} has no variants", format.name)
             : fmt::format("must be one of {} for {}", fmt::join(names, ", "), format.name));
}

namespace {

bool is_name(const std::string& name) {
  return !name.empty() && is_letter(name.front()) &&
         std::ranges::all_of(name, [](char c) { return is_letter_or_digit(c) || c == '_'; });
}

constexpr int max_periods = 4096;

void check_options(const ExportOptions& options, const WaveformFormat& format) {
  const std::string of_format = fmt::format(" ({})", format.name);
  if (options.bits)
    require(*options.bits >= 1 && *options.bits <= format.max_bits, "bits", *options.bits,
            fmt::format("must be in [1, {}]{}", format.max_bits, of_format));
  if (options.samples)
    require(*options.samples >= 2 && *options.samples <= format.max_points, "samples",
            *options.samples,
            fmt::format("must be in [2, {}], the limits of the memory of {}", format.max_points,
                        format.name));
  if (options.periods)
    require(*options.periods >= 1 && *options.periods <= max_periods, "periods", *options.periods,
            fmt::format("must be in [1, {}]", max_periods));
  if (options.sample_rate_hz)
    require(std::isfinite(*options.sample_rate_hz) && *options.sample_rate_hz > 0.0,
            "sample_rate_hz", *options.sample_rate_hz, "must be finite and > 0");
  require(std::isfinite(options.low_v) && std::isfinite(options.high_v) &&
              options.high_v > options.low_v,
          "high_v", options.high_v,
          fmt::format("must be finite and above low_v = {}", options.low_v));
}

int table_points(const ExportOptions& options, const WaveformFormat& format,
                 const std::optional<Generator>& own, const Camera& camera) {
  const double frequency_hz = camera.fundamental_frequency_hz;
  if (options.samples) return *options.samples;
  if (format.min_points == format.max_points) return format.max_points;
  if (own && own->table_points) return std::min(*own->table_points, format.max_points);
  int points = camera.samples;
  if (options.sample_rate_hz)
    points = Generator{.sample_rate_hz = *options.sample_rate_hz}.points_per_period(frequency_hz);
  else if (own)
    points = own->points_per_period(frequency_hz);
  if (options.sample_rate_hz)
    require(points >= 2, "sample_rate_hz", *options.sample_rate_hz,
            fmt::format("must be at least {:.4g}, 2 points per period of {:.4g} Hz; check the unit",
                        2 * frequency_hz, frequency_hz));
  return std::min(points, format.max_points);
}

Generator generator_of(const ExportOptions& options, const WaveformFormat& format,
                       const std::optional<Generator>& own, bool binary, const Camera& camera) {
  Generator generator = own.value_or(Generator{});
  const int points = table_points(options, format, own, camera);
  const double frequency_hz = camera.fundamental_frequency_hz;
  generator.table_points = points;
  if (options.sample_rate_hz)
    generator.sample_rate_hz = *options.sample_rate_hz;
  else if (!own)
    generator.sample_rate_hz = points * frequency_hz;
  if (options.edge_grid_s) generator.edge_grid_s = options.edge_grid_s;
  if (options.bits)
    generator.amplitude_bits = *options.bits;
  else if (format.content == FormatContent::words)
    generator.amplitude_bits = binary ? 1 : own ? std::min(own->amplitude_bits, 16) : 8;
  else
    generator.amplitude_bits =
        own ? std::min(own->amplitude_bits, format.max_bits) : format.default_bits;
  require(
      format.skips_points || points * frequency_hz <= generator.sample_rate_hz * (1 + 1e-9),
      "samples", points,
      fmt::format(
          "must be at most {}, from {:.6g} points per second at {:.6g} Hz ({} outputs every point)",
          std::floor(generator.sample_rate_hz / frequency_hz * (1 + 1e-12)),
          generator.sample_rate_hz, frequency_hz, format.name));
  return generator;
}

std::int32_t levels_of(const WaveformFormat& format, int variant, int bits) {
  if (format.name == "tek-tfw" && variant == 1) return format.levels + 1;
  return format.levels > 0 ? format.levels : 1 << bits;
}

int fitting_periods(const WaveformFormat& format, int points, const std::optional<int>& asked) {
  const auto fits = [&](int periods) {
    const std::int64_t all = std::int64_t{points} * periods;
    return all >= format.min_points && all <= format.max_points && all % format.multiple_of == 0;
  };
  const std::string rule =
      fmt::format("{} requires {} to {} points in multiples of {}", format.name, format.min_points,
                  format.max_points, format.multiple_of);
  if (asked) {
    require(fits(*asked), "points", std::int64_t{points} * *asked,
            fmt::format("{} (found {} per period in {} periods)", rule, points, *asked));
    return *asked;
  }
  for (int periods = 1; periods <= max_periods; ++periods)
    if (fits(periods)) return periods;
  reject("points", fmt::format("{}", points),
         fmt::format("{}; no number of periods satisfies this", rule));
}

struct ArmTables {
  const Generator& generator;
  double frequency_hz;
  std::int32_t levels;
  int periods;

  QuantizedWaveform of(const Waveform& nominal, bool light) const {
    const Waveform table = generator_table(nominal, generator, frequency_hz);
    const double scale =
        light ? average_power_scale(generated(nominal, generator, frequency_hz)) : 1.0;
    const int points = generator.points_in_table(frequency_hz);
    QuantizedWaveform waveform = quantized(table, points, levels, scale);
    waveform.sample_rate_hz = points * frequency_hz;
    waveform.periods = periods;
    const std::vector<std::int32_t> period = waveform.codes;
    for (int p = 1; p < periods; ++p)
      waveform.codes.insert(waveform.codes.end(), period.begin(), period.end());
    return waveform;
  }
};

void set_volts(WaveformExport& exported, const ExportOptions& options) {
  double light_peak = 0.0;
  for (const QuantizedWaveform& waveform : exported.waveforms)
    if (waveform.arm == Arm::light) light_peak = std::max(light_peak, waveform.full_scale);
  const double range_v = options.high_v - options.low_v;
  for (QuantizedWaveform& waveform : exported.waveforms) {
    const double full = waveform.arm == Arm::light ? light_peak : 1.0;
    const double share = full > 0.0 ? waveform.full_scale / full : 0.0;
    waveform.low_v = options.low_v;
    // A waveform that is never on keeps the whole range, because low_v < high_v must hold.
    waveform.high_v = options.low_v + (share > 0.0 ? share : 1.0) * range_v;
  }
}

}  // namespace

void QuantizedWaveform::validate() const {
  require(is_name(name), "waveform name", name,
          "must be letters, digits and _, and begin with a letter");
  require(levels >= 2 && levels <= 1 << 24, name + " levels", levels, "must be in [2, 2^24]");
  require(codes.size() >= 2 && codes.size() <= std::size_t{1} << 26, name + " points", codes.size(),
          "must be in [2, 2^26]");
  require(periods >= 1 && points() % periods == 0, name + " periods", periods,
          "must be >= 1 and divide the points");
  const auto [min, max] = std::ranges::minmax(codes);
  require(min >= 0 && max < levels, name + " code", min < 0 ? min : max,
          "must be in [0, levels - 1]");
  require(std::isfinite(sample_rate_hz) && sample_rate_hz > 0.0, name + " sample_rate_hz",
          sample_rate_hz, "must be finite and > 0");
  require(std::isfinite(full_scale) && full_scale >= 0.0, name + " full_scale", full_scale,
          "must be finite and >= 0");
  require(std::isfinite(low_v) && std::isfinite(high_v) && high_v > low_v, name + " high_v", high_v,
          "must be finite and above low_v");
}

QuantizedWaveform quantized(const Waveform& table, int points, std::int32_t levels, double scale) {
  QuantizedWaveform result;
  result.levels = levels;
  const double peak = table.peak();
  result.full_scale = scale * peak;
  const Eigen::VectorXd values = table.cell_averages(points);
  result.codes.reserve(static_cast<std::size_t>(points));
  for (const double value : values)
    result.codes.push_back(
        peak > 0.0 ? static_cast<std::int32_t>(std::lround(value / peak * (levels - 1))) : 0);
  return result;
}

Camera exporting_camera(const CodeSet& code, const Camera& camera, const ExportOptions& options) {
  const WaveformFormat& format = waveform_format(options.format);
  variant_index(format, options.variant);
  check_options(options, format);
  require_fits(code, camera);
  const bool binary = code.is_binary();
  if (format.content == FormatContent::words && !binary)
    require(options.bits.value_or(8) >= 2, "bits", 1,
            fmt::format("must be >= 2: not all waveforms of {} are binary", code.name()));
  Camera actual = camera;
  actual.light.generator = generator_of(options, format, camera.light.generator, binary, camera);
  actual.sensor.generator = generator_of(options, format, camera.sensor.generator, binary, camera);
  actual.validate();
  return actual;
}

WaveformExport export_waveforms(const CodeSet& code, const Camera& actual,
                                const ExportOptions& options) {
  const double frequency_hz = actual.fundamental_frequency_hz;
  require(actual.light.generator && actual.sensor.generator, "generators", "none",
          "must be set, as by exporting_camera()");
  WaveformExport exported;
  exported.format = waveform_format(options.format);
  exported.variant = variant_index(exported.format, options.variant);
  exported.code = code.name();
  exported.camera = actual.name;
  exported.fundamental_frequency_hz = frequency_hz;
  exported.exposures = code.exposures();
  exported.taps = code.taps();
  exported.shared_taps = taps_share_a_generator(code, actual);
  exported.light = *actual.light.generator;
  exported.sensor = *actual.sensor.generator;
  const auto arm = [&](const Generator& generator) {
    return ArmTables{
        generator, frequency_hz,
        levels_of(exported.format, exported.variant, generator.amplitude_bits),
        fitting_periods(exported.format, generator.points_in_table(frequency_hz), options.periods)};
  };
  const ArmTables light = arm(exported.light), sensor = arm(exported.sensor);
  actual_code(code, actual);
  for (int e = 0; e < code.exposures(); ++e) {
    exported.waveforms.push_back(light.of(code.modulation(e), true));
    exported.waveforms.back().name = fmt::format("modulation_{}", e + 1);
    exported.waveforms.back().index = e;
  }
  for (int i = 0; i < code.measurements(); i += exported.shared_taps ? 2 : 1) {
    exported.waveforms.push_back(sensor.of(code.demodulation(i), false));
    exported.waveforms.back().name = fmt::format("demodulation_{}", i + 1);
    exported.waveforms.back().arm = Arm::sensor;
    exported.waveforms.back().index = i;
  }
  set_volts(exported, options);
  return exported;
}

}  // namespace tofsmith
