// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "waveforms/shared/siglent_waveform.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

#include "io/shared/byte_cursor.hpp"
#include "io/text/shared/line_cursor.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

namespace {

int bits_of(WvdtPoints points) { return points == WvdtPoints::bits16_little_endian ? 16 : 14; }

/// Lines of the header, in this order.
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

/// Where "WAVEDATA," ends, at most some hundred bytes from the beginning.
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

/// "C1:WVDT", then key and value in turn; a slot such as M50 stands alone.
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
    std::string_view digits = *text;  // answers carry units: "2000HZ", "4V"
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
  /// "M50", if the first word is one.
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
