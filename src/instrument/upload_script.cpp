// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/instrument/upload_script.hpp"

#include <fmt/format.h>

#include "instrument/generator_scripts.hpp"
#include "instrument/upload_checks.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/core/sha256.hpp"

namespace tofsmith {

UploadStep told(std::string what, std::string message) {
  UploadStep step;
  step.what = std::move(what);
  step.message = std::move(message);
  return step;
}

UploadStep output_on(std::string message) {
  UploadStep step = told("switch outputs on", std::move(message));
  step.switches_on = true;
  return step;
}

UploadStep asked(std::string what, std::string message, std::vector<AnswerCheck> checks) {
  UploadStep step = told(std::move(what), std::move(message));
  step.answer = UploadStep::Answer::line;
  step.checks = std::move(checks);
  return step;
}

AnswerCheck number_check(int channel, std::string quantity, std::string field, double wanted,
                         double tolerance) {
  AnswerCheck check;
  check.channel = channel;
  check.quantity = std::move(quantity);
  check.field = std::move(field);
  check.wanted = wanted;
  check.tolerance = tolerance;
  return check;
}

AnswerCheck word_check(int channel, std::string quantity, std::string field,
                       std::vector<std::string> texts, bool within) {
  AnswerCheck check;
  check.channel = channel;
  check.quantity = std::move(quantity);
  check.field = std::move(field);
  check.texts = std::move(texts);
  check.within = within;
  return check;
}

double frequency_tolerance_hz(double frequency_hz, double relative) {
  constexpr double resolution_hz = 1e-6;
  return relative * frequency_hz + resolution_hz;
}

std::string memory_name(const QuantizedWaveform& waveform) {
  const auto* const codes = reinterpret_cast<const char*>(waveform.codes.data());
  const std::string hash =
      sha256_hex(std::string_view(codes, waveform.codes.size() * sizeof(waveform.codes[0])));
  std::string name = fmt::format("{}{}_{}", waveform.arm == Arm::light ? "M" : "D",
                                 waveform.index + 1, hash.substr(0, 7));
  for (char& c : name)
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  return name;
}

std::string point_count_problem(std::size_t found, std::size_t wanted) {
  return fmt::format("found {} points; expected the {} that were sent", found, wanted);
}

std::string point_problem(std::size_t index, long found, long wanted) {
  return fmt::format("found {} at point {}; expected {}, as was sent", found, index, wanted);
}

double load_gain(double load_ohm) {
  constexpr double source_ohm = 50.0;
  return std::isinf(load_ohm) ? 2.0 : 2.0 * load_ohm / (load_ohm + source_ohm);
}

UploadScript upload_script(const GeneratorModel& model, const UploadRequest& request) {
  check_upload(model, request);
  UploadScript script;
  script.model = model;
  script.reads_back = request.read_back;
  if (model.family == GeneratorFamily::siglent_x) {
    script.steps = siglent_steps(model, request);
    script.outputs_off = siglent_outputs_off(request);
    return script;
  }
  const bool keysight = model.family == GeneratorFamily::keysight_trueform;
  script.steps = keysight ? keysight_steps(request) : tektronix_steps(request);
  script.outputs_off = scpi_outputs_off(request);
  if (request.channels.size() > 1)
    script.cannot_be_read_back.emplace_back("that the channels start at the same time");
  return script;
}

std::vector<std::string> scpi_outputs_off(const UploadRequest& request) {
  std::vector<std::string> messages;
  for (const UploadChannel& channel : request.channels)
    messages.push_back(fmt::format("OUTP{} OFF", channel.channel));
  return messages;
}

std::string script_text(const UploadScript& script) {
  std::string text = fmt::format(
      "# {} {}{}\n", script.model.vendor, script.model.name,
      script.model.has_error_queue() ? "; behind every message without answer: SYST:ERR?" : "");
  auto out = std::back_inserter(text);
  for (const UploadStep& step : script.steps) {
    text += step.message;
    if (!step.data.empty()) fmt::format_to(out, "<{} bytes>", step.data.size());
    fmt::format_to(out, "  # {}\n", step.what);
  }
  return text;
}

}  // namespace tofsmith
