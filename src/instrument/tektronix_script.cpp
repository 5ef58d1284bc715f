// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>

#include "instrument/generator_scripts.hpp"
#include "tofsmith/io/ieee488_block.hpp"
#include "tofsmith/io/tektronix_waveform.hpp"

namespace tofsmith {

namespace {

constexpr double tektronix_frequency_tolerance = 1e-6;

std::string bytes_text(const std::vector<std::byte>& bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// User memories 1 .. 4 take the waveforms of all channels, one after another; all of them pass
/// through the one edit memory.
struct UserMemory {
  int number;
  const QuantizedWaveform* waveform;
};

std::vector<UserMemory> user_memories(const UploadRequest& request) {
  std::vector<UserMemory> memories;
  for (const UploadChannel& channel : request.channels)
    for (const QuantizedWaveform& waveform : channel.stored)
      memories.push_back({static_cast<int>(memories.size()) + 1, &waveform});
  return memories;
}

int selected_memory(const UploadRequest& request, const UploadChannel& channel) {
  const QuantizedWaveform* wanted = &channel.stored[static_cast<std::size_t>(channel.selected)];
  for (const UserMemory& memory : user_memories(request))
    if (memory.waveform == wanted) return memory.number;
  return 0;
}

void load_user_memory(std::vector<UploadStep>& steps, const UserMemory& memory, double more_s) {
  const std::string& name = memory.waveform->name;
  UploadStep load = told("load " + name, "TRAC:DATA EMEM,");
  load.data = bytes_text(ieee488_block(tektronix_afg_bytes(*memory.waveform)));
  load.more_s = more_s;
  steps.push_back(std::move(load));
  steps.push_back(told(fmt::format("keep {} as user memory {}", name, memory.number),
                       fmt::format("TRAC:COPY USER{},EMEM", memory.number)));
  steps.back().more_s = more_s;
}

void check_user_memory(std::vector<UploadStep>& steps, const UserMemory& memory, bool read_back) {
  const std::string& name = memory.waveform->name;
  const auto points = static_cast<double>(memory.waveform->codes.size());
  steps.push_back(told(fmt::format("fetch user memory {}", memory.number),
                       fmt::format("TRAC:COPY EMEM,USER{}", memory.number)));
  steps.push_back(asked("count the points of " + name, "TRAC:POIN? EMEM",
                        {number_check(0, "points", "", points, 0.0)}));
  if (!read_back) return;
  const std::string wanted = bytes_text(tektronix_afg_bytes(*memory.waveform));
  UploadStep check = told("read back " + name, "TRAC:DATA? EMEM");
  check.answer = UploadStep::Answer::block;
  check.most_bytes = wanted.size() + 65536;
  check.problem = [wanted](const std::string& bytes) {
    return bytes == wanted ? "" : points_problem(bytes, wanted) + " (bytes, two for a point)";
  };
  steps.push_back(std::move(check));
}

void set_tektronix_channel(std::vector<UploadStep>& steps, const UploadRequest& request,
                           const UploadChannel& channel) {
  const int n = channel.channel;
  const QuantizedWaveform& w = channel.stored[static_cast<std::size_t>(channel.selected)];
  const auto set = [&](std::string_view what, std::string message) {
    steps.push_back(told(fmt::format("set {} of channel {}", what, n), std::move(message)));
  };
  set("load",
      fmt::format("OUTP{}:IMP {}", n,
                  std::isinf(request.load_ohm) ? "INF" : fmt::format("{:g}OHM", request.load_ohm)));
  set("waveform", fmt::format("SOUR{}:FUNC USER{}", n, selected_memory(request, channel)));
  set("frequency", fmt::format("SOUR{}:FREQ {:.12g}", n, w.repetition_hz()));
  set("unit", fmt::format("SOUR{}:VOLT:UNIT VPP", n));
  set("amplitude", fmt::format("SOUR{}:VOLT:AMPL {:.6g}", n, w.amplitude_vpp()));
  set("offset", fmt::format("SOUR{}:VOLT:OFFS {:.6g}", n, w.offset_v()));
  set("phase", fmt::format("SOUR{}:PHAS:ADJ 0DEG", n));
}

void check_tektronix_channel(std::vector<UploadStep>& steps, const UploadRequest& request,
                             const UploadChannel& channel) {
  const int n = channel.channel;
  const QuantizedWaveform& w = channel.stored[static_cast<std::size_t>(channel.selected)];
  const auto ask = [&](std::string message, AnswerCheck check) {
    steps.push_back(asked(fmt::format("check channel {}", n), std::move(message), {check}));
  };
  const int memory = selected_memory(request, channel);
  std::vector<std::string> names = {fmt::format("USER{}", memory)};
  if (memory == 1) names.emplace_back("USER");
  ask(fmt::format("SOUR{}:FUNC?", n), word_check(n, "waveform", "", names));
  ask(fmt::format("SOUR{}:FREQ?", n),
      number_check(n, "repetition_hz", "", w.repetition_hz(),
                   frequency_tolerance_hz(w.repetition_hz(), tektronix_frequency_tolerance)));
  ask(fmt::format("SOUR{}:VOLT:AMPL?", n),
      number_check(n, "amplitude_vpp", "", w.amplitude_vpp(), volt_tolerance_v));
  ask(fmt::format("SOUR{}:VOLT:OFFS?", n),
      number_check(n, "offset_v", "", w.offset_v(), volt_tolerance_v));
  ask(fmt::format("SOUR{}:PHAS:ADJ?", n), number_check(n, "phase_rad", "", 0.0, 1e-3));
  const double load = std::isinf(request.load_ohm) ? 9.9e37 : request.load_ohm;
  ask(fmt::format("OUTP{}:IMP?", n), number_check(n, "load_ohm", "", load, 1e-2 * load));
}

}  // namespace

std::vector<UploadStep> tektronix_steps(const UploadRequest& request) {
  std::vector<UploadStep> steps;
  const auto check_outputs = [&](bool on) {
    for (const UploadChannel& channel : request.channels)
      steps.push_back(
          asked(fmt::format("check that output {} is {}", channel.channel, on ? "on" : "off"),
                fmt::format("OUTP{}?", channel.channel),
                {word_check(channel.channel, "output", "", {on ? "1" : "0"})}));
  };
  for (const std::string& message : scpi_outputs_off(request))
    steps.push_back(told("switch outputs off", message));
  if (request.reset) {
    steps.push_back(told("reset to defaults", "*RST"));
    steps.back().more_s = request.patience_s;
  }
  check_outputs(false);
  const std::vector<UserMemory> memories = user_memories(request);
  for (const UserMemory& memory : memories) load_user_memory(steps, memory, request.patience_s);
  for (const UserMemory& memory : memories) check_user_memory(steps, memory, request.read_back);
  for (const UploadChannel& channel : request.channels)
    set_tektronix_channel(steps, request, channel);
  steps.push_back(told("start all channels at phase 0", "SOUR1:PHAS:INIT"));
  for (const UploadChannel& channel : request.channels)
    check_tektronix_channel(steps, request, channel);
  check_outputs(false);
  if (!request.output_on) return steps;
  for (const UploadChannel& channel : request.channels)
    steps.push_back(output_on(fmt::format("OUTP{} ON", channel.channel)));
  check_outputs(true);
  return steps;
}

}  // namespace tofsmith
