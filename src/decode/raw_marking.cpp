// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <cstdint>
#include <limits>
#include <type_traits>

#include "core/shared/pixel_runs.hpp"
#include "decode/shared/marked_raw.hpp"
#include "tofsmith/core/parallel.hpp"

namespace tofsmith {

namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

template <typename Number>
RawView mark_as(const RawView& raw, const RawMarking& marking, std::vector<std::byte>& buffer) {
  const auto row_numbers =
      static_cast<std::size_t>(raw.width) * static_cast<std::size_t>(raw.measurements);
  buffer.resize(static_cast<std::size_t>(raw.height) * row_numbers * sizeof(Number));
  auto* const numbers = reinterpret_cast<Number*>(buffer.data());
  const bool was_unsigned = raw.is_unsigned();
  parallel_for(raw.height, [&](std::int64_t row) {
    Number* to = numbers + static_cast<std::size_t>(row) * row_numbers;
    for_each_run(raw, row * raw.width, raw.width,
                 [&](const auto* pixel, std::int64_t length, std::int64_t) {
                   for (std::int64_t i = 0; i < length; ++i, pixel += raw.column_stride)
                     for (int k = 0; k < raw.measurements; ++k)
                       *to++ = static_cast<Number>(marking.measured(
                           static_cast<double>(pixel[k * raw.measurement_stride]), was_unsigned));
                 });
  });
  RawView view = RawView::interleaved(numbers, raw.height, raw.width, raw.measurements);
  view.averaged = raw.averaged;
  view.noise = raw.noise;
  return view;
}

}  // namespace

std::optional<double> RawMarking::replacement(double number, bool is_unsigned) const {
  if (markers.mean_invalid(number)) return not_a_number;
  if (markers.mean_saturated(number)) return number < 0.0 ? saturated_below : saturated_above;
  if (is_unsigned) {
    if (converter_max && number >= *converter_max) return saturated_above;
    if (converter_max && subtracts && number <= 0.0) return saturated_below;
  } else if (signed_max) {
    if (number == *signed_max) return saturated_above;
    if (number == -*signed_max - 1.0) return saturated_below;
  }
  return std::nullopt;
}

double RawMarking::measured(double number, bool is_unsigned) const {
  return replacement(number, is_unsigned)
      .value_or(is_unsigned ? number - unsigned_black_level : number);
}

double RawMarking::difference(double a, double b) const {
  if (markers.mean_invalid(a) || markers.mean_invalid(b)) return not_a_number;
  const auto is_clipped = [this](double tap) {
    return markers.mean_saturated(tap) || (tap_saturation_level && tap >= *tap_saturation_level);
  };
  if (is_clipped(a)) return saturated_above;
  return is_clipped(b) ? saturated_below : a - b;
}

RawView mark_raw(const RawView& raw, const RawMarking& marking, std::vector<std::byte>& buffer) {
  RawView view = raw;
  if (!raw.is_marked && marking.replaces_numbers())
    view = std::holds_alternative<const double*>(raw.data) ? mark_as<double>(raw, marking, buffer)
                                                           : mark_as<float>(raw, marking, buffer);
  view.is_marked = true;
  return view;
}

}  // namespace tofsmith
