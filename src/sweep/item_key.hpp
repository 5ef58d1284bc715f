// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tofsmith/code/code_set.hpp"
#include "tofsmith/core/fields.hpp"
#include "tofsmith/design/design.hpp"
#include "tofsmith/simulate/depth_error.hpp"
#include "tofsmith/sweep/run_sweep.hpp"

namespace tofsmith {

/// Axes with a common index.
using AxisDigit = std::vector<std::size_t>;

/// Digits form a number whose last digit varies fastest.
struct AxisBlock {
  std::vector<AxisDigit> digits;
  std::int64_t size = 1;  ///< at most 2^62
};

/// Blocks within a list advance together; the lists form a product whose last one varies fastest.
std::vector<std::vector<AxisBlock>> axis_blocks(const SweepSpec& spec);

/// Returns "axis samples" or "group optics", for errors.
std::string name_of(const SweepSpec& spec, const AxisBlock& block);

/// Values that axes set, besides keys of the camera.
struct ItemValues {
  std::string camera, code;
  int exposures = 0;  ///< replaces {exposures} in the code
  EvaluateOptions options = {};
  /// NaN: the levels of the camera.
  OperatingPoint light = {std::numeric_limits<double>::quiet_NaN(),
                          std::numeric_limits<double>::quiet_NaN()};
};
auto fields_of(ConstOrNot<ItemValues> auto& v) {
  return std::tuple(Field("camera", v.camera), Field("code", v.code),
                    Field("exposures", v.exposures, at_least(1)),
                    Field("options", v.options, FieldMark::in_place),
                    Field("light", v.light, FieldMark::in_place));
}

/// Returns true if an axis with this key sets a field of the struct.
template <typename Struct>
bool is_field_of(std::string_view key) {
  Struct any;
  bool found = false;
  for_each_field(any, [&](const auto& field) { found = found || key == field.name; });
  return found;
}

/// Sets the field with the key of an axis.
/// @return false for the key of a camera
/// @throws IoError at a value of another type or out of range
bool set_value(ItemValues& item, std::string_view key, const SettingValue& value);

/// Returns the first positions of all distinct keys, sorted by key as in the store.
std::vector<std::int64_t> key_order(std::span<const std::string> keys);

/// Returns the first 16 hexadecimal digits.
std::uint64_t key_number(std::string_view key);

/// Hash of camera and code without names and light levels.
std::string setup_key(const Camera& camera, const CodeSet& code);
/// @param effort  of the options
std::string setup_key(const Camera& camera, const DesignOptions& options, double effort);

/// Returns WorkItem::key.
/// @param setup  setup_key()
std::string item_key(std::string_view setup, const OperatingRange& light,
                     const EvaluateOptions& options);

/// Returns one line of JSON without the code's name.
/// @param designed  the code, if it was designed for the item
std::string item_result_json(const DepthErrorReport& report, const CodeSet* designed = nullptr);

struct ItemResult {
  DepthErrorReport error;
  std::optional<CodeSet> designed;
};

/// @param code  name of the code
/// @param file  the store, for errors
/// @throws IoError naming file and member
ItemResult parse_item_result(const std::string& json, const std::string& code,
                             std::string_view file);

}  // namespace tofsmith
