// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "decode/shared/marked_raw.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "camera/shared/raw_numbers.hpp"
#include "core/shared/pixel_runs.hpp"
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
  return marked_view(RawView::interleaved(numbers, raw.height, raw.width, raw.measurements),
                     raw.averaged, raw.noise);
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

namespace {

constexpr double no_limit = std::numeric_limits<double>::infinity();

/// Raw values from which measurements are clipped.
struct Rails {
  double lowest = -no_limit, highest = no_limit;
};

Rails rails_of_mixer(const Sensor& sensor) {
  Rails rails;
  const double black = sensor.black_level_dn.value_or(0.0);
  if (sensor.full_well_e) {
    const double well = *sensor.full_well_e / sensor.gain_e_per_dn.value_or(1.0);
    rails = {black - well, black + well};
  }
  if (sensor.adc_bits) {
    const ConverterNumbers numbers = raw_numbers(sensor);
    rails = {std::max(std::ceil(rails.lowest), numbers.min_dn),
             std::min(std::floor(rails.highest), numbers.max_dn)};
  }
  return rails;
}

Rails rails_of(const Sensor& sensor) {
  if (sensor.is_signed()) return rails_of_mixer(sensor);
  const std::optional<float> tap = saturation_level_of(sensor);
  if (!tap) return {};
  const auto level = static_cast<double>(*tap);
  if (sensor.readout != Readout::difference) return {-no_limit, level};
  // One tap at its limit, the other one empty.
  const double largest = level - sensor.black_level_dn.value_or(0.0);
  return {-largest, largest};
}

/// Adds limits for sensors whose saturation is known from markers only.
Rails rails_of(const Camera& camera) {
  Rails rails = rails_of(camera.sensor);
  if (camera.raw.saturated.empty() || std::isfinite(rails.highest)) return rails;
  rails.highest = RawMarking().saturated_above;
  if (camera.sensor.subtracts()) rails.lowest = -rails.highest;
  return rails;
}

}  // namespace

std::optional<float> saturation_level_of(const Sensor& sensor) {
  double level = no_limit;
  if (sensor.full_well_e) {
    level = *sensor.full_well_e / sensor.gain_e_per_dn.value_or(1.0) +
            sensor.black_level_dn.value_or(0.0);
    if (sensor.adc_bits) level = std::floor(level);
  }
  if (sensor.adc_bits) level = std::min(level, std::exp2(*sensor.adc_bits) - 1.0);
  if (!std::isfinite(level)) return std::nullopt;
  return static_cast<float>(level);
}

RawMarking raw_marking_of(const Camera& camera) {
  const Sensor& sensor = camera.sensor;
  const Rails rails = rails_of(camera);
  RawMarking marking{.markers = camera.raw, .subtracts = sensor.subtracts()};
  if (std::isfinite(rails.highest)) {
    marking.saturated_above = rails.highest;
    marking.saturated_below = std::isfinite(rails.lowest) ? rails.lowest : rails.highest;
  }
  if (marking.subtracts)
    if (const auto level = saturation_level_of(sensor))
      marking.tap_saturation_level = static_cast<double>(*level);
  if (!sensor.adc_bits) return marking;
  const double numbers = std::exp2(*sensor.adc_bits);
  marking.converter_max = numbers - 1.0;
  if (sensor.readout == Readout::difference) {
    marking.signed_max = 0.5 * numbers - 1.0;
    marking.unsigned_black_level = sensor.black_level_dn.value_or(0.0);
  }
  return marking;
}

void set_saturation(const Camera& camera, DecodingTable& table) {
  const Rails rails = rails_of(camera);
  if (std::isfinite(rails.highest)) table.saturation_level = static_cast<float>(rails.highest);
  if (std::isfinite(rails.lowest)) table.lower_saturation_level = static_cast<float>(rails.lowest);
  table.marking = raw_marking_of(camera);
}

}  // namespace tofsmith
