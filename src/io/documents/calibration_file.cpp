// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "io/documents/calibration_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/shared/text_numbers.hpp"
#include "io/documents/storage_xml.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

namespace {

/// Recognizes cameraMatrix1, D_cam0, left_camera_matrix.
bool names_a_camera(std::string_view part) {
  constexpr std::array<std::string_view, 7> words = {"left",  "right",  "depth", "ir",
                                                     "color", "colour", "rgb"};
  if (std::find(words.begin(), words.end(), part) != words.end()) return true;
  for (const std::string_view word : {"camera", "cam"})
    if (part.starts_with(word)) part.remove_prefix(word.size());
  return !part.empty() && part.size() <= 2 && std::all_of(part.begin(), part.end(), is_digit);
}

/// Returns the camera's name before or after `base`; none for other keys.
std::optional<std::string> name_beside(std::string_view key, std::string_view base) {
  if (key == base) return "";
  if (key.starts_with(base) && names_a_camera(key.substr(base.size())))
    return std::string(key.substr(base.size()));
  if (key.ends_with(base) && names_a_camera(key.substr(0, key.size() - base.size())))
    return std::string(key.substr(0, key.size() - base.size()));
  return std::nullopt;
}

/// Replaces syntax of OpenCV and others that YAML::Load() rejects; keeps line numbers.
std::string readable(std::string_view text) {
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);  // byte order mark
  while (text.ends_with('\0')) text.remove_suffix(1);  // at the end of Azure Kinect calibrations
  std::string yaml(text);
  // Old versions of OpenCV write this without the required `---`.
  if (yaml.starts_with("%YAML")) yaml[0] = '#';
  if (yaml.find_first_not_of(" \t\r\n") == yaml.find('{'))  // JSON with tabs as indentation
    std::replace(yaml.begin(), yaml.end(), '\t', ' ');
  return yaml;
}

}  // namespace

CalibrationFile::CalibrationFile(std::string_view text, std::string_view name) : name_(name) {
  std::string yaml = readable(text);
  const std::size_t start = yaml.find_first_not_of(" \t\r\n");
  is_xml_ = start != std::string::npos && yaml[start] == '<';
  if (is_xml_) yaml = yaml_of_storage_xml(yaml, name);
  try {
    root_ = YAML::Load(yaml);
  } catch (const YAML::Exception& error) {
    throw IoError(place_of(error.mark), fmt::format("is not valid YAML: {}", error.msg));
  }
  if (is_xml_ && root_.IsMap() && root_.size() > 0) root_.reset(root_.begin()->second);
  if (!root_.IsMap())
    fail(
        "found no keys; expected the YAML, XML or JSON of a lens's calibration: camera_matrix and "
        "distortion_coefficients, or K and D");
}

CalibrationFile CalibrationFile::camera(const YAML::Node& table,
                                        std::string_view name_in_keys) const {
  CalibrationFile result = *this;
  result.root_.reset(table);
  result.name_in_keys_ = name_in_keys;
  return result;
}

YAML::Node CalibrationFile::find(std::initializer_list<std::string_view> keys) const {
  for (const std::string& name : {name_in_keys_, std::string()})
    for (const std::string_view key : keys)
      for (const auto& entry : root_)
        if (name_beside(letters_and_digits(entry.first.Scalar()), key) == name) return entry.second;
  return YAML::Node(YAML::NodeType::Undefined);
}

std::vector<std::string> CalibrationFile::names_in(
    std::initializer_list<std::string_view> keys) const {
  std::vector<std::string> names;
  for (const auto& entry : root_)
    for (const std::string_view key : keys)
      if (const auto name = name_beside(letters_and_digits(entry.first.Scalar()), key);
          name && !entry.second.IsScalar() && !entry.second.IsNull() &&
          std::find(names.begin(), names.end(), *name) == names.end())
        names.push_back(*name);
  return names;
}

std::vector<double> CalibrationFile::numbers(const YAML::Node& node, std::string_view key) const {
  const YAML::Node data = node.IsMap() ? node["data"] : node;
  if (!data || !data.IsSequence())
    fail(node, fmt::format("{}: expected a list of numbers, or a matrix with its data", key));
  std::vector<double> values;
  add_numbers(data, key, values);
  return values;
}

void CalibrationFile::add_numbers(const YAML::Node& node, std::string_view key,
                                  std::vector<double>& values) const {
  for (const YAML::Node& entry : node)
    if (entry.IsSequence())
      add_numbers(entry, key, values);
    else
      values.push_back(number(entry, key));
}

double CalibrationFile::number(const YAML::Node& node, std::string_view key) const {
  const std::optional<double> value = node.IsScalar() ? number_in(node.Scalar()) : std::nullopt;
  if (!value || !std::isfinite(*value))
    fail(node, fmt::format("{}: found {}; expected a finite number", key,
                           node.IsScalar() ? node.Scalar() : "no number"));
  return *value;
}

int CalibrationFile::whole(const YAML::Node& node, std::string_view key) const {
  const double value = number(node, key);
  constexpr double largest = 1e6;
  if (!(value >= 0.0 && value <= largest && value == std::floor(value)))
    fail(node,
         fmt::format("{}: found {}; expected a whole number from 0 to {}", key, value, largest));
  return static_cast<int>(value);
}

void CalibrationFile::fail(const YAML::Node& node, const std::string& problem) const {
  throw IoError(place_of(node.Mark()), problem);
}

void CalibrationFile::fail(const std::string& problem) const { throw IoError(name_, problem); }

std::string CalibrationFile::place_of(const YAML::Mark& mark) const {
  if (mark.is_null()) return name_;
  if (is_xml_) return fmt::format("{}:{}", name_, mark.line + 1);
  return fmt::format("{}:{}:{}", name_, mark.line + 1, mark.column + 1);
}

}  // namespace tofsmith
