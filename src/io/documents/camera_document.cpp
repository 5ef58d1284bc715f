// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "io/documents/camera_document.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <set>
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

namespace {

/// Adds the comments of keys such as "light.peak_factor" to lines of TOML; "" for no comment.
std::string with_comments(const std::string& toml,
                          const std::function<std::string(const std::string&)>& comment_of) {
  std::string text, table;
  std::istringstream lines(toml);
  for (std::string line; std::getline(lines, line);) {
    const std::string key = line.substr(0, line.find(" = "));
    if (line.starts_with('[')) table = line.substr(1, line.find(']') - 1) + ".";
    const std::string comment = key == line || key == "name" ? "" : comment_of(table + key);
    text += comment.empty() ? line + "\n" : fmt::format("{:40}  # {}\n", line, comment);
  }
  return text;
}

nlohmann::ordered_json::json_pointer pointer_to(std::string key) {
  std::replace(key.begin(), key.end(), '.', '/');
  return nlohmann::ordered_json::json_pointer("/" + key);
}

/// Removes optional keys that equal their default, except the name, and tables that become empty.
/// Optional tables such as [light.generator] keep their last key, because without the table the
/// camera has no generator.
void remove_defaults(nlohmann::ordered_json& document) {
  using Place = nlohmann::ordered_json::json_pointer;
  std::set<std::string> optional_tables;
  for (const KeyDescription& key : describe_camera_keys(Camera()))
    if (key.type == ValueType::table && key.may_be_absent)
      optional_tables.insert(pointer_to(key.name).to_string());
  const auto remove = [&](const Place& place, const nlohmann::ordered_json& usual) {
    if (!document.contains(place) || document[place] != usual) return;
    const Place table = place.parent_pointer();
    if (document[table].size() == 1 && optional_tables.contains(table.to_string())) return;
    document[table].erase(place.back());
    if (document[table].empty() && !table.empty())
      document[table.parent_pointer()].erase(table.back());
  };
  const nlohmann::ordered_json no_response = {{"kind", "none"}};
  remove(Place("/light/impulse_response"), no_response);
  remove(Place("/sensor/impulse_response"), no_response);
  for (const auto& key : nlohmann::ordered_json::parse(camera_keys_json()))
    if (key.contains("default") && key["example"] == "" && key["key"] != "name")
      remove(pointer_to(key["key"]), key["default"]);
}

}  // namespace

std::string calibrated_camera_toml(const Camera& camera) {
  nlohmann::ordered_json document = camera_document(camera);
  remove_defaults(document);
  const std::string toml = format_toml(document);
  const std::vector<std::string> built_in = built_in_camera_names();
  if (std::find(built_in.begin(), built_in.end(), camera.name) == built_in.end()) return toml;
  const nlohmann::ordered_json others = camera_document(built_in_camera(camera.name));
  return with_comments(toml, [&](const std::string& key) {
    const auto place = pointer_to(key);
    return others.contains(place) && document.contains(place) && others[place] == document[place]
               ? fmt::format("of the camera {}, not measured", camera.name)
               : "";
  });
}

std::string built_in_camera_toml(const std::string& name) {
  const std::string toml = camera_to_toml(built_in_camera(name));
  const std::vector<BuiltInCamera> all = list_built_in_cameras();
  const BuiltInCamera& listed = *std::find_if(
      all.begin(), all.end(), [&](const BuiltInCamera& camera) { return camera.name == name; });
  std::string text = fmt::format("# {}\n", listed.description);
  if (!listed.code.empty()) text += fmt::format("# code: {}\n", listed.code);
  return text + with_comments(toml, [&](const std::string& key) { return listed.source_of(key); });
}

void write_camera_toml(const std::filesystem::path& path, const Camera& camera,
                       OutputPolicy policy) {
  write_file_atomically(path, camera_to_toml(camera), policy);
}

}  // namespace tofsmith
