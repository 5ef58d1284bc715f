// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

#include "io/text/shared/line_cursor.hpp"
#include "tofsmith/core/error.hpp"
#include "waveform_readers.hpp"

namespace tofsmith {

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
