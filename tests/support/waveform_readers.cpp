// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "waveform_readers.hpp"

#include <cmath>
#include <string>

#include "core/shared/text_numbers.hpp"
#include "io/shared/byte_order.hpp"

namespace tofsmith {

namespace {

std::string_view characters(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

std::string_view after(std::string_view text, std::string_view key) {
  const std::size_t at = text.find(key);
  return at == std::string_view::npos ? std::string_view() : text.substr(at + key.size());
}

std::string_view between(std::string_view text, std::string_view begin, std::string_view end) {
  const std::string_view rest = after(text, begin);
  return rest.substr(0, rest.find(end));
}

double number_after(std::string_view text, std::string_view key) {
  std::string_view rest = after(text, key);
  return take_number(rest).value_or(NAN);
}

std::vector<std::string_view> lines_of(std::string_view text) {
  std::vector<std::string_view> lines;
  for (; !text.empty(); text = after(text, "\n"))
    lines.push_back(trimmed(text.substr(0, text.find('\n'))));
  return lines;
}

/// Points of two bytes, in two's complement of `bits` bits.
std::vector<std::int16_t> signed_points(std::span<const std::byte> bytes, int bits,
                                        bool low_first) {
  std::vector<std::int16_t> points;
  for (std::size_t i = 0; i + 1 < bytes.size(); i += 2) {
    const int first = std::to_integer<int>(bytes[i]), second = std::to_integer<int>(bytes[i + 1]);
    const int word = low_first ? first + 256 * second : 256 * first + second;
    const bool is_negative = word >> (bits - 1) != 0;
    points.push_back(static_cast<std::int16_t>(is_negative ? word - (1 << bits) : word));
  }
  return points;
}

}  // namespace

EasyWaveTable parse_easywave_csv(std::string_view text) {
  EasyWaveTable table{.frequency_hz = number_after(text, "\nfrequency,"),
                      .amplitude_vpp = number_after(text, "\namp,"),
                      .offset_v = number_after(text, "\noffset,"),
                      .volts = {}};
  for (const std::string_view row : lines_of(after(text, "\nxpos,value\r\n")))
    table.volts.push_back(number_after(row, ","));
  table.volts.resize(static_cast<std::size_t>(number_after(text, ",")));  // "data length,"
  return table;
}

WvdtCommand parse_wvdt(std::span<const std::byte> bytes, WvdtPoints points) {
  constexpr std::string_view mark = "WAVEDATA,";
  const std::size_t begin = characters(bytes).find(mark) + mark.size();
  const std::string_view header = characters(bytes).substr(0, begin);
  const std::string_view slot = between(header, "WVDT ", "WVNM,");
  return {.channel = static_cast<int>(number_after(header, "C")),
          .slot = std::string(slot.substr(0, slot.find(','))),
          .name = std::string(between(header, "WVNM,", ",")),
          .frequency_hz = number_after(header, "FREQ,"),
          .amplitude_vpp = number_after(header, "AMPL,"),
          .offset_v = number_after(header, "OFST,"),
          .phase_deg = number_after(header, "PHASE,"),
          .points = signed_points(bytes.subspan(begin),
                                  points == WvdtPoints::bits16_little_endian ? 16 : 14,
                                  points != WvdtPoints::bits14_big_endian)};
}

KeysightArb parse_keysight_arb(std::string_view text) {
  KeysightArb arb{.sample_rate_hz = number_after(text, "Sample Rate:"),
                  .high_level_v = number_after(text, "High Level:"),
                  .low_level_v = number_after(text, "Low Level:"),
                  .marker_point = number_after(text, "Marker Point:"),
                  .points = {}};
  for (std::string_view line : lines_of(trimmed(after(text, "Data:"))))
    arb.points.push_back(static_cast<std::int16_t>(take_number(line).value_or(NAN)));
  arb.points.resize(static_cast<std::size_t>(number_after(text, "Data Points:")));
  return arb;
}

std::vector<std::int16_t> parse_keysight_dac_bytes(std::span<const std::byte> bytes) {
  return signed_points(bytes, 16, false);
}

std::vector<std::int32_t> parse_tektronix_tfw(std::span<const std::byte> bytes) {
  constexpr std::size_t header_bytes = 512, count_at = 20;
  const std::vector<std::int16_t> points = signed_points(bytes.subspan(header_bytes), 16, false);
  std::size_t count = 0;
  for (const std::byte byte : bytes.subspan(count_at, 4))
    count = 256 * count + std::to_integer<std::size_t>(byte);
  std::vector<std::int32_t> result(points.begin(), points.end());
  result.resize(count);
  return result;
}

TektronixWfm parse_tektronix_wfm(std::span<const std::byte> bytes) {
  constexpr std::size_t record_bytes = 5;
  const std::string_view text = characters(bytes);
  const auto records = parse_ieee488_block(bytes.subspan(text.find('#')));
  TektronixWfm wfm;
  wfm.sample_rate_hz = number_after(text.substr(text.rfind("CLOCK")), "CLOCK ");
  for (std::size_t at = 0; at + record_bytes <= records.size(); at += record_bytes) {
    wfm.values.push_back(load_little_endian<float>(records.data() + at));
    wfm.markers.push_back(std::to_integer<std::uint8_t>(records[at + 4]));
  }
  return wfm;
}

std::span<const std::byte> parse_ieee488_block(std::span<const std::byte> bytes) {
  const std::string_view text = characters(bytes);  // "#", digits of the length, length, data
  std::string_view length = text.substr(2, static_cast<std::size_t>(text[1] - '0'));
  const std::size_t begin = 2 + length.size();
  return bytes.subspan(begin, static_cast<std::size_t>(take_number(length).value_or(0.0)));
}

PatternWords parse_pattern(std::string_view text, const PatternSyntax& syntax) {
  PatternWords result;
  for (const std::string_view line : lines_of(after(text, syntax.begin))) {
    const std::string_view word = after(line, syntax.mark);
    const std::string digits(word.substr(0, word.find_first_not_of("0123456789abcdefABCDEF")));
    if (digits.empty()) continue;  // a comment, or the end
    if (result.words.empty()) result.digits = static_cast<int>(digits.size());
    result.words.push_back(std::stoull(digits, nullptr, syntax.radix));
  }
  return result;
}

}  // namespace tofsmith
