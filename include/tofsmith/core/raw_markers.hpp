// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "tofsmith/core/field_visitor.hpp"

namespace tofsmith {

/// Raw numbers that a sensor or its driver outputs instead of a measurement. They are compared
/// before any arithmetic and may be NaN or infinite.
struct RawMarkers {
  std::vector<double> saturated;
  std::vector<double> invalid;  ///< e.g. in a dead pixel

  bool empty() const { return saturated.empty() && invalid.empty(); }
  /// NaN equals NaN.
  bool mean_saturated(double number) const;
  bool mean_invalid(double number) const;
  /// @throws InvalidArgument
  void validate() const;

  /// NaN equals NaN.
  friend bool operator==(const RawMarkers& a, const RawMarkers& b);
};

/// Keys of [raw].
inline void describe(FieldVisitor& fields, RawMarkers& raw) {
  fields.value(Key("saturated",
                   "Numbers that mean a clipped measurement; nan, inf and -inf are "
                   "allowed"),
               RawNumberList{raw.saturated});
  fields.value(Key("invalid",
                   "Numbers that mean a missing measurement, such as those of dead "
                   "pixels; nan, inf and -inf are allowed"),
               RawNumberList{raw.invalid});
}

}  // namespace tofsmith
