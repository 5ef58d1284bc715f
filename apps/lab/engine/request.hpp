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

/// A key of the camera that the page has changed, as `--set` takes it. Without value: not set any
/// more, which no command can say.
struct Change {
  std::string key;
  std::optional<std::string> value;
};

/// The arguments of a call. Every member throws InvalidArgument that names the argument, what was
/// found and what was expected.
class Request {
 public:
  /// @param json  an object
  explicit Request(const nlohmann::json& json) : json_(json) {}

  bool has(const char* name) const;
  std::string text(const char* name) const;
  std::string text(const char* name, const std::string& otherwise) const;
  /// A finite number.
  double number(const char* name) const;
  std::optional<double> optional_number(const char* name) const;
  std::int64_t integer(const char* name, std::int64_t low, std::int64_t high) const;
  std::int64_t integer(const char* name, std::int64_t low, std::int64_t high,
                       std::int64_t otherwise) const;
  std::vector<std::string> texts(const char* name) const;
  std::vector<Change> changes() const;

  /// `camera`, the text of a camera file, or `built_in`, the name of a camera; with the `changes`.
  /// @throws IoError as parse_camera_toml()
  Camera camera() const;
  /// `code`: {"name": a family}, built for the camera, or {"file": the text of a code file}.
  /// @throws IoError as load_code() and parse_code_json(); InvalidArgument for a code that the
  ///         camera cannot play
  CodeSet code(const Camera& camera) const;

 private:
  [[noreturn]] void refuse(const char* name, const char* expected) const;

  const nlohmann::json& json_;
};

/// The camera with one key changed. Another kind of impulse response gets the numbers that it
/// needs: 10 f0, where the camera says no other.
/// @return also the change as `--set` takes it
std::pair<Camera, Change> changed(const Camera& camera, const Change& change);

}  // namespace tofsmith::lab
