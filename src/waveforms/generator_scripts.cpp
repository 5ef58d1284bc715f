// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "waveforms/generator_formats.hpp"

#include <fmt/format.h>
#include <sha2.h>

#include <array>
#include <cmath>
#include <cstdint>

#include "core/shared/text_numbers.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

std::vector<std::byte> ieee488_block(std::span<const std::byte> data) {
  require(data.size() <= 999'999'999, "block bytes", data.size(), "must be <= 999999999");
  const std::string length = fmt::format("{}", data.size());
  const std::string header = fmt::format("#{}{}", length.size(), length);
  const auto begin = std::as_bytes(std::span(header));
  std::vector<std::byte> block(begin.begin(), begin.end());
  block.insert(block.end(), data.begin(), data.end());
  return block;
}

namespace {

void check_scpi_outputs(std::vector<UploadStep>& steps, const UploadRequest& request, bool on) {
  for (const UploadChannel& channel : request.channels)
    steps.push_back(
        asked(fmt::format("check that output {} is {}", channel.channel, on ? "on" : "off"),
              fmt::format("OUTP{}?", channel.channel),
              {word_check(channel.channel, "output", "", {on ? "1" : "0"})}));
}

}  // namespace

UploadStep message_step(std::string what, std::string message) {
  return {.what = std::move(what), .message = std::move(message)};
}

UploadStep output_on(std::string message) {
  return {.what = "switch outputs on", .message = std::move(message), .switches_on = true};
}

UploadStep asked(std::string what, std::string message, std::vector<AnswerCheck> checks) {
  UploadStep step = message_step(std::move(what), std::move(message));
  step.answer = UploadStep::Answer::line;
  step.checks = std::move(checks);
  return step;
}

AnswerCheck number_check(int channel, std::string quantity, std::string field, double wanted,
                         double tolerance) {
  return {.channel = channel,
          .quantity = std::move(quantity),
          .field = std::move(field),
          .wanted = wanted,
          .tolerance = tolerance};
}

AnswerCheck word_check(int channel, std::string quantity, std::string field,
                       std::vector<std::string> texts, bool within) {
  return {.channel = channel,
          .quantity = std::move(quantity),
          .field = std::move(field),
          .texts = std::move(texts),
          .within = within};
}

double frequency_tolerance_hz(double frequency_hz, double relative) {
  constexpr double resolution_hz = 1e-6;
  return relative * frequency_hz + resolution_hz;
}

void ChannelSteps::set(std::string_view what, std::string message) {
  steps_.push_back(
      message_step(fmt::format("set {} of channel {}", what, channel_), std::move(message)));
}

void ChannelSteps::ask(std::string message, std::vector<AnswerCheck> checks) {
  steps_.push_back(
      asked(fmt::format("check channel {}", channel_), std::move(message), std::move(checks)));
}

std::vector<std::string> scpi_outputs_off(const UploadRequest& request) {
  std::vector<std::string> messages;
  for (const UploadChannel& channel : request.channels)
    messages.push_back(fmt::format("OUTP{} OFF", channel.channel));
  return messages;
}

void begin_scpi(std::vector<UploadStep>& steps, const UploadRequest& request) {
  for (const std::string& message : scpi_outputs_off(request))
    steps.push_back(message_step("switch outputs off", message));
  if (request.reset) {
    steps.push_back(message_step("reset to defaults", "*RST"));
    steps.back().more_s = request.patience_s;
  }
  check_scpi_outputs(steps, request, false);
}

void end_scpi(std::vector<UploadStep>& steps, const UploadRequest& request) {
  check_scpi_outputs(steps, request, false);
  if (!request.output_on) return;
  for (const UploadChannel& channel : request.channels)
    steps.push_back(output_on(fmt::format("OUTP{} ON", channel.channel)));
  check_scpi_outputs(steps, request, true);
}

double scpi_load_ohm(double load_ohm) { return std::isinf(load_ohm) ? 9.9e37 : load_ohm; }

std::string text_of(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

std::string upper(std::string text) {
  for (char& c : text) c = upper_case(c);
  return text;
}

std::string sha256_hex(std::span<const std::byte> bytes) {
  std::array<char, SHA256_DIGEST_STRING_LENGTH> digits{};
  return SHA256Data(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size(),
                    digits.data());
}

std::string memory_name(const QuantizedWaveform& waveform) {
  const std::string hash = sha256_hex(std::as_bytes(std::span(waveform.codes)));
  return upper(fmt::format("{}{}_{}", waveform.arm == Arm::light ? "M" : "D", waveform.index + 1,
                           hash.substr(0, 7)));
}

}  // namespace tofsmith
