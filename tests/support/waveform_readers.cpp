// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "waveform_readers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

#include "core/shared/text_numbers.hpp"
#include "io/byte_cursor.hpp"
#include "io/shared/byte_order.hpp"
#include "io/text/shared/line_cursor.hpp"
#include "tofsmith/core/error.hpp"
#include "waveforms/keysight.hpp"
#include "waveforms/tektronix.hpp"

namespace tofsmith {

namespace {

constexpr std::int32_t largest = keysight_levels / 2;
constexpr std::string_view tfw_magic = "TEKAFG3000";
constexpr std::size_t tfw_header_bytes = 512, tfw_fields_at = 16;
constexpr std::uint32_t tfw_version = 20050114;
constexpr std::size_t record_bytes = 5;

std::int16_t checked_point(LineCursor& lines, std::string_view text) {
  const auto number = finite_number_in(text);
  if (!number || *number != std::floor(*number) || std::abs(*number) > largest)
    lines.fail(fmt::format("found '{}'; expected a whole number in [-32767, 32767]", text));
  return static_cast<std::int16_t>(*number);
}

std::uint32_t take_u32_big(ByteCursor& cursor, std::string_view what) {
  std::uint32_t value = 0;
  for (const std::byte byte : cursor.take(4, what))
    value = value << 8 | std::to_integer<std::uint32_t>(byte);
  return value;
}

}  // namespace

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

std::vector<std::int32_t> parse_tektronix_tfw(std::span<const std::byte> bytes,
                                              std::string_view file) {
  ByteCursor cursor(bytes, file);
  if (cursor.take_text(tfw_magic.size(), "the header") != tfw_magic)
    cursor.fail_at(0, fmt::format("found no '{}'; expected a .tfw file", tfw_magic));
  cursor.take(tfw_fields_at - tfw_magic.size(), "the header");
  if (const auto version = take_u32_big(cursor, "the version"); version != tfw_version)
    cursor.fail_at(tfw_fields_at,
                   fmt::format("found version {}; expected {}", version, tfw_version));
  const std::size_t count = take_u32_big(cursor, "the number of points");
  cursor.take(tfw_header_bytes - cursor.position(), "the header");
  if (cursor.rest().size() != 2 * count || count < 2)
    cursor.fail(
        fmt::format("found {} bytes of points; expected {}, two for each of {} points (2 "
                    "or more)",
                    cursor.rest().size(), 2 * count, count));
  std::vector<std::int32_t> points;
  while (!cursor.at_end()) {
    const auto pair = cursor.take(2, "a point");
    points.push_back(std::to_integer<int>(pair[0]) << 8 | std::to_integer<int>(pair[1]));
    if (points.back() >= tektronix_afg_full_levels)
      cursor.fail_at(cursor.position() - 2,
                     fmt::format("found the point {}; expected 14 bits", points.back()));
  }
  return points;
}

TektronixWfm parse_tektronix_wfm(std::span<const std::byte> bytes, std::string_view file) {
  ByteCursor cursor(bytes, file);
  if (trimmed(cursor.take_until('\n', "the first line")) != "MAGIC 1000")
    cursor.fail_at(0, "found no 'MAGIC 1000'; expected a .wfm file of an AWG");
  const std::size_t begin = cursor.position();
  const Ieee488Block block =
      parse_ieee488_block(cursor.rest(), fmt::format("{} from {}", file, begin));
  cursor.take(block.size, "the points");
  if (block.data.size() % record_bytes != 0 || block.data.empty())
    cursor.fail_at(
        begin, fmt::format("found {} bytes of points; expected five for each", block.data.size()));
  TektronixWfm wfm;
  for (std::size_t at = 0; at < block.data.size(); at += record_bytes) {
    const auto value = load_little_endian<float>(block.data.data() + at);
    if (!(std::abs(value) <= 1.0F))
      cursor.fail_at(begin + block.size - block.data.size() + at,
                     fmt::format("found the value {}; expected -1 .. 1", value));
    wfm.values.push_back(value);
    wfm.markers.push_back(std::to_integer<std::uint8_t>(block.data[at + 4]));
  }
  if (cursor.at_end()) return wfm;  // optional: without a clock, an AWG keeps its own
  const std::size_t clock_at = cursor.position();
  const std::string_view clock = trimmed(cursor.take_until('\n', "the clock"));
  const auto rate = clock.starts_with("CLOCK") ? finite_number_in(clock.substr(5)) : std::nullopt;
  if (!rate || *rate <= 0.0 || !cursor.at_end())
    cursor.fail_at(clock_at, "expected 'CLOCK', the points per second and the end of the file");
  wfm.sample_rate_hz = *rate;
  return wfm;
}

Ieee488Block parse_ieee488_block(std::span<const std::byte> bytes, std::string_view place) {
  ByteCursor cursor(bytes, place);
  if (cursor.take_text(1, "a block's #") != "#")
    cursor.fail_at(0, "found no '#'; expected a block of IEEE 488.2");
  const char digits = cursor.take_text(1, "a block's number of digits").front();
  if (digits < '1' || digits > '9')
    cursor.fail_at(
        1, fmt::format("found '{}'; expected the number of digits of the length, 1 to 9", digits));
  std::size_t length = 0;
  for (const char digit : cursor.take_text(static_cast<std::size_t>(digits - '0'), "the length")) {
    if (digit < '0' || digit > '9')
      cursor.fail_at(2, fmt::format("found '{}' in the length; expected digits", digit));
    length = 10 * length + static_cast<std::size_t>(digit - '0');
  }
  const auto data = cursor.take(length, "the block's data");
  return {data, cursor.position()};
}

namespace {

int bits_of(WvdtPoints points) { return points == WvdtPoints::bits16_little_endian ? 16 : 14; }

constexpr std::string_view header_keys[] = {"frequency", "amp", "offset", "phase"};
constexpr int blank_lines = 7;

double required_number(LineCursor& lines, std::string_view text, std::string_view what) {
  const auto number = finite_number_in(text);
  if (!number) lines.fail(fmt::format("{}: found '{}'; expected a number", what, text));
  return *number;
}

/// "key,value"
double header_value(LineCursor& lines, std::string_view key) {
  const std::string_view line = lines.next();
  if (!line.starts_with(key) || line.substr(key.size(), 1) != ",")
    lines.fail(fmt::format("found '{}'; expected '{},' and a number", line, key));
  return required_number(lines, line.substr(key.size() + 1), key);
}

std::size_t row_count(LineCursor& lines) {
  std::string_view line = lines.next();
  const bool known = line.starts_with("data length,") || line.starts_with("data lenth,");
  const double count =
      known ? required_number(lines, line.substr(line.find(',') + 1), "data length") : 0.0;
  if (!known || count < 2 || count > 1 << 26 || count != std::floor(count))
    lines.fail(fmt::format("found '{}'; expected 'data length,' and the number of rows", line));
  return static_cast<std::size_t>(count);
}

/// Returns the end of "WAVEDATA,", which must occur within the first few hundred bytes.
std::size_t find_data(std::string_view text, std::string_view place) {
  constexpr std::string_view mark = "WAVEDATA,";
  constexpr std::size_t max_header_bytes = 1000;
  const std::size_t at = text.substr(0, max_header_bytes).find(mark);
  if (at == std::string_view::npos)
    throw IoError(fmt::format("{}: byte 0", place),
                  fmt::format("found no '{}' in the first {} bytes; expected a WVDT command", mark,
                              max_header_bytes));
  return at + mark.size();
}

/// Header "C1:WVDT" followed by keys and values in turn; a slot such as M50 has no value.
class WvdtHeader {
 public:
  WvdtHeader(std::string_view text, std::string_view place) : place_(place) {
    std::size_t start = text.find("WVDT");
    if (start == std::string_view::npos) fail("found no WVDT");
    prefix_ = text.substr(0, start);
    for (start += 4; start < text.size();) {
      const std::size_t end = std::min(text.find(',', start), text.size());
      words_.push_back(trimmed(text.substr(start, end - start)));
      start = end + 1;
    }
  }

