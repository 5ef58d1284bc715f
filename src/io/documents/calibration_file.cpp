// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "io/documents/calibration_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <string_view>

#include "core/shared/text_numbers.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

namespace {

constexpr std::string_view spaces = " \t\r\n";

struct Content {
  std::string yaml;
  int words = 0, elements = 0;
  bool is_list = true;  ///< all elements are named `_`

  void add_lines(std::string_view text) {
    yaml.append(static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n')), '\n');
  }

  void add_words(std::string_view text) {
    while (!text.empty()) {
      const std::size_t start = std::min(text.find_first_not_of(spaces), text.size());
      add_lines(text.substr(0, start));
      text.remove_prefix(start);
      const std::string_view word = text.substr(0, text.find_first_of(spaces));
      text.remove_prefix(word.size());
      if (word.empty()) continue;
      yaml += fmt::format("{}{}", words++ > 0 ? "," : "", quoted(word));
    }
  }

  void add_element(std::string_view name, const Content& content) {
    if (elements++ > 0) yaml += ",";
    if (name != "_") yaml += quoted(name) + ": ";
    is_list = is_list && name == "_";
    yaml += content.value();
  }

  std::string value() const {
    if (elements > 0) return is_list ? "[" + yaml + "]" : "{" + yaml + "}";
    return words == 1 ? yaml : "[" + yaml + "]";
  }

  static std::string quoted(std::string_view word) {
    std::string text(word);
    std::erase_if(text, [](char c) { return c == '"' || c == '\\'; });
    return '"' + text + '"';
  }
};

class StorageXml {
 public:
  StorageXml(std::string_view text, std::string_view name) : text_(text), name_(name) {}

  /// Reads up to the end of the element, or of the document if the name is empty.
  Content content(std::string_view name, int depth) {
    constexpr int max_depth = 64;
    if (depth > max_depth) fail(fmt::format("expected at most {} nested elements", max_depth));
    Content content;
    while (at_ < text_.size()) {
      const std::string_view words = text_.substr(at_, text_.find('<', at_) - at_);
      content.add_words(words);
      at_ += words.size();
      if (text_.substr(at_).starts_with("<!--")) {
        content.add_lines(until("-->"));
      } else if (at_ < text_.size()) {
        const std::string_view tag = until(">");
        content.add_lines(tag);
        if (tag.starts_with("/")) return check_end(tag, name), content;
        if (!tag.starts_with("?") && !tag.starts_with("!")) add_element(tag, depth, content);
      }
    }
    if (!name.empty()) fail(fmt::format("found the end of the file; expected </{}>", name));
    return content;
  }

 private:
  /// Returns the text before the next `end`, which is skipped.
  std::string_view until(std::string_view end) {
    const std::size_t found = text_.find(end, at_);
    if (found == std::string_view::npos) fail(fmt::format("found <; expected {} after it", end));
    const std::string_view text = text_.substr(at_ + 1, found - at_ - 1);
    at_ = found + end.size();
    return text;
  }

  void add_element(std::string_view tag, int depth, Content& parent) {
    const std::string_view name = tag.substr(0, tag.find_first_of(" \t\r\n/"));
    if (name.empty()) fail("expected the name of an element after <");
    parent.add_element(name, tag.ends_with("/") ? Content() : content(name, depth + 1));
  }

  void check_end(std::string_view tag, std::string_view name) const {
    const std::string_view ended = tag.substr(1, tag.find_last_not_of(spaces));
    if (name.empty() || ended != name)
      fail(fmt::format("found </{}>; expected {}", ended,
                       name.empty() ? "no end of an element" : fmt::format("</{}>", name)));
  }

  [[noreturn]] void fail(const std::string& problem) const {
    const auto line = 1 + std::count(text_.begin(), text_.begin() + static_cast<long>(at_), '\n');
    throw IoError(fmt::format("{}:{}", name_, line), "is not valid XML: " + problem);
  }

  std::string_view text_;
  std::string name_;
  std::size_t at_ = 0;
};

/// Converts OpenCV's FileStorage from XML to YAML: elements with children become maps, or lists if
/// all children are named `_`; elements with several words become lists, with one word scalars.
/// Attributes and comments are omitted. Line numbers are kept.
/// @param name  path, or name for error messages
/// @throws IoError "file:line: ..." if tags do not match
std::string yaml_of_storage_xml(std::string_view text, std::string_view name) {
  return "{" + StorageXml(text, name).content("", 0).yaml + "}";
}

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
