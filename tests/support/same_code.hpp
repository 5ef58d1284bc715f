// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include "tofsmith/code/code_set.hpp"

namespace tofsmith {

/// Compares samples up to rounding.
inline void expect_same_samples(const CodeSet& a, const CodeSet& b) {
  ASSERT_EQ(a.samples(), b.samples());
  ASSERT_EQ(a.taps(), b.taps());
  ASSERT_EQ(a.exposures(), b.exposures());
  EXPECT_TRUE(a.modulation_samples().isApprox(b.modulation_samples(), 1e-12));
  EXPECT_TRUE(a.demodulation_samples().isApprox(b.demodulation_samples(), 1e-12));
}

inline void expect_same_functions(const CodeSet& a, const CodeSet& b) {
  ASSERT_EQ(a.samples(), b.samples());
  ASSERT_EQ(a.taps(), b.taps());
  ASSERT_EQ(a.exposures(), b.exposures());
  for (int e = 0; e < a.exposures(); ++e) EXPECT_EQ(a.modulation(e), b.modulation(e)) << e;
  for (int i = 0; i < a.measurements(); ++i) EXPECT_EQ(a.demodulation(i), b.demodulation(i)) << i;
}

/// Compares name and provenance, too.
inline void expect_same_code(const CodeSet& a, const CodeSet& b) {
  expect_same_functions(a, b);
  EXPECT_EQ(a.name(), b.name());
  EXPECT_EQ(a.provenance.method, b.provenance.method);
  EXPECT_EQ(a.provenance.camera, b.provenance.camera);
  EXPECT_EQ(a.provenance.seed, b.provenance.seed);
  EXPECT_EQ(a.provenance.version, b.provenance.version);
  EXPECT_EQ(a.provenance.residuals, b.provenance.residuals);
  EXPECT_EQ(a.provenance.depth_error_m, b.provenance.depth_error_m);
}

}  // namespace tofsmith