  std::optional<std::string_view> value(std::string_view key) const {
    for (std::size_t i = 0; i + 1 < words_.size(); ++i)
      if (words_[i] == key) return words_[i + 1];
    return std::nullopt;
  }
  double number(std::string_view key) const {
    const auto text = value(key);
    if (!text) fail(fmt::format("found no {}", key));
    std::string_view digits = *text;  // answers contain units: "2000HZ", "4V"
    digits = digits.substr(0, digits.find_last_of("0123456789.") + 1);
    const auto number = finite_number_in(digits);
    if (!number) fail(fmt::format("{}: found '{}'; expected a number", key, *text));
    return *number;
  }
  int channel() const {
    const std::size_t c = prefix_.rfind('C');
    int channel = 1;
    if (c == std::string_view::npos) return channel;
    std::from_chars(prefix_.data() + c + 1, prefix_.data() + prefix_.size(), channel);
    return channel;
  }
  std::string slot() const {
    return !words_.empty() && words_[0].starts_with('M') ? std::string(words_[0]) : std::string();
  }
  [[noreturn]] void fail(std::string_view problem) const {
    throw IoError(fmt::format("{}: byte 0", place_),
                  fmt::format("{}; expected C1:WVDT .. WVNM,name,FREQ,..,AMPL,..,OFST,..,PHASE,..,"
                              "WAVEDATA,",
                              problem));
  }

