// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "tofsmith/camera/camera.hpp"
#include "tofsmith/code/code_set.hpp"

namespace tofsmith::lab {

/// Changed key of the camera, as for `--set`. Without a value the key is removed, which no
/// command-line option can do.
struct Change {
  std::string key;
  std::optional<std::string> value;
};

/// Arguments of a call. Every member throws InvalidArgument with the argument, its value and the
/// expected value.
class Request {
 public:
  /// @param json  an object
  explicit Request(const nlohmann::json& json) : json_(json) {}

  bool has(const char* name) const;
  std::string text(const char* name) const;
  std::string text(const char* name, const std::string& otherwise) const;
  double number(const char* name) const;
  std::optional<double> optional_number(const char* name) const;
  std::int64_t integer(const char* name, std::int64_t low, std::int64_t high) const;
  std::int64_t integer(const char* name, std::int64_t low, std::int64_t high,
                       std::int64_t otherwise) const;
  std::vector<std::string> texts(const char* name) const;
  std::vector<Change> changes() const;

  /// Returns the camera: `camera`, the text of a camera file, or `built_in`, the name of a camera;
  /// with the `changes`.
  /// @throws IoError as parse_camera_toml()
  Camera camera() const;
  /// Returns the code: {"name": a family}, built for the camera, or {"file": the text of a code
  /// file}.
  /// @throws IoError as load_code() and parse_code_json(); InvalidArgument for a code that the
  ///   camera does not support
  CodeSet code(const Camera& camera) const;

 private:
  [[noreturn]] void refuse(const char* name, const char* expected) const;

  const nlohmann::json& json_;
};

/// Returns the camera with one key changed. If the kind of impulse response changes, missing
/// numbers become 10 f0.
/// @return the camera, and the change as for `--set`
std::pair<Camera, Change> changed(const Camera& camera, const Change& change);

}  // namespace tofsmith::lab
