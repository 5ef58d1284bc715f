// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>

#include "tofsmith/core/error.hpp"
#include "tofsmith/waveforms/waveform_export.hpp"
#include "waveforms/generator_formats.hpp"

namespace tofsmith {

namespace {

GeneratorModel siglent(std::string name, double rate_hz, double max_hz, double true_arb_hz,
                       int points) {
  return {.name = std::move(name),
          .vendor = "Siglent Technologies",
          .family = GeneratorFamily::siglent_x,
          .sample_rate_hz = rate_hz,
          .max_repetition_hz = max_hz,
          .true_arb_rate_hz = true_arb_hz,
          .min_points = 8,
          .max_points = points,
          .min_vpp = 0.002,
          .max_vpp = 10.0};
}

GeneratorModel keysight(std::string name, int channels, double rate_hz, int min_points,
                        int points) {
  return {.name = std::move(name),
          .vendor = "Keysight Technologies",
          .family = GeneratorFamily::keysight_trueform,
          .channels = channels,
          .sample_rate_hz = rate_hz,
          .min_points = min_points,
          .max_points = points,
          .min_vpp = 0.001,
          .max_vpp = 10.0};
}

GeneratorModel tektronix(std::string name, double rate_hz, double max_hz, double min_vpp,
                         double max_vpp) {
  const int channels = name.back() - '0';
  return {.name = std::move(name),
          .vendor = "TEKTRONIX",
          .family = GeneratorFamily::tektronix_afg3000,
          .channels = channels,
          .sample_rate_hz = rate_hz,
          .max_repetition_hz = max_hz,
          .min_points = 2,
          .max_points = 131072,
          .memories = 4,
          .min_vpp = min_vpp,
          .max_vpp = max_vpp};
}

std::vector<GeneratorModel> make_models() {
  std::vector<GeneratorModel> models;
  for (const char* name : {"SDG1032X", "SDG1062X"})
    models.push_back(siglent(name, 150e6, 6e6, 0.0, 16384));
  for (const char* name : {"SDG2042X", "SDG2082X", "SDG2122X"})
    models.push_back(siglent(name, 1.2e9, 20e6, 75e6, 8'000'000));
  for (const char* name : {"SDG6022X", "SDG6032X", "SDG6052X"})
    models.push_back(siglent(name, 2.4e9, 50e6, 300e6, 20'000'000));
  for (const char* name : {"33509", "33511", "33510", "33512"})
    models.push_back(keysight(name, (name[4] - '0') % 2 == 1 ? 1 : 2, 160e6, 8, 1'000'000));
  for (const char* name : {"33519", "33521", "33520", "33522"})
    models.push_back(keysight(name, (name[4] - '0') % 2 == 1 ? 1 : 2, 250e6, 8, 1'000'000));
  for (const char* name : {"33611", "33612"})
    models.push_back(keysight(name, name[4] - '0', 660e6, 32, 4'000'000));
  for (const char* name : {"33621", "33622"})
    models.push_back(keysight(name, name[4] - '0', 1e9, 32, 4'000'000));
  models.push_back(tektronix("AFG3011", 250e6, 5e6, 0.04, 20.0));
  for (const char* name : {"AFG3021", "AFG3022"})
    models.push_back(tektronix(name, 250e6, 12.5e6, 0.02, 10.0));
  for (const char* name : {"AFG3051", "AFG3052"})
    models.push_back(tektronix(name, 1e9, 25e6, 0.02, 10.0));
  for (const char* name : {"AFG3101", "AFG3102"})
    models.push_back(tektronix(name, 1e9, 50e6, 0.04, 10.0));
  for (const char* name : {"AFG3151", "AFG3152"})
    models.push_back(tektronix(name, 1e9, 100e6, 0.04, 10.0));
  for (const char* name : {"AFG3251", "AFG3252"})
    models.push_back(tektronix(name, 2e9, 120e6, 0.05, 5.0));
  return models;
}

}  // namespace

std::string GeneratorModel::format() const {
  switch (family) {
    case GeneratorFamily::siglent_x:
      return "siglent-wvdt16";
    case GeneratorFamily::keysight_trueform:
      return "keysight-arb";
    case GeneratorFamily::tektronix_afg3000:
      break;
  }
  return "tek-tfw";
}

const std::vector<GeneratorModel>& generator_models() {
  static const std::vector<GeneratorModel> models = make_models();
  return models;
}

const GeneratorModel* find_generator_model(std::string_view name) {
  const std::string wanted = upper(std::string(name));
  for (const GeneratorModel& model : generator_models()) {
    const bool same = wanted == model.name;
    // Accept the letter of the generation: 33522A and 33522B; AFG3022, AFG3022B and AFG3022C.
    const bool generation =
        model.family != GeneratorFamily::siglent_x && wanted.size() == model.name.size() + 1 &&
        wanted.starts_with(model.name) && wanted.back() >= 'A' && wanted.back() <= 'C';
    if (same || generation) return &model;
  }
  return nullptr;
}

const GeneratorModel& generator_model(std::string_view name) {
  if (const GeneratorModel* model = find_generator_model(name)) return *model;
  std::vector<std::string> names;
  for (const GeneratorModel& model : generator_models()) names.push_back(model.name);
  const std::string near = nearest_word(upper(std::string(name)), names);
  reject("model", fmt::format("'{}'", name),
         fmt::format("must be one of {}{}", known_generators,
                     near.empty() ? "" : fmt::format("; did you mean {}?", near)));
}

double fastest_sample_rate_hz(std::string_view format) {
  double of_format_hz = 0.0, of_all_hz = 0.0;
  for (const GeneratorModel& model : generator_models()) {
    of_all_hz = std::max(of_all_hz, model.sample_rate_hz);
    if (model.format() == format) of_format_hz = std::max(of_format_hz, model.sample_rate_hz);
  }
  return of_format_hz > 0.0 ? of_format_hz : of_all_hz;
}

}  // namespace tofsmith
