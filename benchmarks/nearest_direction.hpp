// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>

#include "reference_curve.hpp"

namespace tofsmith::benchmarks {

/// Peer for comparisons: nearest direction by nanoflann's k-d tree, in single precision. make()
/// returns null if the benchmark was built without nanoflann.
class NearestDirection {
 public:
  static std::unique_ptr<NearestDirection> make(const ReferenceCurve& curve);
  virtual ~NearestDirection() = default;
  virtual std::int32_t bin(const ReferencePixel& pixel) const = 0;
};

}  // namespace tofsmith::benchmarks
