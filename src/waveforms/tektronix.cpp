// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "waveforms/generator_formats.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "io/shared/byte_order.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

namespace {

constexpr std::string_view tfw_magic = "TEKAFG3000";
constexpr std::size_t tfw_header_bytes = 512, tfw_fields_at = 16, tfw_picture_at = 28;
constexpr std::uint32_t tfw_version = 20050114;
constexpr int tfw_picture_columns = 206;  // each has a minimum and a maximum of 8 bits

constexpr std::size_t record_bytes = 5;

void put_u32_big(std::span<std::byte> into, std::uint32_t value) {
  for (std::size_t i = 0; i < 4; ++i) into[i] = static_cast<std::byte>(value >> (24 - 8 * i));
}

void draw(const std::vector<std::int32_t>& codes, std::span<std::byte> picture) {
  const std::size_t columns = std::min<std::size_t>(tfw_picture_columns, codes.size());
  for (std::size_t c = 0; c < columns; ++c) {
    const auto begin = codes.begin() + static_cast<std::ptrdiff_t>(codes.size() * c / columns);
    const auto end = codes.begin() + static_cast<std::ptrdiff_t>(codes.size() * (c + 1) / columns);
    const auto [min, max] = std::minmax_element(begin, end);
    picture[2 * c] = static_cast<std::byte>(*min >> 6);
    picture[2 * c + 1] = static_cast<std::byte>(*max >> 6);
  }
}

/// Big-endian 16-bit numbers, as for TRACe:DATA.
std::vector<std::byte> tektronix_afg_bytes(const QuantizedWaveform& waveform) {
  waveform.validate();
  require(waveform.levels <= tektronix_afg_full_levels, waveform.name + " levels", waveform.levels,
          fmt::format("must be <= {}", tektronix_afg_full_levels));
  std::vector<std::byte> bytes;
  bytes.reserve(2 * waveform.codes.size());
  for (const std::int32_t code : waveform.codes) {
    bytes.push_back(static_cast<std::byte>(code >> 8));
    bytes.push_back(static_cast<std::byte>(code & 0xff));
  }
  return bytes;
}

}  // namespace

std::vector<std::byte> tektronix_tfw(const QuantizedWaveform& waveform) {
  const std::vector<std::byte> points = tektronix_afg_bytes(waveform);
  std::vector<std::byte> file(tfw_header_bytes + points.size());
  std::ranges::copy(std::as_bytes(std::span(tfw_magic)), file.begin());
  const auto fields = std::span(file).subspan(tfw_fields_at);
  put_u32_big(fields, tfw_version);
  put_u32_big(fields.subspan(4), static_cast<std::uint32_t>(waveform.codes.size()));
  put_u32_big(fields.subspan(8), 1);
  draw(waveform.codes, std::span(file).subspan(tfw_picture_at));
  std::ranges::copy(points, file.begin() + tfw_header_bytes);
  return file;
}

std::vector<std::byte> tektronix_wfm(const QuantizedWaveform& waveform,
                                     std::string_view end_of_line) {
  waveform.validate();
  std::vector<std::byte> records(record_bytes * waveform.codes.size());
  for (int j = 0; j < waveform.points(); ++j) {
    std::byte* const record = records.data() + record_bytes * static_cast<std::size_t>(j);
    const double code = waveform.codes[static_cast<std::size_t>(j)];
    store_little_endian(static_cast<float>(2.0 * code / (waveform.levels - 1) - 1.0), record);
    record[4] = static_cast<std::byte>((waveform.trigger_at(j) ? 1 : 0) | (j == 0 ? 2 : 0));
  }
  const std::vector<std::byte> block = ieee488_block(records);
  const std::string begin = fmt::format("MAGIC 1000{}", end_of_line),
                    end = fmt::format("CLOCK {:.10e}{}", waveform.sample_rate_hz, end_of_line);
  std::vector<std::byte> file;
  file.reserve(begin.size() + block.size() + end.size());
  const auto append = [&](std::span<const std::byte> part) {
    file.insert(file.end(), part.begin(), part.end());
  };
  append(std::as_bytes(std::span(begin)));
  append(block);
  append(std::as_bytes(std::span(end)));
  return file;
}

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
