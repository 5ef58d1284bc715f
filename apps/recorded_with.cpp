// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "recorded_with.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <utility>

#include "tofsmith/core/error.hpp"
#include "tofsmith/io/camera_toml.hpp"
#include "tofsmith/io/decoding_table_file.hpp"

namespace tofsmith::apps {

namespace {

namespace fs = std::filesystem;

bool is_file(const fs::path& path) {
  std::error_code ignored;
  return fs::is_regular_file(path, ignored);
}

bool is_same_file(const fs::path& a, const fs::path& b) {
  std::error_code ignored;
  return fs::equivalent(a, b, ignored);
}

/// Keys that determine the raw numbers and that a calibration does not change.
constexpr std::array<std::string_view, 7> recording_keys = {
    "fundamental_frequency_hz", "sensor.taps",     "sensor.drain",         "sensor.readout",
    "sensor.demodulation",      "sensor.adc_bits", "sensor.black_level_dn"};

nlohmann::json value_of(const nlohmann::json& camera, std::string_view key) {
  const auto dot = key.find('.');
  const nlohmann::json& table = dot == key.npos ? camera : camera.at(key.substr(0, dot));
  return table.value(key.substr(dot == key.npos ? 0 : dot + 1), nlohmann::json("none"));
}

/// Returns texts such as "sensor.taps = 2 instead of 1".
std::vector<std::string> differing_keys(const Camera& camera, const Camera& recorded) {
  const auto here = nlohmann::json::parse(camera_to_json(camera)),
             there = nlohmann::json::parse(camera_to_json(recorded));
  std::vector<std::string> differences;
  for (const std::string_view key : recording_keys) {
    const nlohmann::json a = value_of(here, key), b = value_of(there, key);
    if (a != b)
      differences.push_back(fmt::format("{} = {} instead of {}", key, a.dump(), b.dump()));
  }
  return differences;
}

/// Returns the warning about a camera file next to raw frames; none without a difference. The file
/// may be damaged, since another camera is used.
std::optional<std::string> camera_warning(const fs::path& file, const Camera& camera) {
  try {
    const auto differences = differing_keys(camera, load_camera(file.string()));
    if (differences.empty()) return std::nullopt;
    return fmt::format("warning: the camera differs from {}: {}", file.string(),
                       fmt::join(differences, ", "));
  } catch (const IoError& error) {
    return fmt::format("warning: {}; this file next to the raw frames is not used", error.what());
  }
}

/// Returns true if two codes have different correlation functions on a camera, or if the camera
/// does not support the recorded one.
bool differs(const std::string& code, const std::string& recorded, const Camera& camera,
             const CodeFileOptions& file_options) {
  constexpr double rounding = 1e-6;
  const DecodingTableOptions options{.file = file_options};
  try {
    const auto here = load_decoding_table(code, camera, options).table.correlation,
               there = load_decoding_table(recorded, camera).table.correlation;
    return here.rows() != there.rows() || here.cols() != there.cols() ||
           (here - there).cwiseAbs().maxCoeff() > rounding * there.cwiseAbs().maxCoeff();
  } catch (const IoError&) {
    return true;
  } catch (const std::invalid_argument&) {
    return true;
  }
}

}  // namespace

fs::path code_beside(const fs::path& raw) { return fs::path(raw).replace_extension(".code.json"); }

std::string recorded_code(const fs::path& raw) {
  const fs::path beside = code_beside(raw);
  if (is_file(beside)) return beside.string();
  throw UsageError(
      fmt::format("--code is required, because {} does not exist next to the raw frames; expected "
                  "a family (`tofsmith codes` lists them), a code file or a measured table",
                  beside.string()));
}

std::vector<std::string> recording_conflicts(const fs::path& raw, const std::string& code,
                                             const Camera& camera,
                                             const CodeFileOptions& file_options) {
  std::vector<std::string> warnings;
  const fs::path recorded_camera = camera_beside(raw), recorded = code_beside(raw);
  if (is_file(recorded_camera))
    if (auto warning = camera_warning(recorded_camera, camera))
      warnings.push_back(std::move(*warning));
  if (warnings.empty() && is_file(recorded) && !is_same_file(code, recorded) &&
      !names_measured_table(code) && differs(code, recorded.string(), camera, file_options))
    warnings.push_back(
        fmt::format("warning: the code {} differs from {}; without --code, the code of that file "
                    "is used",
                    code, recorded.string()));
  return warnings;
}

}  // namespace tofsmith::apps
