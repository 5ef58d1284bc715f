// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/waveforms/upload_script.hpp"

#include <fmt/format.h>

#include "core/shared/enum_words.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

namespace {

/// One exposure, or all exposures with one selected.
template <typename IndexOf>
UploadChannel channel_of(const WaveformExport& exported, const UploadSelection& selection,
                         int channel, IndexOf index_of) {
  UploadChannel given{.channel = channel, .stored = {}, .selected = 0};
  for (int e = 1; e <= exported.exposures; ++e) {
    if (!selection.all && e != selection.exposure) continue;
    if (e == selection.exposure) given.selected = static_cast<int>(given.stored.size());
    given.stored.push_back(exported.waveforms[static_cast<std::size_t>(index_of(e - 1))]);
  }
  return given;
}

constexpr EnumWords<WaveHeader, 3> header_words("WaveHeader", "wave_header",
                                                words_of(WaveHeader{}));

}  // namespace

void UploadSelection::validate() const {
  check_fields(*this);
  require(light_channel > 0 || sensor_channel > 0, "sensor_channel", sensor_channel,
          "must be > 0 if light_channel is 0");
}

WaveformExport export_for_model(const CodeSet& code, const Camera& camera,
                                const GeneratorModel& model, ExportOptions options, bool true_arb) {
  options.format = model.format();
  if (!options.sample_rate_hz)
    options.sample_rate_hz = true_arb ? model.true_arb_rate_hz : model.sample_rate_hz;
  const CodeSet resampled = code.resampled(camera.samples);
  return export_waveforms(resampled, exporting_camera(resampled, camera, options), options);
}

std::vector<UploadChannel> selected_channels(const WaveformExport& exported,
                                             const UploadSelection& selection) {
  selection.validate();
  const int taps = exported.shared_taps ? 1 : exported.taps;
  require(
      selection.exposure <= exported.exposures, "exposure", selection.exposure,
      fmt::format("must be at most {}, the exposures of {}", exported.exposures, exported.code));
  require(selection.tap <= taps, "tap", selection.tap,
          fmt::format("must be at most {}, the taps of {}", taps, exported.code));
  std::vector<UploadChannel> channels;
  if (selection.light_channel > 0)
    channels.push_back(
        channel_of(exported, selection, selection.light_channel, [](int e) { return e; }));
  if (selection.sensor_channel > 0)
    channels.push_back(channel_of(exported, selection, selection.sensor_channel, [&](int e) {
      return exported.exposures + e * taps + selection.tap - 1;
    }));
  return channels;
}

std::string parse_output_filter(std::string_view word) {
  if (word == "step") return "STEP";
  if (word == "normal") return "NORM";
  if (word == "off") return "OFF";
  reject("filter", word, "must be step, normal or off");
}

WaveHeader parse_wave_header(std::string_view word) { return header_words.parse(word); }

}  // namespace tofsmith
