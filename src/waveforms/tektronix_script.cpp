// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>

#include "waveforms/generator_scripts.hpp"
#include "waveforms/ieee488_block.hpp"
#include "waveforms/tektronix_waveform.hpp"

namespace tofsmith {

namespace {

/// User memories 1 to 4 of all channels are written via the single edit memory.
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
  const QuantizedWaveform* wanted = &channel.selected_waveform();
  for (const UserMemory& memory : user_memories(request))
    if (memory.waveform == wanted) return memory.number;
  return 0;
}

void load_user_memory(std::vector<UploadStep>& steps, const UserMemory& memory, double more_s) {
  const std::string& name = memory.waveform->name;
  UploadStep load = message_step("load " + name, "TRAC:DATA EMEM,");
  load.data = text_of(ieee488_block(tektronix_afg_bytes(*memory.waveform)));
  load.more_s = more_s;
  steps.push_back(std::move(load));
  steps.push_back(message_step(fmt::format("keep {} as user memory {}", name, memory.number),
                               fmt::format("TRAC:COPY USER{},EMEM", memory.number)));
  steps.back().more_s = more_s;
}

void check_user_memory(std::vector<UploadStep>& steps, const UserMemory& memory, bool read_back) {
  const std::string& name = memory.waveform->name;
  const auto points = static_cast<double>(memory.waveform->codes.size());
  steps.push_back(message_step(fmt::format("fetch user memory {}", memory.number),
                               fmt::format("TRAC:COPY EMEM,USER{}", memory.number)));
  steps.push_back(asked("count the points of " + name, "TRAC:POIN? EMEM",
                        {number_check(0, "points", "", points, 0.0)}));
  if (!read_back) return;
  UploadStep check = message_step("read back " + name, "TRAC:DATA? EMEM");
  check.answer = UploadStep::Answer::block;
  check.expected = text_of(tektronix_afg_bytes(*memory.waveform));
  steps.push_back(std::move(check));
}

void set_tektronix_channel(std::vector<UploadStep>& steps, const UploadRequest& request,
                           const UploadChannel& channel) {
  const int n = channel.channel;
  const QuantizedWaveform& w = channel.selected_waveform();
  ChannelSteps to(steps, n);
  to.set(
      "load",
      fmt::format("OUTP{}:IMP {}", n,
                  std::isinf(request.load_ohm) ? "INF" : fmt::format("{:g}OHM", request.load_ohm)));
  to.set("waveform", fmt::format("SOUR{}:FUNC USER{}", n, selected_memory(request, channel)));
  to.set("frequency", fmt::format("SOUR{}:FREQ {:.12g}", n, w.repetition_hz()));
  to.set("unit", fmt::format("SOUR{}:VOLT:UNIT VPP", n));
  to.set("amplitude", fmt::format("SOUR{}:VOLT:AMPL {:.6g}", n, w.amplitude_vpp()));
  to.set("offset", fmt::format("SOUR{}:VOLT:OFFS {:.6g}", n, w.offset_v()));
  to.set("phase", fmt::format("SOUR{}:PHAS:ADJ 0DEG", n));
}

void check_tektronix_channel(std::vector<UploadStep>& steps, const UploadRequest& request,
                             const UploadChannel& channel) {
  const int n = channel.channel;
  const QuantizedWaveform& w = channel.selected_waveform();
  ChannelSteps to(steps, n);
  const int memory = selected_memory(request, channel);
  std::vector<std::string> names = {fmt::format("USER{}", memory)};
  if (memory == 1) names.emplace_back("USER");
  to.ask(fmt::format("SOUR{}:FUNC?", n), {word_check(n, "waveform", "", names)});
  to.ask(fmt::format("SOUR{}:FREQ?", n),
         {number_check(n, "repetition_hz", "", w.repetition_hz(),
                       frequency_tolerance_hz(w.repetition_hz(), scpi_frequency_tolerance))});
  to.ask(fmt::format("SOUR{}:VOLT:AMPL?", n),
         {number_check(n, "amplitude_vpp", "", w.amplitude_vpp(), volt_tolerance_v)});
  to.ask(fmt::format("SOUR{}:VOLT:OFFS?", n),
         {number_check(n, "offset_v", "", w.offset_v(), volt_tolerance_v)});
  to.ask(fmt::format("SOUR{}:PHAS:ADJ?", n), {number_check(n, "phase_rad", "", 0.0, 1e-3)});
  const double load = scpi_load_ohm(request.load_ohm);
  to.ask(fmt::format("OUTP{}:IMP?", n), {number_check(n, "load_ohm", "", load, 1e-2 * load)});
}

}  // namespace

std::vector<UploadStep> tektronix_steps(const UploadRequest& request) {
  std::vector<UploadStep> steps;
  begin_scpi(steps, request);
  const std::vector<UserMemory> memories = user_memories(request);
  for (const UserMemory& memory : memories) load_user_memory(steps, memory, request.patience_s);
  for (const UserMemory& memory : memories) check_user_memory(steps, memory, request.read_back);
  for (const UploadChannel& channel : request.channels)
    set_tektronix_channel(steps, request, channel);
  steps.push_back(message_step("start all channels at phase 0", "SOUR1:PHAS:INIT"));
  for (const UploadChannel& channel : request.channels)
    check_tektronix_channel(steps, request, channel);
  end_scpi(steps, request);
  return steps;
}

}  // namespace tofsmith
