// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "waveforms/generator_formats.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/shared/text_numbers.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

namespace {

constexpr int blank_lines = 7;

int bits_of(WvdtPoints points) { return points == WvdtPoints::bits16_little_endian ? 16 : 14; }

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
                      .offset_v = waveform.offset_v()};
  for (const std::int32_t code : waveform.codes)
    command.points.push_back(static_cast<std::int16_t>(code - levels / 2));
  return command;
}

namespace {

void check_command(const WvdtCommand& command, int bits) {
  const auto is_word = [](const std::string& text) {
    return std::ranges::all_of(text, [](char c) { return is_letter_or_digit(c) || c == '_'; });
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

namespace {

constexpr double siglent_frequency_tolerance = 1e-5;  // answers have six digits
constexpr WvdtPoints x_points = WvdtPoints::bits16_little_endian;

std::string wvdt_message(const WvdtCommand& command, WaveHeader header) {
  std::string message = text_of(wvdt_bytes(command, x_points));
  const std::size_t mark = message.find("WAVEDATA,");
  if (header == WaveHeader::length)
    message.insert(mark, fmt::format("LENGTH,{}B,", 2 * command.points.size()));
  if (header == WaveHeader::minimal)
    message =
        fmt::format("C{}:WVDT WVNM,{},", command.channel, command.name) + message.substr(mark);
  return message;
}

/// Siglent generators have no error queue; the answer confirms that earlier messages were
/// processed.
UploadStep siglent_settled(std::string what, double more_s) {
  UploadStep step = asked(std::move(what), "*OPC?", {word_check(0, "", "", {"1", "*OPC 1"})});
  step.more_s = more_s;
  return step;
}

void add_siglent_waveform(std::vector<UploadStep>& steps, const UploadRequest& request, int channel,
                          const QuantizedWaveform& waveform) {
  WvdtCommand command = wvdt_command(waveform, x_points, channel);
  command.name = memory_name(waveform);
  const std::string message = wvdt_message(command, request.wave_header);
  const std::size_t data = message.find("WAVEDATA,") + 9;
  UploadStep load = message_step("load " + waveform.name, message.substr(0, data));
  load.data = message.substr(data);
  load.line_end = false;  // a line end would be read as a point
  load.pause_s = request.settle_s;
  steps.push_back(std::move(load));
  steps.push_back(siglent_settled("wait until it has " + waveform.name, request.patience_s));
  if (!request.read_back) return;
  UploadStep check = message_step("read back " + waveform.name, "WVDT? USER," + command.name);
  check.answer = UploadStep::Answer::wave_data;
  check.checks = {word_check(0, "", "WVNM", {command.name}, true)};
  check.expected = message.substr(data);
  steps.push_back(std::move(check));
}

void set_siglent_channel(std::vector<UploadStep>& steps, const UploadRequest& request,
                         const UploadChannel& channel, bool has_rate) {
  const int n = channel.channel;
  const QuantizedWaveform& w = channel.selected_waveform();
  ChannelSteps to(steps, n);
  to.set("load and polarity",
         fmt::format("C{}:OUTP LOAD,{},PLRT,NOR", n,
                     std::isinf(request.load_ohm) ? "HZ" : fmt::format("{:g}", request.load_ohm)));
  to.set("waveform", fmt::format("C{}:ARWV NAME,{}", n, memory_name(w)));
  to.set("kind of waveform", fmt::format("C{}:BSWV WVTP,ARB", n));
  if (has_rate)
    to.set("clock", request.true_arb
                        ? fmt::format("C{}:SRATE MODE,TARB,VALUE,{:.12g}", n, w.sample_rate_hz)
                        : fmt::format("C{}:SRATE MODE,DDS", n));
  if (!request.true_arb)
    to.set("frequency", fmt::format("C{}:BSWV FRQ,{:.12g}", n, w.repetition_hz()));
  to.set("amplitude", fmt::format("C{}:BSWV AMP,{:.6g}", n, w.amplitude_vpp()));
  to.set("offset", fmt::format("C{}:BSWV OFST,{:.6g}", n, w.offset_v()));
  to.set("phase", fmt::format("C{}:BSWV PHSE,0", n));
}

void check_siglent_channel(std::vector<UploadStep>& steps, const UploadRequest& request,
                           const UploadChannel& channel, bool has_rate) {
  const int n = channel.channel;
  const QuantizedWaveform& w = channel.selected_waveform();
  ChannelSteps to(steps, n);
  to.ask(fmt::format("C{}:ARWV?", n), {word_check(n, "waveform", "NAME", {memory_name(w)}, true)});
  std::vector<AnswerCheck> checks = {
      word_check(n, "function", "WVTP", {"ARB"}),
      number_check(n, "amplitude_vpp", "AMP", w.amplitude_vpp(), volt_tolerance_v),
      number_check(n, "offset_v", "OFST", w.offset_v(), volt_tolerance_v),
      number_check(n, "phase_deg", "PHSE", 0.0, 0.01)};
  if (!request.true_arb)
    checks.push_back(
        number_check(n, "repetition_hz", "FRQ", w.repetition_hz(),
                     frequency_tolerance_hz(w.repetition_hz(), siglent_frequency_tolerance)));
  to.ask(fmt::format("C{}:BSWV?", n), std::move(checks));
  if (has_rate) {
    std::vector<AnswerCheck> rate = {
        word_check(n, "clock", "MODE", {request.true_arb ? "TARB" : "DDS"})};
    if (request.true_arb)
      rate.push_back(
          number_check(n, "sample_rate_hz", "VALUE", w.sample_rate_hz,
                       frequency_tolerance_hz(w.sample_rate_hz, siglent_frequency_tolerance)));
    to.ask(fmt::format("C{}:SRATE?", n), std::move(rate));
  }
}

UploadStep siglent_output_check(int n, bool on, double load_ohm, bool with_load) {
  std::vector<AnswerCheck> checks = {word_check(n, "output", "", {on ? "ON" : "OFF"})};
  if (with_load) {
    checks.push_back(std::isinf(load_ohm) ? word_check(n, "load_ohm", "LOAD", {"HZ"})
                                          : number_check(n, "load_ohm", "LOAD", load_ohm, 0.5));
    checks.push_back(word_check(n, "polarity", "PLRT", {"NOR"}));
  }
  return asked(fmt::format("check that output {} is {}", n, on ? "on" : "off"),
               fmt::format("C{}:OUTP?", n), std::move(checks));
}

}  // namespace

std::vector<std::string> siglent_outputs_off(const UploadRequest& request) {
  std::vector<std::string> messages;
  for (const UploadChannel& channel : request.channels)
    messages.push_back(fmt::format("C{}:OUTP OFF", channel.channel));
  return messages;
}

std::vector<UploadStep> siglent_steps(const GeneratorModel& model, const UploadRequest& request) {
  std::vector<UploadStep> steps;
  const bool has_rate = model.true_arb_rate_hz > 0.0;
  for (const std::string& message : siglent_outputs_off(request))
    steps.push_back(message_step("switch outputs off", message));
  if (request.reset) {
    steps.push_back(message_step("reset to defaults", "*RST"));
    steps.push_back(siglent_settled("wait until it is reset", request.patience_s));
  }
  for (const UploadChannel& channel : request.channels)
    steps.push_back(siglent_output_check(channel.channel, false, 0.0, false));
  for (const UploadChannel& channel : request.channels)
    for (const QuantizedWaveform& waveform : channel.stored)
      add_siglent_waveform(steps, request, channel.channel, waveform);
  for (const UploadChannel& channel : request.channels)
    set_siglent_channel(steps, request, channel, has_rate);
  if (request.channels.size() > 1)  // sources disagree; an unknown spelling is ignored
    for (const char* spelling : {"MODE PHASE-LOCKED", "MODE PHASELOCKED"})
      steps.push_back(message_step("lock the phases of the channels", spelling));
  for (const UploadChannel& channel : request.channels)
    check_siglent_channel(steps, request, channel, has_rate);
  if (request.channels.size() > 1)
    steps.push_back(asked("check that phases are locked", "MODE?",
                          {word_check(0, "phase_mode", "", {"LOCKED"}, true)}));
  for (const UploadChannel& channel : request.channels)
    steps.push_back(siglent_output_check(channel.channel, false, request.load_ohm, true));
  if (!request.output_on) return steps;
  for (const UploadChannel& channel : request.channels)
    steps.push_back(output_on(fmt::format("C{}:OUTP ON", channel.channel)));
  for (const UploadChannel& channel : request.channels)
    steps.push_back(siglent_output_check(channel.channel, true, request.load_ohm, true));
  return steps;
}

}  // namespace tofsmith
