// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/io/camera_toml.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "core/shared/text_numbers.hpp"
#include "io/documents/camera_fields.hpp"
#include "io/documents/lens_calibration.hpp"
#include "io/shared/read_file.hpp"
#include "io/text/shared/table_reader.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/io/measured_table_file.hpp"

namespace tofsmith {

/// Samples from a file or from the table itself, never both.
void visit_measured_response(TableReader& table, ImpulseResponse& response) {
  std::optional<double> time_step_s;
  table.value("time_step_s", time_step_s);
  table.value("file", response.file);
  table.value("samples", response.samples);
  if (response.file.empty() == response.samples.empty())
    table.fail("kind",
               "found \"file\"; expected either file = \"response.csv\" or samples = "
               "[..] beside it");
  if (response.file.empty()) {
    table.required("time_step_s", "1e-9");
    response.time_step_s = *time_step_s;
    return;
  }
  // Absolute, so that the camera can be written elsewhere and read back.
  const auto path = std::filesystem::absolute(table.resolve("file", response.file));
  response = read_impulse_response(path.lexically_normal(), time_step_s);
}

/// A file of rays, if the table names one.
bool visit_ray_map(TableReader& table, Lens& lens) {
  if (!table.contains("rays")) return false;
  table.value("rays", lens.rays);
  // Absolute, so that the camera can be written elsewhere and read back.
  const auto path = std::filesystem::absolute(table.resolve("rays", lens.rays));
  lens.rays = path.lexically_normal().string();
  return true;
}

/// The lens of a calibration file, if the table names one.
bool visit_lens_calibration(TableReader& table, Lens& lens) {
  if (!table.contains("calibration")) return false;
  std::string file;
  table.value("calibration", file);
  std::optional<DistortionModel> model;
  if (table.contains("distortion_model"))
    table.choice("distortion_model", model.emplace(),
                 words_by_name<DistortionModel, 2>("DistortionModel", "distortion_model"));
  lens = read_lens_calibration(table.resolve("calibration", file), model);
  return true;
}

namespace {

bool is_part_of_name(char c) { return is_letter_or_digit(c) || c == '_'; }

/// Where a field that Camera::validate() names was written, or the key that holds it.
std::string place_of_field(const std::string& field, const TableReader::Places& places,
                           const std::string& source_name) {
  std::string place = source_name;
  for (const auto& [key, where] : places)  // sorted: a longer key comes after its beginning
    if (field.starts_with(key) &&
        (field.size() == key.size() || !is_part_of_name(field[key.size()])))
      place = where;
  return place;
}

}  // namespace

Camera parse_camera_toml(std::string_view text, std::string_view source_name, Settings settings) {
  TomlDocument document(text, source_name);
  for (const std::string& setting : settings) document.apply(setting);

  Camera camera;
  camera.name = std::filesystem::path(source_name).stem().string();
  camera.operating = paper_operating_range();
  TableReader::Places places;
  TableReader table(document, places);
  camera_fields::visit_camera(table, camera);
  table.finish();
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
