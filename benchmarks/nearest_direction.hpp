// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>

#include "reference_curve.hpp"

namespace tofsmith::benchmarks {

/// Nearest direction by nanoflann's k-d tree in single precision, for comparison. make() returns
/// null without nanoflann.
class NearestDirection {
 public:
  static std::unique_ptr<NearestDirection> make(const ReferenceCurve& curve);
  virtual ~NearestDirection() = default;
  virtual std::int32_t bin(const ReferencePixel& pixel) const = 0;
};

}  // namespace tofsmith::benchmarks
