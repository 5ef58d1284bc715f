// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "io/documents/camera_fields.hpp"
#include "tofsmith/io/camera_toml.hpp"

namespace tofsmith {

namespace {

/// Visits the fields of a camera as TableReader and TableWriter do, and notes their keys.
class KeyCollector {
 public:
  static constexpr bool reads = true;

  explicit KeyCollector(std::string prefix = "") : prefix_(std::move(prefix)) {}

  template <typename Value>
  void value(std::string_view key, Value& /*target*/) {
    add(key);
  }
  template <typename Enum, typename Words>
  void choice(std::string_view key, Enum& /*target*/, const Words& /*words*/) {
    add(key);
  }
  void number_or_list(std::string_view key, double& /*number*/, std::vector<double>& /*list*/) {
    add(key);
  }
  void number_or_word(std::string_view key, double& /*number*/, std::string_view /*word*/,
                      bool& /*is_word*/) {
    add(key);
  }
  template <typename Value, typename Fields>
  void table(std::string_view key, Value& target, Fields&& fields) {
    add(key);
    KeyCollector inner(prefix_ + std::string(key) + ".");
    fields(inner, target);
    keys_.insert(keys_.end(), inner.keys_.begin(), inner.keys_.end());
  }
  template <typename Value, typename Fields>
  void table(std::string_view key, std::optional<Value>& target, Fields&& fields) {
    table(key, target.emplace(), fields);
  }
  template <typename Value, typename Fields>
  void part(std::optional<Value>& target, std::initializer_list<std::string_view> /*keys*/,
            Fields&& fields) {
    fields(*this, target.emplace());
  }
  KeyCollector& required(std::string_view /*key*/, std::string_view /*example*/) { return *this; }
  void refuse(std::initializer_list<std::string_view> keys, std::string_view /*condition*/) {
    for (const std::string_view key : keys) add(key);
  }

  std::vector<std::string> take() && { return std::move(keys_); }

 private:
  void add(std::string_view key) { keys_.push_back(prefix_ + std::string(key)); }

  std::string prefix_;
  std::vector<std::string> keys_;
};

/// Never called: the response of a new camera is of no kind, so that all its keys are "refused".
void visit_measured_response(KeyCollector& /*table*/, ImpulseResponse& /*response*/) {}

bool visit_ray_map(KeyCollector& table, Lens& lens) {
  table.value("rays", lens);
  return false;
}

bool visit_lens_calibration(KeyCollector& table, Lens& lens) {
  table.value("calibration", lens);
  return false;
}

}  // namespace

std::vector<std::string> camera_keys() {
  KeyCollector collector;
  Camera camera;
  camera_fields::visit_camera(collector, camera);
  return std::move(collector).take();
}

}  // namespace tofsmith
