// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "tofsmith/core/field_visitor.hpp"

namespace tofsmith {

/// Special raw numbers that a sensor or its driver outputs instead of a measurement. They are
/// compared before any arithmetic and may be NaN or infinite.
struct RawMarkers {
  std::vector<double> saturated;  ///< the measurement is clipped
  std::vector<double> invalid;    ///< there is no measurement, e.g. in a dead pixel

  bool empty() const { return saturated.empty() && invalid.empty(); }
  /// Return true if the list contains the number. NaN equals NaN.
  bool mean_saturated(double number) const;
  bool mean_invalid(double number) const;
  /// @throws std::invalid_argument naming the field as raw.*, value and rule
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
