// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/instrument/upload_script.hpp"

#include <fmt/format.h>

#include "instrument/generator_scripts.hpp"
#include "instrument/upload_checks.hpp"

namespace tofsmith {

double load_gain(double load_ohm) {
  constexpr double source_ohm = 50.0;
  return std::isinf(load_ohm) ? 2.0 : 2.0 * load_ohm / (load_ohm + source_ohm);
}

const QuantizedWaveform& UploadChannel::selected_waveform() const {
  return stored.at(static_cast<std::size_t>(selected));
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
