// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/waveforms/waveform_export.hpp"

#include <fmt/ranges.h>

#include "tofsmith/core/error.hpp"
#include "waveforms/keysight_arb.hpp"
#include "waveforms/tektronix_waveform.hpp"

namespace tofsmith {

namespace {

constexpr auto per_waveform = FormatContent::one_waveform;

WaveformFormat memory_format(std::string name, std::string extension, std::string description) {
  return {.name = std::move(name),
          .extension = std::move(extension),
          .description = std::move(description),
          .content = FormatContent::words,
          .default_bits = 1,
          .trigger = "top bit of every word",
          .variants = {}};
}

std::vector<WaveformFormat> generator_formats() {
  return {
      {.name = "siglent-csv",
       .extension = ".csv",
       .description = "Siglent SDG, EasyWave CSV of 16384 rows",
       .content = per_waveform,
       .min_points = 16384,
       .max_points = 16384,
       .skips_points = true,
       .trigger = "",
       .variants = {{"easywave", "\"data length\", empty lines, rows counted from 1"},
                    {"lenth", "\"data lenth\", empty lines, rows by time"},
                    {"commas", "\"data length\", lines of one comma, rows by time"}}},
      {.name = "siglent-wvdt14",
       .extension = ".wvdt",
       .description = "Siglent SDG800 to SDG5000, WVDT command of 14 bits",
       .content = per_waveform,
       .min_points = 16384,
       .max_points = 16384,
       .levels = 1 << 14,
       .max_bits = 14,
       .skips_points = true,
       .trigger = "",
       .variants = {{"little-endian", "low byte first"}, {"big-endian", "high byte first"}}},
      {.name = "siglent-wvdt16",
       .extension = ".wvdt",
       .description = "Siglent SDG X series, WVDT command of 16 bits",
       .content = per_waveform,
       .levels = 1 << 16,
       .default_bits = 16,
       .skips_points = true,
       .trigger = "",
       .variants = {}},
      {.name = "keysight-arb",
       .extension = ".arb",
       .description = "Keysight 33500 and 33600, .arb text",
       .content = per_waveform,
       .min_points = 8,
       .max_points = 1'000'000,
       .levels = keysight_levels,
       .default_bits = 16,
       .trigger = "Marker Point: sync is high before it",
       .variants = {{"lf", "lines end with LF"}, {"crlf", "lines end with CR LF"}}},
      {.name = "tek-tfw",
       .extension = ".tfw",
       .description = "Tektronix AFG1000 to AFG31000, .tfw",
       .content = per_waveform,
       .max_points = 131072,
       .levels = tektronix_afg_levels,
       .max_bits = 14,
       .skips_points = true,
       .trigger = "",
       .variants = {{"16382", "codes 0 .. 16382"}, {"16383", "codes 0 .. 16383"}}},
      {.name = "tek-wfm",
       .extension = ".wfm",
       .description = "Tektronix AWG400 to AWG700, .wfm \"MAGIC 1000\"",
       .content = per_waveform,
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
                     .trigger = "column trigger",
                     .variants = {}});
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

}  // namespace tofsmith
