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

/// One camera of a calibration file in YAML, JSON or the XML of OpenCV. Keys are found however they
/// are spelled: "cameramatrix" finds camera_matrix and cameraMatrix. Files of several cameras add
/// the name of one to its keys (cameraMatrix1, left_camera_matrix) or have a table for each.
/// Members throw IoError "file:line:column: found ..; expected ..".
class CalibrationFile {
 public:
  /// The whole file.
  CalibrationFile(std::string_view text, std::string_view name);
  /// The camera whose keys are in a table, with a name or none in them.
  CalibrationFile camera(const YAML::Node& table, std::string_view name_in_keys) const;

  const YAML::Node& root() const { return root_; }

  /// The value of the first of these keys, in lower case without underscores, that is there.
  YAML::Node find(std::initializer_list<std::string_view> keys) const;
  /// Names of cameras that such keys have, "" of plain ones, in the order of the file.
  std::vector<std::string> names_in(std::initializer_list<std::string_view> keys) const;

  /// The numbers of a list, of lists in it, or of the `data` of a matrix.
  std::vector<double> numbers(const YAML::Node& node, std::string_view key) const;
  double number(const YAML::Node& node, std::string_view key) const;
  /// A whole number of at most a million.
  int whole(const YAML::Node& node, std::string_view key) const;

  [[noreturn]] void fail(const YAML::Node& node, const std::string& problem) const;
  [[noreturn]] void fail(const std::string& problem) const;

 private:
  void add_numbers(const YAML::Node& node, std::string_view key, std::vector<double>& values) const;
  std::string place_of(const YAML::Mark& mark) const;

  std::string name_;
  bool is_xml_ = false;  ///< positions have lines, but no columns
  YAML::Node root_;
  std::string name_in_keys_;
};

}  // namespace tofsmith
