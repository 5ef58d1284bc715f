// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "io/documents/shared/document_text.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <functional>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "io/documents/shared/lens_document.hpp"
#include "io/shared/read_file.hpp"
#include "io/text/field_toml.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/io/camera_toml.hpp"
#include "tofsmith/io/measured_table_file.hpp"
#include "tofsmith/io/raw_format.hpp"

namespace tofsmith {

nlohmann::ordered_json lens_document(const Lens& lens) { return described_json(lens); }

std::string lens_to_json(const Lens& lens) { return lens_document(lens).dump(); }

Lens lens_from_json(const ValueReader& json) {
  TableReader table(json);
  FieldReader reader(table);
  Lens lens;
  describe(reader, lens);
  table.finish();
  return lens;
}

Lens lens_from_json(const std::string& json) {
  const Document document(parse_json(json, "lens").root(), "lens", Syntax::toml);
  return lens_from_json(ValueReader(document));
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

namespace {

using Json = nlohmann::ordered_json;

Json default_of(const KeyDescription& described, const Json& defaults) {
  if (described.may_be_absent || !described.key.applies) return nullptr;
  const Json::json_pointer place = pointer_to(described.name);
  return defaults.contains(place) ? defaults[place] : Json();
}

Json key_json(const KeyDescription& described, const Json& defaults) {
  const Key& key = described.key;
  Json entry = {
      {"key", described.name},
      {"part", described.part},
      {"type", name_of(described.type)},
      {"unit", unit_of_key(described.name)},
      {"help", key.help},
      {"range", key.range.is_restricted ? key.range.text(described.type == ValueType::integer ||
                                                         described.type == ValueType::integers)
                                        : ""},
      {"condition", key.condition},
      {"example", key.example}};
  if (described.type != ValueType::table) entry["default"] = default_of(described, defaults);
  if (!described.words.empty()) entry["words"] = described.words;
  return entry;
}

template <typename Struct>
std::string keys_json(Struct its) {
  KeyList list;
  describe(list, its);
  const Json defaults = described_json(its);
  Json keys = Json::array();
  for (const KeyDescription& described : list.keys) keys.push_back(key_json(described, defaults));
  return keys.dump(1);
}

}  // namespace

std::vector<KeyDescription> describe_camera_keys(const Camera& camera) {
  KeyList list;
  Camera complete = camera;
  describe(list, complete);
  return std::move(list.keys);
}

std::vector<std::string> camera_keys() {
  std::vector<std::string> names;
  for (KeyDescription& described : describe_camera_keys(Camera()))
    names.push_back(std::move(described.name));
  return names;
}

std::string similar_camera_key(std::string_view key) {
  std::string_view name = key.substr(key.rfind('.') + 1);
  if (name == "bandwidth" || name == "bandwidth_hz") name = "cutoff_hz";
  std::string similar;
  std::ptrdiff_t most = -1;
  for (const KeyDescription& described : describe_camera_keys(Camera())) {
    const std::string& known = described.name;
    if (described.type == ValueType::table || known.substr(known.rfind('.') + 1) != name) continue;
    const std::ptrdiff_t common =
        std::mismatch(key.begin(), key.end(), known.begin(), known.end()).first - key.begin();
    if (common <= most) continue;
    most = common;
    similar = known;
  }
  return similar;
}

std::string camera_keys_json() {
  Camera complete;
  complete.operating = default_operating_range();
  return keys_json(complete);
}

std::string raw_format_keys_json() { return keys_json(RawFormat()); }

namespace {

void load_response(const std::string& name, const FieldReader& reader, const Document& document,
                   ImpulseResponse& response) {
  if (response.kind != ImpulseResponse::Kind::file) return;
  const auto file = reader.files().find(name + ".file");
  if (file == reader.files().end()) return;
  std::optional<double> time_step_s;
  if (document.root().contains(pointer_to(name + ".time_step_s")))
    time_step_s = response.time_step_s;
  response = read_impulse_response(file->second, time_step_s);
}

void load_lens(const FieldReader& reader, const Document& document, std::optional<Lens>& lens) {
  const auto file = reader.files().find("lens.calibration");
  if (file == reader.files().end()) return;
  std::optional<DistortionModel> model;
  if (lens->distortion) model = lens->distortion->model;
  const auto camera = document.root().at("lens").value("calibration_camera", std::string());
  lens = read_lens_calibration(file->second, model, camera);
}

}  // namespace

Camera parse_camera_toml(std::string_view text, std::string_view source_name, Settings settings) {
  Document document = parse_toml(text, source_name, settings);
  document.suggest_keys([](std::string_view key) {
    const std::string similar = similar_camera_key(key);
    return similar == key ? "" : similar;  // a key under another condition
  });

  Camera camera;
  camera.name = std::filesystem::path(source_name).stem().string();
  camera.operating = default_operating_range();
  TableReader table(document);
  FieldReader reader(table);
  describe(reader, camera);
  table.finish();
  load_response("light.impulse_response", reader, document, camera.light.impulse_response);
  load_response("sensor.impulse_response", reader, document, camera.sensor.impulse_response);
  load_lens(reader, document, camera.lens);
  try {
    camera.validate();
  } catch (const InvalidArgument& error) {
    throw IoError(document.place_of_field(error.field()), error.what());
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
