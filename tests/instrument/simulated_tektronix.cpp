// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "simulated_generator.hpp"
#include "simulated_words.hpp"

namespace tofsmith {

std::string SimulatedGenerator::obey_tektronix(const std::string& message) {
  int n = 1;
  std::string rest;
  const auto number = [](double value) { return fmt::format("{:.11E}\n", value); };
  if (message.starts_with("TRAC:DATA EMEM,#")) {
    const auto digits = static_cast<std::size_t>(message[16] - '0') % 10;
    if (message.size() < 17 + digits) return "";
    store("EMEM", message.substr(17 + digits));
  } else if (message.starts_with("TRAC:COPY USER") && message.ends_with(",EMEM")) {
    store(message.substr(10, 5), memory_["EMEM"]);
  } else if (message.starts_with("TRAC:COPY EMEM,USER")) {
    memory_["EMEM"] = memory_[message.substr(15)];
  } else if (message == "TRAC:POIN? EMEM") {
    return fmt::format("{}\n", memory_["EMEM"].size() / 2);
  } else if (message == "TRAC:DATA? EMEM") {
    const std::string length = fmt::format("{}", memory_["EMEM"].size());
    return fmt::format("#{}{}", length.size(), length) + memory_["EMEM"] + "\n";
  } else if (matches(message, "SOUR@:FUNC?", n, rest)) {
    const Channel& c = channels_[n - 1];
    return (c.function == "USER" ? c.waveform : c.function) + "\n";
  } else if (matches(message, "SOUR@:FUNC USER", n, rest)) {
    channels_[n - 1].function = "USER";
    channels_[n - 1].waveform = "USER" + rest;
  } else if (matches(message, "SOUR@:FREQ?", n, rest)) {
    return number(channels_[n - 1].frequency_hz);
  } else if (matches(message, "SOUR@:FREQ ", n, rest)) {
    channels_[n - 1].frequency_hz = setting(rest);
  } else if (matches(message, "SOUR@:VOLT:AMPL?", n, rest)) {
    return number(channels_[n - 1].amplitude_vpp);
  } else if (matches(message, "SOUR@:VOLT:AMPL ", n, rest)) {
    channels_[n - 1].amplitude_vpp = setting(rest);
  } else if (matches(message, "SOUR@:VOLT:OFFS?", n, rest)) {
    return number(channels_[n - 1].offset_v);
  } else if (matches(message, "SOUR@:VOLT:OFFS ", n, rest)) {
    channels_[n - 1].offset_v = setting(rest);
  } else if (matches(message, "SOUR@:PHAS:ADJ?", n, rest)) {
    return number(channels_[n - 1].phase);
  } else if (matches(message, "SOUR@:PHAS:ADJ ", n, rest)) {
    channels_[n - 1].phase = setting(rest);
  } else if (matches(message, "SOUR@:PHAS:INIT", n, rest)) {
    phases_locked_ = true;
  } else if (matches(message, "OUTP@:IMP?", n, rest)) {
    return number(channels_[n - 1].load_ohm > 1e8 ? 9.9e37 : channels_[n - 1].load_ohm);
  } else if (matches(message, "OUTP@:IMP ", n, rest)) {
    channels_[n - 1].load_ohm = rest == "INF" ? 1e9 : setting(rest);
  } else if (matches(message, "OUTP@?", n, rest)) {
    return channels_[n - 1].on ? "1\n" : "0\n";
  } else if (matches(message, "OUTP@ O", n, rest)) {
    channels_[n - 1].on = rest == "N";
  } else if (!matches(message, "SOUR@:VOLT:UNIT VPP", n, rest)) {
    errors_.emplace_back("-113,\"Undefined header\"");
  }
  return "";
}

}  // namespace tofsmith
