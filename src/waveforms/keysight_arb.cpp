// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "waveforms/shared/keysight_arb.hpp"

#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "io/text/shared/line_cursor.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

namespace {

constexpr std::int32_t largest = keysight_levels / 2;

void check(const QuantizedWaveform& waveform) {
  waveform.validate();
  require(waveform.levels == keysight_levels, waveform.name + " levels", waveform.levels,
          fmt::format("must be {}", keysight_levels));
}

std::int16_t checked_point(LineCursor& lines, std::string_view text) {
  const auto number = finite_number_in(text);
  if (!number || *number != std::floor(*number) || std::abs(*number) > largest)
    lines.fail(fmt::format("found '{}'; expected a whole number in [-32767, 32767]", text));
  return static_cast<std::int16_t>(*number);
}

}  // namespace

std::string keysight_arb_text(const QuantizedWaveform& waveform, std::string_view end_of_line) {
  check(waveform);
  int marker = 1;
  while (marker < waveform.points() && waveform.trigger_at(marker)) ++marker;
  std::string text = fmt::format(
      "File Format:1.10{0}Checksum:0{0}Channel Count:1{0}Sample Rate:{1:.9f}{0}High Level:{2:.9f}"
      "{0}Low Level:{3:.9f}{0}Marker Point:{4}{0}Data Type:\"short\"{0}Filter:\"off\"{0}"
      "Data Points:{5}{0}Data:{0}",
      end_of_line, waveform.sample_rate_hz, waveform.high_v, waveform.low_v, marker,
      waveform.points());
  for (const std::int32_t code : waveform.codes)
    fmt::format_to(std::back_inserter(text), "{}{}", code - largest, end_of_line);
  return text;
}

KeysightArb parse_keysight_arb(std::string_view text, std::string_view file) {
  LineCursor lines(text, file);
  KeysightArb arb;
  std::optional<double> points;
  bool has_format = false;
  for (std::string_view line = lines.next(); line != "Data:"; line = lines.next()) {
    const std::size_t colon = line.find(':');
    if (colon == std::string_view::npos)
      lines.fail(fmt::format("found '{}'; expected 'Key:value', or 'Data:'", line));
    const std::string_view key = line.substr(0, colon), value = line.substr(colon + 1);
    const auto number = [&] {
      const auto found = finite_number_in(value);
      if (!found) lines.fail(fmt::format("{}: found '{}'; expected a number", key, value));
      return *found;
    };
    if (key == "File Format")
      has_format = trimmed(value) == "1.10";
    else if (key == "Sample Rate")
      arb.sample_rate_hz = number();
    else if (key == "High Level")
      arb.high_level_v = number();
    else if (key == "Low Level")
      arb.low_level_v = number();
    else if (key == "Marker Point")
      arb.marker_point = static_cast<int>(std::min(1e9, std::max(0.0, number())));
    else if (key == "Data Points")
      points = number();
    else if (key == "Channel Count" && number() != 1.0)
      lines.fail(fmt::format("found {} channels; expected 1", value));
    else if (key == "Data Type" && trimmed(value) != "\"short\"" && trimmed(value) != "\"Short\"")
      lines.fail(fmt::format("found the data type {}; expected \"short\"", value));
  }
  if (!has_format) lines.fail("found no 'File Format:1.10' above");
  if (arb.sample_rate_hz <= 0.0) lines.fail("found no positive 'Sample Rate' above");
  while (!lines.at_end()) {
    const std::string_view line = lines.next();
    if (line.empty()) continue;
    arb.points.push_back(checked_point(lines, line));
  }
  if (!points || *points != static_cast<double>(arb.points.size()))
    lines.fail(fmt::format("found {} points; expected {}, as Data Points says", arb.points.size(),
                           points ? fmt::format("{}", *points) : "a number"));
  return arb;
}

std::vector<std::byte> keysight_dac_bytes(const QuantizedWaveform& waveform) {
  check(waveform);
  std::vector<std::byte> bytes;
  bytes.reserve(2 * waveform.codes.size());
  for (const std::int32_t code : waveform.codes) {
    const auto word = static_cast<std::uint16_t>(code - largest);
    bytes.push_back(static_cast<std::byte>(word >> 8));
    bytes.push_back(static_cast<std::byte>(word & 0xffU));
  }
  return bytes;
}

std::vector<std::int16_t> parse_keysight_dac_bytes(std::span<const std::byte> bytes,
                                                   std::string_view place) {
  if (bytes.size() % 2 != 0)
    throw IoError(place, fmt::format("found {} bytes; expected two for each point", bytes.size()));
  std::vector<std::int16_t> points;
  for (std::size_t i = 0; i < bytes.size(); i += 2) {
    const unsigned word =
        std::to_integer<unsigned>(bytes[i]) << 8 | std::to_integer<unsigned>(bytes[i + 1]);
    const auto point = static_cast<std::int16_t>(word);
    if (point < -largest)
      throw IoError(fmt::format("{}: byte {}", place, i),
                    fmt::format("found {}; expected points in [-32767, 32767]", point));
    points.push_back(point);
  }
  return points;
}

}  // namespace tofsmith
