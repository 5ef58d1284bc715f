// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "simulated_generator.hpp"
#include "simulated_words.hpp"

namespace tofsmith {

std::string SimulatedGenerator::obey_keysight(const std::string& message) {
  int n = 1;
  std::string rest;
  const auto number = [](double value) { return fmt::format("{:+.14E}\n", value); };
  if (matches(message, "SOUR@:DATA:ARB:DAC ", n, rest)) {
    const std::size_t hash = rest.find('#');
    const auto digits = static_cast<std::size_t>(rest[hash + 1] - '0');
    if (rest.size() < hash + 2 + digits) return "";
    store(fmt::format("{}{}", n, rest.substr(0, rest.find(','))), rest.substr(hash + 2 + digits));
  } else if (matches(message, "SOUR@:DATA:VOL:CLE", n, rest)) {
    std::erase_if(memory_, [&](const auto& entry) { return entry.first[0] == '0' + n; });
  } else if (matches(message, "SOUR@:DATA:ATTR:POIN? ", n, rest)) {
    return number(static_cast<double>(memory_[fmt::format("{}{}", n, unquoted(rest))].size()) / 2);
  } else if (matches(message, "SOUR@:FUNC:ARB \"", n, rest)) {
    channels_[n - 1].waveform = fmt::format("{}{}", n, unquoted(rest));
    if (!memory_.contains(channels_[n - 1].waveform))
      errors_.emplace_back("+785,\"Specified arb waveform does not exist\"");
  } else if (matches(message, "SOUR@:FUNC:ARB?", n, rest)) {
    const std::string& name = channels_[n - 1].waveform;
    return fmt::format("\"{}\"\n", name.empty() ? "INT:\\BUILTIN\\EXP_RISE.ARB" : name.substr(1));
  } else if (matches(message, "MMEM:STOR:DATA@ ", n, rest)) {
    const std::string& points = memory_[channels_[n - 1].waveform];
    std::string text = fmt::format(
        "File Format:1.10\nChecksum:0\nChannel Count:1\nSample Rate:40000.000000\nHigh Level:1.0\n"
        "Low Level:-1.0\nMarker Point:1\nData Type:\"short\"\nFilter:\"normal\"\nData Points:{}\n"
        "Data:\n",
        points.size() / 2);
    for (std::size_t i = 0; 2 * i + 1 < points.size(); ++i)
      text += fmt::format("{}\n", as_signed(word_at(points, i, true)));
    files_[unquoted(rest)] = std::move(text);
  } else if (matches(message, "MMEM:UPL? ", n, rest)) {
    const std::string text = files_[unquoted(rest)];
    const std::string length = fmt::format("{}", text.size());
    return fmt::format("#{}{}", length.size(), length) + text + "\n";
  } else if (matches(message, "MMEM:DEL ", n, rest)) {
    files_.erase(unquoted(rest));
  } else if (matches(message, "OUTP@:LOAD?", n, rest)) {
    return number(channels_[n - 1].load_ohm > 1e8 ? 9.9e37 : channels_[n - 1].load_ohm);
  } else if (matches(message, "OUTP@:LOAD ", n, rest)) {
    channels_[n - 1].load_ohm = rest == "INF" ? 1e9 : setting(rest);
  } else if (matches(message, "OUTP@?", n, rest)) {
    return channels_[n - 1].on ? "1\n" : "0\n";
  } else if (matches(message, "OUTP@ O", n, rest)) {
    channels_[n - 1].on = rest == "N";
  } else if (matches(message, "SOUR@:FUNC:ARB:FILT?", n, rest)) {
    return channels_[n - 1].filter + "\n";
  } else if (matches(message, "SOUR@:FUNC:ARB:FILT ", n, rest)) {
    channels_[n - 1].filter = rest;
  } else if (matches(message, "SOUR@:FUNC:ARB:SRAT?", n, rest)) {
    return number(channels_[n - 1].sample_rate_hz);
  } else if (matches(message, "SOUR@:FUNC:ARB:SRAT ", n, rest)) {
    channels_[n - 1].sample_rate_hz = setting(rest);
  } else if (matches(message, "SOUR@:FUNC?", n, rest)) {
    return channels_[n - 1].function + "\n";
  } else if (matches(message, "SOUR@:FUNC ", n, rest)) {
    channels_[n - 1].function = rest;
  } else if (matches(message, "SOUR@:VOLT?", n, rest)) {
    return number(channels_[n - 1].amplitude_vpp);
  } else if (matches(message, "SOUR@:VOLT:OFFS?", n, rest)) {
    return number(channels_[n - 1].offset_v);
  } else if (matches(message, "SOUR@:VOLT:OFFS ", n, rest)) {
    channels_[n - 1].offset_v = setting(rest);
  } else if (matches(message, "SOUR@:VOLT ", n, rest)) {
    channels_[n - 1].amplitude_vpp = setting(rest);
  } else if (message == "FUNC:ARB:SYNC") {
    phases_locked_ = true;
  } else if (message != "FORM:BORD NORM" && !matches(message, "SOUR@:VOLT:UNIT VPP", n, rest)) {
    errors_.emplace_back("-113,\"Undefined header\"");
  }
  return "";
}

}  // namespace tofsmith
