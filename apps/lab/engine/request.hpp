// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "tofsmith/camera/camera.hpp"
#include "tofsmith/code/code_set.hpp"
#include "tofsmith/core/image.hpp"

namespace tofsmith::lab {

using Json = nlohmann::ordered_json;

/// Array that is transferred in binary form.
struct NamedArray {
  std::string name;
  std::variant<std::vector<float>, std::vector<double>, std::vector<std::int32_t>,
               std::vector<std::uint8_t>>
      values;
  std::vector<std::size_t> shape;
};

struct Reply {
  std::string json;
  std::vector<NamedArray> arrays;
};

/// Answer under construction: a JSON object and the arrays to which it refers.
class Answer {
 public:
  Json& operator[](const char* key) { return json_[key]; }

  /// Adds an array, and {"array": name, "shape": [...]} under that name to the object.
  template <typename Number>
  void add(std::string_view name, std::vector<Number> values, std::vector<std::size_t> shape) {
    json_[std::string(name)] = {{"array", name}, {"shape", shape}};
    arrays_.push_back({std::string(name), std::move(values), std::move(shape)});
  }
  /// Adds a matrix with shape (columns, rows).
  void add_columns(std::string_view name, const Eigen::MatrixXd& matrix) {
    add(name, std::vector<double>(matrix.data(), matrix.data() + matrix.size()),
        {static_cast<std::size_t>(matrix.cols()), static_cast<std::size_t>(matrix.rows())});
  }
  template <typename Number>
  void add(std::string_view name, const Image<Number>& image) {
    add(name, image.pixels,
        {static_cast<std::size_t>(image.height), static_cast<std::size_t>(image.width)});
  }

  Reply reply() &&;

 private:
  Json json_ = Json::object();
  std::vector<NamedArray> arrays_;
};

/// Returns {"error": {"message": ..., "field": ...}}.
/// @param field  empty: unknown
Reply error_reply(std::string_view message, std::string_view field = "");

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
