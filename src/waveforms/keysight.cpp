// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "waveforms/generator_formats.hpp"

#include <fmt/format.h>

#include <cmath>

#include "tofsmith/core/error.hpp"

namespace tofsmith {

namespace {

constexpr std::int32_t largest = keysight_levels / 2;

void check(const QuantizedWaveform& waveform) {
  waveform.validate();
  require(waveform.levels == keysight_levels, waveform.name + " levels", waveform.levels,
          fmt::format("must be {}", keysight_levels));
}

/// One per line.
std::string keysight_points_text(const QuantizedWaveform& waveform, std::string_view end_of_line) {
  check(waveform);
  std::string text;
  for (const std::int32_t code : waveform.codes)
    fmt::format_to(std::back_inserter(text), "{}{}", code - largest, end_of_line);
  return text;
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

namespace {

void add_keysight_waveform(std::vector<UploadStep>& steps, const UploadRequest& request,
                           int channel, const QuantizedWaveform& waveform) {
  const std::string name = memory_name(waveform);
  UploadStep load =
      message_step("load " + waveform.name, fmt::format("SOUR{}:DATA:ARB:DAC {},", channel, name));
  load.data = text_of(ieee488_block(keysight_dac_bytes(waveform)));
  load.more_s = request.patience_s;
  steps.push_back(std::move(load));
  steps.push_back(message_step("select " + waveform.name,
                               fmt::format("SOUR{}:FUNC:ARB \"{}\"", channel, name)));
  if (!request.read_back) {
    steps.push_back(asked(
        "count the points of " + waveform.name,
        fmt::format("SOUR{}:DATA:ATTR:POIN? \"{}\"", channel, name),
        {number_check(channel, "points", "", static_cast<double>(waveform.codes.size()), 0.0)}));
    return;
  }
  // The instrument cannot return points, only a file saved from them.
  const std::string file = fmt::format("\"INT:\\{}.arb\"", name);
  steps.push_back(
      message_step("save it to a file", fmt::format("MMEM:STOR:DATA{} {}", channel, file)));
  steps.back().more_s = request.patience_s;
  UploadStep check = message_step("read back " + waveform.name, "MMEM:UPL? " + file);
  check.answer = UploadStep::Answer::arb_file;
  check.expected = keysight_points_text(waveform, "\n");
  check.more_s = request.patience_s;
  steps.push_back(std::move(check));
  steps.push_back(message_step("delete the file", "MMEM:DEL " + file));
}

/// Returns the word of a filter in messages.
std::string_view scpi_word(OutputFilter filter) {
  return filter == OutputFilter::step ? "STEP" : filter == OutputFilter::normal ? "NORM" : "OFF";
}

void set_keysight_channel(std::vector<UploadStep>& steps, const UploadRequest& request,
                          const UploadChannel& channel) {
  const int n = channel.channel;
  const QuantizedWaveform& w = channel.selected_waveform();
  ChannelSteps to(steps, n);
  to.set("load",
         fmt::format("OUTP{}:LOAD {}", n,
                     std::isinf(request.load_ohm) ? "INF" : fmt::format("{:g}", request.load_ohm)));
  to.set("waveform", fmt::format("SOUR{}:FUNC:ARB \"{}\"", n, memory_name(w)));
  to.set("function", fmt::format("SOUR{}:FUNC ARB", n));
  to.set("filter", fmt::format("SOUR{}:FUNC:ARB:FILT {}", n, scpi_word(request.filter)));
  to.set("clock", fmt::format("SOUR{}:FUNC:ARB:SRAT {:.12g}", n, w.sample_rate_hz));
  to.set("unit", fmt::format("SOUR{}:VOLT:UNIT VPP", n));
  to.set("amplitude", fmt::format("SOUR{}:VOLT {:.6g}", n, w.amplitude_vpp()));
  to.set("offset", fmt::format("SOUR{}:VOLT:OFFS {:.6g}", n, w.offset_v()));
}

void check_keysight_channel(std::vector<UploadStep>& steps, const UploadRequest& request,
                            const UploadChannel& channel) {
  const int n = channel.channel;
  const QuantizedWaveform& w = channel.selected_waveform();
  ChannelSteps to(steps, n);
  const double load = scpi_load_ohm(request.load_ohm);
  to.ask(fmt::format("SOUR{}:FUNC?", n), {word_check(n, "function", "", {"ARB"})});
  to.ask(fmt::format("SOUR{}:FUNC:ARB?", n),
         {word_check(n, "waveform", "", {memory_name(w)}, true)});
  to.ask(fmt::format("SOUR{}:FUNC:ARB:FILT?", n),
         {word_check(n, "filter", "", {std::string(scpi_word(request.filter))})});
  to.ask(fmt::format("SOUR{}:FUNC:ARB:SRAT?", n),
         {number_check(n, "sample_rate_hz", "", w.sample_rate_hz,
                       frequency_tolerance_hz(w.sample_rate_hz, scpi_frequency_tolerance))});
  to.ask(fmt::format("SOUR{}:VOLT?", n),
         {number_check(n, "amplitude_vpp", "", w.amplitude_vpp(), volt_tolerance_v)});
  to.ask(fmt::format("SOUR{}:VOLT:OFFS?", n),
         {number_check(n, "offset_v", "", w.offset_v(), volt_tolerance_v)});
  to.ask(fmt::format("OUTP{}:LOAD?", n), {number_check(n, "load_ohm", "", load, 1e-3 * load)});
}

}  // namespace

std::vector<UploadStep> keysight_steps(const UploadRequest& request) {
  std::vector<UploadStep> steps;
  begin_scpi(steps, request);
  steps.push_back(message_step("send the high byte first", "FORM:BORD NORM"));
  for (const UploadChannel& channel : request.channels) {
    steps.push_back(message_step(fmt::format("clear the memory of channel {}", channel.channel),
                                 fmt::format("SOUR{}:DATA:VOL:CLE", channel.channel)));
    for (const QuantizedWaveform& waveform : channel.stored)
      add_keysight_waveform(steps, request, channel.channel, waveform);
  }
  for (const UploadChannel& channel : request.channels)
    set_keysight_channel(steps, request, channel);
  if (request.channels.size() > 1)
    steps.push_back(message_step("start both waveforms at once", "FUNC:ARB:SYNC"));
  for (const UploadChannel& channel : request.channels)
    check_keysight_channel(steps, request, channel);
  end_scpi(steps, request);
  return steps;
}

}  // namespace tofsmith