 private:
  std::string_view place_, prefix_;
  std::vector<std::string_view> words_;
};

}  // namespace

EasyWaveTable parse_easywave_csv(std::string_view text, std::string_view file) {
  LineCursor lines(text, file);
  const std::size_t rows = row_count(lines);
  EasyWaveTable table;
  double* const values[] = {&table.frequency_hz, &table.amplitude_vpp, &table.offset_v,
                            &table.phase_deg};
  for (std::size_t i = 0; i < std::size(values); ++i)
    *values[i] = header_value(lines, header_keys[i]);
  for (int i = 0; i < blank_lines; ++i)
    if (const auto line = lines.next(); !line.empty() && line != ",")
      lines.fail(fmt::format("found '{}'; expected {} blank lines", line, blank_lines));
  if (const auto line = lines.next(); line != "xpos,value")
    lines.fail(fmt::format("found '{}'; expected 'xpos,value'", line));
  table.volts.reserve(rows);
  while (table.volts.size() < rows) {
    const std::string_view line = lines.next();
    const std::size_t comma = line.find(',');
    if (comma == std::string_view::npos)
      lines.fail(fmt::format("found '{}'; expected a position, a comma and a value", line));
    table.volts.push_back(required_number(lines, line.substr(comma + 1), "value"));
  }
  lines.expect_end();
  return table;
}

WvdtCommand parse_wvdt(std::span<const std::byte> bytes, WvdtPoints points,
                       std::string_view place) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const std::size_t begin = find_data(text, place);
  const WvdtHeader header(text.substr(0, begin), place);
  WvdtCommand command{.channel = header.channel(),
                      .slot = header.slot(),
                      .name = std::string(header.value("WVNM").value_or("")),
                      .frequency_hz = header.number("FREQ"),
                      .amplitude_vpp = header.number("AMPL"),
                      .offset_v = header.number("OFST"),
                      .phase_deg = header.number("PHASE"),
                      .points = {}};
  if (command.name.empty()) header.fail("found no WVNM");
  auto data = bytes.subspan(begin);
  if (data.size() % 2 == 1 && data.back() == std::byte{'\n'}) data = data.first(data.size() - 1);
  if (data.size() % 2 == 1 || data.size() < 4)
    throw IoError(fmt::format("{}: byte {}", place, begin),
                  fmt::format("found {} bytes of points; expected two for each, and at least 4",
                              data.size()));
  const int bits = bits_of(points);
  if (const auto length = header.value("LENGTH"); length && length->ends_with("KB")) {
    const double kilobytes = header.number("LENGTH");
    if (kilobytes * 1024 != static_cast<double>(data.size()))
      throw IoError(fmt::format("{}: byte {}", place, begin),
                    fmt::format("found {} bytes of points; expected {}, as LENGTH says",
                                data.size(), kilobytes * 1024));
  }
  const bool low_first = points != WvdtPoints::bits14_big_endian;
  for (std::size_t i = 0; i < data.size(); i += 2) {
    const auto a = std::to_integer<unsigned>(data[i]), b = std::to_integer<unsigned>(data[i + 1]);
    const unsigned word = low_first ? a | b << 8 : b | a << 8;
    if (bits == 14 && word >> 14 != 0)
      throw IoError(fmt::format("{}: byte {}", place, begin + i),
                    fmt::format("found the point 0x{:04x}; expected 14 bits (is the byte order "
                                "right?)",
                                word));
    const int signed_word = static_cast<int>(word) - (word >> (bits - 1) != 0 ? 1 << bits : 0);
    command.points.push_back(static_cast<std::int16_t>(signed_word));
  }
  return command;
}

}  // namespace tofsmith
