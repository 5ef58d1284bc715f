// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/io/camera_toml.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "core/shared/text_numbers.hpp"
#include "io/documents/lens_calibration.hpp"
#include "io/shared/read_file.hpp"
#include "io/text/field_reader.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/io/measured_table_file.hpp"

namespace tofsmith {

namespace {

bool is_part_of_name(char c) { return is_letter_or_digit(c) || c == '_'; }

/// Returns the position in the file of a field that Camera::validate() reports, or of its table.
std::string place_of_field(const std::string& field, const TableReader::Places& places,
                           const std::string& source_name) {
  std::string place = source_name;
  for (const auto& [key, where] : places)
    if (field.starts_with(key) &&
        (field.size() == key.size() || !is_part_of_name(field[key.size()])))
      place = where;
  return place;
}

void load_response(const std::string& name, const FieldReader& reader,
                   const TableReader::Places& places, ImpulseResponse& response) {
  if (response.kind != ImpulseResponse::Kind::file) return;
  const auto file = reader.files().find(name + ".file");
  if (file == reader.files().end()) return;
  std::optional<double> time_step_s;
  if (places.contains(name + ".time_step_s")) time_step_s = response.time_step_s;
  response = read_impulse_response(file->second, time_step_s);
}

void load_lens(const FieldReader& reader, const TomlDocument& document, std::optional<Lens>& lens) {
  const auto file = reader.files().find("lens.calibration");
  if (file == reader.files().end()) return;
  std::optional<DistortionModel> model;
  if (lens->distortion) model = lens->distortion->model;
  const auto camera = document.root().at_path("lens.calibration_camera").value_or(std::string());
  lens = read_lens_calibration(file->second, model, camera);
}

}  // namespace

Camera parse_camera_toml(std::string_view text, std::string_view source_name, Settings settings) {
  TomlDocument document(text, source_name);
  document.suggest_keys([](std::string_view key) {
    const std::string similar = similar_camera_key(key);
    return similar == key ? "" : similar;  // a key under another condition
  });
  for (const std::string& setting : settings) document.apply(setting);

  Camera camera;
  camera.name = std::filesystem::path(source_name).stem().string();
  camera.operating = default_operating_range();
  TableReader::Places places;
  TableReader table(document, places);
  FieldReader reader(table);
  describe(reader, camera);
  table.finish();
  load_response("light.impulse_response", reader, places, camera.light.impulse_response);
  load_response("sensor.impulse_response", reader, places, camera.sensor.impulse_response);
  load_lens(reader, document, camera.lens);
  try {
    camera.validate();
  } catch (const InvalidArgument& error) {
    throw IoError(place_of_field(error.field(), places, document.source_name()), error.what());
  }
  return camera;
}

Camera read_camera_toml(const std::filesystem::path& path, Settings settings) {
  return parse_camera_toml(read_text_file(path, max_settings_file_bytes), path.string(), settings);
}

Camera with_settings(const Camera& camera, Settings settings) {
  return parse_camera_toml(camera_to_toml(camera), camera.name, settings);
}

Camera load_camera(const std::string& name_or_path, Settings settings) {
  const std::vector<std::string> names = built_in_camera_names();
  if (name_or_path.empty())
    throw IoError("camera", fmt::format("found an empty name; expected a file or one of {}",
                                        fmt::join(names, ", ")));
  if (std::find(names.begin(), names.end(), name_or_path) != names.end())
    return with_settings(built_in_camera(name_or_path), settings);
  std::error_code ignored;
  if (std::filesystem::exists(name_or_path, ignored))
    return read_camera_toml(name_or_path, settings);
  const std::string near = nearest_word(name_or_path, names);
  throw IoError(name_or_path,
                fmt::format("there is no such file and no built-in camera of that name ({}){}",
                            fmt::join(names, ", "),
                            near.empty() ? "" : fmt::format("; did you mean {}?", near)));
}

}  // namespace tofsmith
