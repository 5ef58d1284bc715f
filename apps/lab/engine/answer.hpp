// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "tofsmith/core/image.hpp"
#include "tofsmith/core/progress.hpp"

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

/// Answers a request of the lab page: a JSON object with `call` and its arguments (see
/// docs/lab.md). The JSON of the reply contains `answer`, or `error` with the message that the
/// command would print. Invalid requests are answered, too.
/// @param progress  for long calls; can stop a design
Reply answer(std::string_view request, const Progress& progress = {});

}  // namespace tofsmith::lab
