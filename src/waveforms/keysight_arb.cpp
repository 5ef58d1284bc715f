// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "waveforms/keysight_arb.hpp"

#include <fmt/format.h>

#include "tofsmith/core/error.hpp"

namespace tofsmith {

namespace {

constexpr std::int32_t largest = keysight_levels / 2;

void check(const QuantizedWaveform& waveform) {
  waveform.validate();
  require(waveform.levels == keysight_levels, waveform.name + " levels", waveform.levels,
          fmt::format("must be {}", keysight_levels));
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
  return text + keysight_points_text(waveform, end_of_line);
}

std::string keysight_points_text(const QuantizedWaveform& waveform, std::string_view end_of_line) {
  check(waveform);
  std::string text;
  for (const std::int32_t code : waveform.codes)
    fmt::format_to(std::back_inserter(text), "{}{}", code - largest, end_of_line);
  return text;
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

}  // namespace tofsmith
