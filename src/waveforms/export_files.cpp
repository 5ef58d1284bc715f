// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <numeric>
#include <span>

#include "tofsmith/core/error.hpp"
#include "tofsmith/version.hpp"
#include "tofsmith/waveforms/upload_script.hpp"
#include "tofsmith/waveforms/waveform_export.hpp"
#include "waveforms/generator_formats.hpp"
#include "waveforms/pattern_memory.hpp"

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
  if (models.empty() && exported.format.content == FormatContent::one_waveform)
    result.problem =
        fmt::format("no supported generator with two channels reads {}", exported.format.name);
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

namespace {

std::vector<std::byte> bytes_of_text(std::string_view text) {
  const auto bytes = std::as_bytes(std::span(text));
  return {bytes.begin(), bytes.end()};
}

std::vector<std::byte> waveform_file(const QuantizedWaveform& waveform,
                                     const WaveformExport& exported) {
  const std::string& format = exported.format.name;
  const int variant = exported.variant;
  if (format == "siglent-csv")
    return bytes_of_text(easywave_csv(waveform, static_cast<EasyWaveDialect>(variant)));
  if (format == "siglent-wvdt14" || format == "siglent-wvdt16") {
    const auto points = format == "siglent-wvdt16" ? WvdtPoints::bits16_little_endian
                        : variant == 0             ? WvdtPoints::bits14_little_endian
                                                   : WvdtPoints::bits14_big_endian;
    return wvdt_bytes(wvdt_command(waveform, points, waveform.arm == Arm::light ? 1 : 2), points);
  }
  if (format == "keysight-arb")
    return bytes_of_text(keysight_arb_text(waveform, variant == 0 ? "\n" : "\r\n"));
  if (format == "tek-tfw") return tektronix_tfw(waveform);
  require(format == "tek-wfm", "format", format, "has no writer");
  constexpr std::string_view line_ends[] = {"\r\n", "\n", " \r\n"};
  return tektronix_wfm(waveform, line_ends[variant]);
}

std::string memory_comment(const WaveformExport& exported) {
  const double clock_hz =
      exported.waveforms.front().points_per_period() * exported.fundamental_frequency_hz;
  return fmt::format(
      "{} on {}, written by tofsmith {}\n"
      "{} exposures, {} points per period, clock {:.9g} Hz (period {:.9g} Hz)",
      exported.code, exported.camera, TOFSMITH_VERSION, exported.exposures,
      exported.waveforms.front().points_per_period(), clock_hz, exported.fundamental_frequency_hz);
}

std::string memory_text(const WaveformExport& exported) {
  const PatternMemory memory =
      pattern_memory(exported.waveforms, exported.exposures, memory_comment(exported));
  const std::string& format = exported.format.name;
  if (format == "xilinx-coe") return xilinx_coe(memory);
  if (format == "intel-mif") return intel_mif(memory);
  if (format == "verilog-mem") return verilog_mem(memory);
  if (format == "systemverilog") return systemverilog_package(memory);
  if (format == "vhdl") return vhdl_package(memory);
  return c_header(memory);
}

using Json = nlohmann::ordered_json;

Json generator_json(const Generator& generator, double frequency_hz) {
  Json json = {{"table_points", generator.points_in_table(frequency_hz)},
               {"actual_points", generator.points_per_period(frequency_hz)},
               {"sample_rate_hz", generator.sample_rate_hz},
               {"amplitude_bits", generator.amplitude_bits}};
  if (generator.edge_grid_s) json["edge_grid_s"] = *generator.edge_grid_s;
  return json;
}

Json waveform_json(const QuantizedWaveform& waveform, const WaveformExport& exported) {
  Json json = {{"name", waveform.name}, {"arm", name_of(waveform.arm)}};
  const int taps = exported.taps;
  if (waveform.arm == Arm::light) {
    json["exposure"] = waveform.index + 1;
  } else {
    json["exposure"] = waveform.index / taps + 1;
    json["tap"] = waveform.index % taps + 1;
    json["tap_value"] = waveform.index + 1;
  }
  json["points"] = waveform.points();
  json["periods"] = waveform.periods;
  json["sample_rate_hz"] = waveform.sample_rate_hz;
  json["repetition_hz"] = waveform.repetition_hz();
  json["levels"] = waveform.levels;
  json["full_scale"] = waveform.full_scale;
  json["low_v"] = waveform.low_v;
  json["high_v"] = waveform.high_v;
  return json;
}

Json fields_json(const WaveformExport& exported) {
  Json json = Json::array();
  for (const PatternField& field :
       pattern_memory(exported.waveforms, exported.exposures, "").fields)
    json.push_back({{"name", field.name}, {"first_bit", field.first_bit}, {"bits", field.bits}});
  return json;
}

}  // namespace

