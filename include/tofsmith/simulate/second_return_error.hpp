// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "tofsmith/camera/second_returns.hpp"
#include "tofsmith/simulate/depth_error.hpp"

namespace tofsmith {

/// Error of the direct depth [m]: geometric means over the operating points of mean |error|.
struct SecondReturnError {
  Estimate linear_m, circular_m;

  const Estimate& of(DepthErrorKind kind) const {
    return kind == DepthErrorKind::linear ? linear_m : circular_m;
  }
};
/// Its fields (core/fields.hpp).
auto fields_of(ConstOrNot<SecondReturnError> auto& e) {
  return std::tuple(Field("linear_m", e.linear_m, "finite and >= 0"),
                    Field("circular_m", e.circular_m, "finite and >= 0"));
}

/// Error where every pixel has a second return, decoded as if there were one, by zncc. Trial t of a
/// point draws depth, uniform on the t-th slice of the range, albedo, return and noise from a
/// stream of its own. Of the options, trials (per point) and seed count.
/// @throws std::invalid_argument as evaluate(); Interrupted
SecondReturnError second_return_error(const CodeSet& code, const Camera& camera,
                                      const SecondReturns& later,
                                      const EvaluateOptions& options = {},
                                      const Progress& progress = {});

/// The same trials, decoded as two returns.
/// @throws std::invalid_argument also for codes that cannot tell two returns
SecondReturnError two_return_error(const CodeSet& code, const Camera& camera,
                                   const SecondReturns& later, const EvaluateOptions& options = {},
                                   const Progress& progress = {});

/// What second returns make of a code.
struct SecondReturnReport {
  SecondReturnError single_path;                ///< decoded as single-path
  std::optional<SecondReturnError> two_return;  ///< as two returns; none: the code cannot
};
/// Its fields (core/fields.hpp).
auto fields_of(ConstOrNot<SecondReturnReport> auto& r) {
  return std::tuple(Field("single_path", r.single_path), Field("two_return", r.two_return));
}

/// Both, on the same trials.
/// @throws as second_return_error()
SecondReturnReport second_return_report(const CodeSet& code, const Camera& camera,
                                        const SecondReturns& later,
                                        const EvaluateOptions& options = {},
                                        const Progress& progress = {});

}  // namespace tofsmith
