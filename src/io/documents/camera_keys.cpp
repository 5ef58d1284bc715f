// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "io/text/field_writer.hpp"
#include "tofsmith/io/camera_toml.hpp"
#include "tofsmith/io/raw_format.hpp"

namespace tofsmith {

namespace {

using Json = nlohmann::ordered_json;

Json default_of(const KeyDescription& described, const Json& defaults) {
  if (described.may_be_absent || !described.key.applies) return nullptr;
  const Json::json_pointer place("/" + [&] {
    std::string path = described.name;
    std::replace(path.begin(), path.end(), '.', '/');
    return path;
  }());
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

}  // namespace tofsmith
