// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/waveforms/upload_script.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "tofsmith/core/error.hpp"
#include "waveforms/generator_formats.hpp"

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

namespace {

constexpr double rounding = 1.0 + 1e-9;

void check_rate(const GeneratorModel& model, const UploadRequest& request,
                const QuantizedWaveform& waveform) {
  const bool plays_every_point =
      request.true_arb || model.family == GeneratorFamily::keysight_trueform;
  const double max_hz = request.true_arb ? model.true_arb_rate_hz : model.sample_rate_hz;
  if (plays_every_point)
    require(waveform.sample_rate_hz <= max_hz * rounding, waveform.name + " sample_rate_hz",
            waveform.sample_rate_hz,
            fmt::format("must be at most {:g}, the limit of {}; reduce --samples or the frequency",
                        max_hz, model.name));
  if (model.max_repetition_hz > 0.0)
    require(waveform.repetition_hz() <= model.max_repetition_hz * rounding,
            waveform.name + " repetition_hz", waveform.repetition_hz(),
            fmt::format(
                "must be at most {:g}, the limit of {}; increase --periods or reduce the frequency",
                model.max_repetition_hz, model.name));
}

void check_volts(const GeneratorModel& model, double load_ohm, const QuantizedWaveform& waveform) {
  const double gain = load_gain(load_ohm);
  require(waveform.amplitude_vpp() >= model.min_vpp * gain / rounding &&
              waveform.amplitude_vpp() <= model.max_vpp * gain * rounding,
          waveform.name + " amplitude_vpp", waveform.amplitude_vpp(),
          fmt::format("must be in [{:g}, {:g}], the range of {} with a load of {:g} ohm",
                      model.min_vpp * gain, model.max_vpp * gain, model.name, load_ohm));
  const double reach = std::max(std::abs(waveform.low_v), std::abs(waveform.high_v));
  require(reach <= 0.5 * model.max_vpp * gain * rounding, waveform.name + " volts", reach,
          fmt::format("must be at most {:g} from zero, the limit of {} with a load of {:g} ohm",
                      0.5 * model.max_vpp * gain, model.name, load_ohm));
}

void check_table(const GeneratorModel& model, const QuantizedWaveform& waveform) {
  waveform.validate();
  const WaveformFormat& format = waveform_format(model.format());
  require(waveform.levels == format.levels, waveform.name + " levels", waveform.levels,
          fmt::format("must be the {} of {}", format.levels, format.name));
  require(waveform.points() >= model.min_points && waveform.points() <= model.max_points,
          waveform.name + " points", waveform.points(),
          fmt::format(
              "must be in [{}, {}], the limits of the memory of {}; change --samples or --periods",
              model.min_points, model.max_points, model.name));
}

void check_channels(const GeneratorModel& model, const UploadRequest& request) {
  for (std::size_t i = 0; i < request.channels.size(); ++i) {
    const UploadChannel& channel = request.channels[i];
    require(channel.channel >= 1 && channel.channel <= model.channels, "channel", channel.channel,
            fmt::format("must be in [1, {}], the channels of {}", model.channels, model.name));
    for (std::size_t j = 0; j < i; ++j)
      require(request.channels[j].channel != channel.channel, "channel", channel.channel,
              "must be different for light and sensor");
    require(
        channel.selected >= 0 && static_cast<std::size_t>(channel.selected) < channel.stored.size(),
        "selected", channel.selected, "must be the index of a stored waveform");
  }
}

void check_memory(const GeneratorModel& model, const UploadRequest& request) {
  std::size_t tables = 0;
  for (const UploadChannel& channel : request.channels) {
    tables += channel.stored.size();
    std::int64_t points = 0;
    for (const QuantizedWaveform& waveform : channel.stored) points += waveform.points();
    if (model.family == GeneratorFamily::keysight_trueform)
      require(points <= model.max_points, fmt::format("channel {} points", channel.channel), points,
              fmt::format("must be at most {}, the size of the memory of {}; upload one exposure "
                          "at a time, or reduce --samples",
                          model.max_points, model.name));
  }
  if (model.memories > 0)
    require(tables <= static_cast<std::size_t>(model.memories), "waveforms", tables,
            fmt::format(
                "must be at most {}, the number of memories of {}; upload one exposure at a time",
                model.memories, model.name));
}

/// @throws std::invalid_argument naming the part of the request that does not fit
void check_upload(const GeneratorModel& model, const UploadRequest& request) {
  require(!request.channels.empty(), "channels", 0, "must be at least one");
  require((request.load_ohm >= 1.0 && request.load_ohm <= 1e6) || std::isinf(request.load_ohm),
          "load_ohm", request.load_ohm, "must be in [1, 1e6] or infinite");
  check_fields(request);
  if (request.true_arb)
    require(model.true_arb_rate_hz > 0.0, "true_arb", "on",
            fmt::format("must be off: {} does not support this mode", model.name));
  check_channels(model, request);
  for (const UploadChannel& channel : request.channels)
    for (const QuantizedWaveform& waveform : channel.stored) {
      check_table(model, waveform);
      check_rate(model, request, waveform);
      check_volts(model, request.load_ohm, waveform);
    }
  check_memory(model, request);
}

}  // namespace

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
  script.channels = request.channels;
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

std::string script_heading(const GeneratorModel& model, const std::vector<std::string>& names) {
  return fmt::format(
      "# {} {}{}\n", model.vendor, fmt::join(names, ", "),
      model.has_error_queue() ? "; after every message without answer: SYST:ERR?" : "");
}

std::string script_messages(const UploadScript& script) {
  std::string text;
  auto out = std::back_inserter(text);
  for (const UploadStep& step : script.steps) {
    text += step.message;
    if (!step.data.empty()) fmt::format_to(out, "<{} bytes>", step.data.size());
    fmt::format_to(out, "  # {}\n", step.what);
  }
  return text;
}

std::string script_text(const UploadScript& script) {
  return script_heading(script.model, {script.model.name}) + script_messages(script);
}

}  // namespace tofsmith
