// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "waveforms/siglent_waveform.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "tofsmith/core/error.hpp"

namespace tofsmith {

namespace {

constexpr int blank_lines = 7;

int bits_of(WvdtPoints points) { return points == WvdtPoints::bits16_little_endian ? 16 : 14; }

}  // namespace

std::string easywave_csv(const QuantizedWaveform& waveform, EasyWaveDialect dialect) {
  waveform.validate();
  const bool counted = dialect == EasyWaveDialect::easywave;
  std::string text = fmt::format(
      "{},{}\r\nfrequency,{:.9f}\r\namp,{:.9f}\r\noffset,{:.9f}\r\nphase,0.000000000\r\n",
      dialect == EasyWaveDialect::lenth ? "data lenth" : "data length", waveform.points(),
      waveform.repetition_hz(), waveform.amplitude_vpp(), waveform.offset_v());
  for (int i = 0; i < blank_lines; ++i)
    text += dialect == EasyWaveDialect::commas ? ",\r\n" : "\r\n";
  text += "xpos,value\r\n";
  auto out = std::back_inserter(text);
  for (int j = 0; j < waveform.points(); ++j) {
    const double volts = waveform.volts_of(waveform.codes[static_cast<std::size_t>(j)]);
    if (counted)
      fmt::format_to(out, "{},{:.9g}\r\n", j + 1, volts);
    else
      fmt::format_to(out, "{:.9e},{:.9g}\r\n", j / waveform.sample_rate_hz, volts);
  }
  return text;
}

WvdtCommand wvdt_command(const QuantizedWaveform& waveform, WvdtPoints points, int channel) {
  waveform.validate();
  const int levels = 1 << bits_of(points);
  require(waveform.levels == levels, waveform.name + " levels", waveform.levels,
          fmt::format("must be {} for points of {} bits", levels, bits_of(points)));
  WvdtCommand command{.channel = channel,
                      .slot = bits_of(points) == 14 ? "M50" : "",
                      .name = waveform.name,
                      .frequency_hz = waveform.repetition_hz(),
                      .amplitude_vpp = waveform.amplitude_vpp(),
                      .offset_v = waveform.offset_v(),
                      .points = {}};
  for (const std::int32_t code : waveform.codes)
    command.points.push_back(static_cast<std::int16_t>(code - levels / 2));
  return command;
}

namespace {

void check_command(const WvdtCommand& command, int bits) {
  const auto is_word = [](const std::string& text) {
    return std::ranges::all_of(text, [](char c) {
      return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
    });
  };
  require(command.channel >= 1, "WVDT channel", command.channel, "must be >= 1");
  require(!command.name.empty() && is_word(command.name), "WVDT name", command.name,
          "must be letters, digits and _");
  require(is_word(command.slot), "WVDT slot", command.slot, "must be letters and digits");
  require(command.points.size() >= 2, "WVDT points", command.points.size(), "must be >= 2");
  require(bits == 16 || command.points.size() % 512 == 0, "WVDT points", command.points.size(),
          "must be whole kilobytes, a multiple of 512, in the 14-bit form");
  const int limit = 1 << (bits - 1);
  for (const std::int16_t point : command.points)
    require(point >= -limit && point < limit, "WVDT point", point,
            fmt::format("must be in [{}, {}]", -limit, limit - 1));
}

}  // namespace

std::vector<std::byte> wvdt_bytes(const WvdtCommand& command, WvdtPoints points) {
  const int bits = bits_of(points);
  check_command(command, bits);
  std::string text = fmt::format("C{}:WVDT ", command.channel);
  if (!command.slot.empty()) text += command.slot + ",";
  text += fmt::format("WVNM,{},", command.name);
  if (bits == 14) text += fmt::format("TYPE,5,LENGTH,{}KB,", command.points.size() * 2 / 1024);
  text +=
      fmt::format("FREQ,{:.9f},AMPL,{:.9f},OFST,{:.9f},PHASE,{:.9f},WAVEDATA,",
                  command.frequency_hz, command.amplitude_vpp, command.offset_v, command.phase_deg);
  const auto header = std::as_bytes(std::span(text));
  std::vector<std::byte> bytes(header.begin(), header.end());
  bytes.reserve(bytes.size() + 2 * command.points.size());
  const unsigned mask = (1U << bits) - 1U;
  const bool low_first = points != WvdtPoints::bits14_big_endian;
  for (const std::int16_t point : command.points) {
    const unsigned word = static_cast<std::uint16_t>(point) & mask;
    const auto low = static_cast<std::byte>(word & 0xffU), high = static_cast<std::byte>(word >> 8);
    bytes.push_back(low_first ? low : high);
    bytes.push_back(low_first ? high : low);
  }
  return bytes;
}

}  // namespace tofsmith
