// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "io/documents/camera_document.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>

#include "io/documents/shared/document_text.hpp"
#include "io/documents/shared/lens_document.hpp"
#include "io/text/field_reader.hpp"
#include "io/text/field_writer.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/io/camera_toml.hpp"

namespace tofsmith {

nlohmann::ordered_json lens_document(const Lens& lens) { return described_json(lens); }

std::string lens_to_json(const Lens& lens) { return lens_document(lens).dump(); }

Lens lens_from_json(const std::string& json) {
  const TomlDocument document(format_toml(nlohmann::ordered_json::parse(json)), "lens");
  TableReader::Places places;
  TableReader table(document, places);
  FieldReader reader(table);
  Lens lens;
  describe(reader, lens);
  table.finish();
  return lens;
}

Lens lens_from_json(const JsonReader& json) {
  try {
    return lens_from_json(json.dump());
  } catch (const IoError& error) {
    json.fail(error.what());
  }
}

nlohmann::ordered_json camera_document(const Camera& camera) {
  camera.validate();
  return described_json(camera);
}

std::string camera_to_json(const Camera& camera) {
  return format_json(camera_document(camera)) + "\n";
}

std::string camera_to_toml(const Camera& camera) { return format_toml(camera_document(camera)); }

std::string built_in_camera_toml(const std::string& name) {
  const std::string toml = camera_to_toml(built_in_camera(name));
  const std::vector<BuiltInCamera> all = list_built_in_cameras();
  const BuiltInCamera& listed = *std::find_if(
      all.begin(), all.end(), [&](const BuiltInCamera& camera) { return camera.name == name; });
  std::string text = fmt::format("# {}\n", listed.description);
  if (!listed.code.empty()) text += fmt::format("# code: {}\n", listed.code);
  std::istringstream lines(toml);
  std::string table;
  for (std::string line; std::getline(lines, line);) {
    const std::string key = line.substr(0, line.find(" = "));
    if (line.starts_with('[')) table = line.substr(1, line.find(']') - 1) + ".";
    if (key == line || key == "name")
      text += line + "\n";
    else
      text += fmt::format("{:40}  # {}\n", line, listed.source_of(table + key));
  }
  return text;
}

void write_camera_toml(const std::filesystem::path& path, const Camera& camera,
                       OutputPolicy policy) {
  write_file_atomically(path, camera_to_toml(camera), policy);
}

}  // namespace tofsmith
