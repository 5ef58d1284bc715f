// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>

#include "tofsmith/core/error.hpp"
#include "tofsmith/waveforms/upload_script.hpp"
#include "waveforms/generator_scripts.hpp"

namespace tofsmith {

namespace {

/// By increasing sample rate.
std::vector<GeneratorModel> models_of_format(const std::string& format) {
  std::vector<GeneratorModel> models;
  for (const GeneratorModel& model : generator_models())
    if (model.format() == format && model.channels >= 2) models.push_back(model);
  std::ranges::stable_sort(models, {}, &GeneratorModel::sample_rate_hz);
  return models;
}

struct SharedScript {
  GeneratorModel first;
  std::vector<std::string> names;
  std::string messages;
};

void add(std::vector<SharedScript>& scripts, const UploadScript& script) {
  std::string messages = script_messages(script);
  const auto same = std::ranges::find(scripts, messages, &SharedScript::messages);
  if (same == scripts.end())
    scripts.push_back({script.model, {script.model.name}, std::move(messages)});
  else
    same->names.push_back(script.model.name);
}

}  // namespace

ExportedScripts export_scripts(const WaveformExport& exported) {
  const std::vector<GeneratorModel> models = models_of_format(exported.format.name);
  ExportedScripts result;
  for (int exposure = 1; exposure <= exported.exposures; ++exposure) {
    UploadRequest request;
    request.channels = selected_channels(exported, {.exposure = exposure});
    std::vector<SharedScript> scripts;
    for (const GeneratorModel& model : models) {
      try {
        add(scripts, upload_script(model, request));
      } catch (const std::invalid_argument& error) {
        // Keeps the message of the fastest model, the last one.
        if (exposure == 1) result.problem = error.what();
      }
    }
    for (const SharedScript& script : scripts)
      result.files.push_back({fmt::format("{}_exposure_{}.scpi.txt", script.first.name, exposure),
                              script_heading(script.first, script.names) + script.messages});
  }
  if (!result.files.empty()) result.problem.clear();
  return result;
}

}  // namespace tofsmith
