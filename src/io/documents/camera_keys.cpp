// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <type_traits>

#include "io/documents/camera_fields.hpp"
#include "tofsmith/io/camera_toml.hpp"

namespace tofsmith {

namespace {

template <typename Value>
constexpr CameraKeyType type_of = CameraKeyType::list;
template <>
constexpr CameraKeyType type_of<double> = CameraKeyType::number;
template <>
constexpr CameraKeyType type_of<int> = CameraKeyType::integer;
template <>
constexpr CameraKeyType type_of<bool> = CameraKeyType::boolean;
template <>
constexpr CameraKeyType type_of<std::string> = CameraKeyType::text;
template <typename Value>
constexpr CameraKeyType type_of<std::optional<Value>> = type_of<Value>;

/// Visits the fields of a camera as TableReader and TableWriter do, and notes their keys.
class KeyCollector {
 public:
  static constexpr bool reads = true;

  explicit KeyCollector(std::string prefix = "") : prefix_(std::move(prefix)) {}

  template <typename Value>
  void value(std::string_view key, Value& /*target*/) {
    add(key, type_of<Value>);
  }
  template <typename Enum, typename Words>
  void choice(std::string_view key, Enum& /*target*/, const Words& words) {
    add(key, CameraKeyType::choice).words.assign(words.all().begin(), words.all().end());
  }
  void number_or_list(std::string_view key, double& /*number*/, std::vector<double>& list) {
    add(key, list.empty() ? CameraKeyType::number : CameraKeyType::list);
  }
  void number_or_word(std::string_view key, double& /*number*/, std::string_view word,
                      bool& /*is_word*/) {
    add(key, CameraKeyType::number).words.emplace_back(word);
  }
  void markers(std::string_view key, std::vector<double>& /*numbers*/) {
    add(key, CameraKeyType::list);
  }
  template <typename Value, typename Fields>
  void table(std::string_view key, Value& target, Fields&& fields) {
    add(key, CameraKeyType::table);
    KeyCollector inner(prefix_ + std::string(key) + ".");
    fields(inner, target);
    keys_.insert(keys_.end(), inner.keys_.begin(), inner.keys_.end());
  }
  template <typename Value, typename Fields>
  void table(std::string_view key, std::optional<Value>& target, Fields&& fields) {
    if (!target) target.emplace();
    table(key, *target, fields);
  }
  template <typename Value, typename Fields>
  void part(std::optional<Value>& target, std::initializer_list<std::string_view> /*keys*/,
            Fields&& fields) {
    if (!target) target.emplace();
    fields(*this, *target);
  }
  KeyCollector& required(std::string_view /*key*/, std::string_view /*example*/) { return *this; }
  void refuse(std::initializer_list<std::string_view> keys, std::string_view /*condition*/) {
    for (const std::string_view key : keys) add(key, CameraKeyType::text).applies = false;
  }

  std::vector<CameraKey> take() && { return std::move(keys_); }

 private:
  CameraKey& add(std::string_view key, CameraKeyType type) {
    return keys_.emplace_back(CameraKey{prefix_ + std::string(key), type});
  }

  std::string prefix_;
  std::vector<CameraKey> keys_;
};

void visit_measured_response(KeyCollector& table, ImpulseResponse& response) {
  table.value("file", response.file);
  table.value("samples", response.samples);
  table.value("time_step_s", response.time_step_s);
}

bool visit_ray_map(KeyCollector& table, Lens& lens) {
  table.value("rays", lens.rays);
  return !lens.rays.empty();
}

/// A file that is read for the others: of a camera itself it is never a part.
bool visit_lens_calibration(KeyCollector& table, Lens& lens) {
  table.value("calibration", lens.rays);
  return false;
}

}  // namespace

std::string_view name_of(CameraKeyType type) {
  constexpr std::array<std::string_view, 7> names = {"number", "integer", "boolean", "text",
                                                     "choice", "list",    "table"};
  return names.at(static_cast<std::size_t>(type));
}

std::vector<CameraKey> describe_camera_keys(const Camera& camera) {
  KeyCollector collector;
  Camera complete = camera;
  camera_fields::visit_camera(collector, complete);
  return std::move(collector).take();
}

std::vector<std::string> camera_keys() {
  std::vector<std::string> names;
  for (CameraKey& described : describe_camera_keys(Camera()))
    names.push_back(std::move(described.key));
  return names;
}

}  // namespace tofsmith
