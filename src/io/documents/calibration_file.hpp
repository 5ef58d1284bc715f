// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <yaml-cpp/yaml.h>

#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tofsmith {

/// One camera of a calibration file in YAML, JSON or OpenCV's XML. Keys are compared without case
/// and underscores. Files of several cameras either add a camera's name to its keys (cameraMatrix1,
/// left_camera_matrix) or have a table for each. Members throw IoError "file:line:column: found
/// ...; expected ...".
class CalibrationFile {
 public:
  CalibrationFile(std::string_view text, std::string_view name);
  /// Returns the camera whose keys are in a table, with its name in the keys or "".
  CalibrationFile camera(const YAML::Node& table, std::string_view name_in_keys) const;

  const YAML::Node& root() const { return root_; }

  /// Returns the value of the first existing key. Keys are in lower case without underscores.
  YAML::Node find(std::initializer_list<std::string_view> keys) const;
  /// Returns the camera names in such keys in the order of the file; "" for keys without a name.
  std::vector<std::string> names_in(std::initializer_list<std::string_view> keys) const;

  /// Flattens nested lists and the `data` of a matrix.
  std::vector<double> numbers(const YAML::Node& node, std::string_view key) const;
  double number(const YAML::Node& node, std::string_view key) const;
  /// Accepts at most a million.
  int whole(const YAML::Node& node, std::string_view key) const;

  [[noreturn]] void fail(const YAML::Node& node, const std::string& problem) const;
  [[noreturn]] void fail(const std::string& problem) const;

 private:
  void add_numbers(const YAML::Node& node, std::string_view key, std::vector<double>& values) const;
  std::string place_of(const YAML::Mark& mark) const;

  std::string name_;
  bool is_xml_ = false;  ///< positions consist of lines only
  YAML::Node root_;
  std::string name_in_keys_;
};

}  // namespace tofsmith