std::string quantized_csv(const std::vector<QuantizedWaveform>& waveforms) {
  require(!waveforms.empty(), "waveforms", 0, "must be at least one");
  std::string text = "time_s,trigger";
  auto out = std::back_inserter(text);
  for (const QuantizedWaveform& waveform : waveforms) {
    waveform.validate();
    require(waveform.points() == waveforms.front().points(), waveform.name + " points",
            waveform.points(), "must be equal for all waveforms in a table");
    fmt::format_to(out, ",{}", waveform.name);
  }
  for (int j = 0; j < waveforms.front().points(); ++j) {
    fmt::format_to(out, "\n{:.9g},{}", j / waveforms.front().sample_rate_hz,
                   waveforms.front().trigger_at(j) ? 1 : 0);
    for (const QuantizedWaveform& waveform : waveforms)
      fmt::format_to(out, ",{:.9g}",
                     waveform.value_of(waveform.codes[static_cast<std::size_t>(j)]));
  }
  return text + "\n";
}

std::vector<ExportedFile> export_files(const WaveformExport& exported) {
  std::vector<ExportedFile> files;
  if (exported.format.content == FormatContent::one_waveform) {
    for (std::size_t i = 0; i < exported.waveforms.size(); ++i)
      files.push_back({exported.waveforms[i].name + exported.format.extension,
                       waveform_file(exported.waveforms[i], exported),
                       {static_cast<int>(i)}});
    return files;
  }
  std::vector<int> all(exported.waveforms.size());
  std::iota(all.begin(), all.end(), 0);
  const bool words = exported.format.content == FormatContent::words;
  files.push_back({(words ? "pattern" : "waveforms") + exported.format.extension,
                   bytes_of_text(words ? memory_text(exported) : quantized_csv(exported.waveforms)),
                   std::move(all)});
  return files;
}

std::string export_manifest(const WaveformExport& exported,
                            const std::vector<ExportedFile>& files) {
  const WaveformFormat& format = exported.format;
  const double frequency_hz = exported.fundamental_frequency_hz;
  Json json = {{"tofsmith", TOFSMITH_VERSION}, {"format", format.name}};
  if (!format.variants.empty())
    json["variant"] = format.variants[static_cast<std::size_t>(exported.variant)].name;
  json["code"] = exported.code;
  json["camera"] = exported.camera;
  json["fundamental_frequency_hz"] = frequency_hz;
  json["exposures"] = exported.exposures;
  json["taps"] = exported.taps;
  if (exported.shared_taps) json["second_tap"] = "1 - the first tap";
  if (!format.trigger.empty()) json["trigger"] = format.trigger;
  json["light"] = generator_json(exported.light, frequency_hz);
  json["sensor"] = generator_json(exported.sensor, frequency_hz);
  if (format.content == FormatContent::words) json["fields"] = fields_json(exported);
  json["files"] = Json::array();
  for (const ExportedFile& file : files) {
    Json entry = {{"file", file.name},
                  {"bytes", file.bytes.size()},
                  {"sha256", sha256_hex(file.bytes)},
                  {"waveforms", Json::array()}};
    for (const int index : file.waveforms)
      entry["waveforms"].push_back(
          waveform_json(exported.waveforms[static_cast<std::size_t>(index)], exported));
    json["files"].push_back(std::move(entry));
  }
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace tofsmith
