// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "core/shared/chi_square.hpp"

#include <gtest/gtest.h>

namespace tofsmith {
namespace {

TEST(ChiSquare, MatchesPublishedQuantiles) {
  EXPECT_NEAR(chi_square_quantile_of_tail(1e-3, 1), 10.828, 1e-3);
  EXPECT_NEAR(chi_square_quantile_of_tail(1e-3, 2), 13.816, 1e-3);
  EXPECT_NEAR(chi_square_quantile_of_tail(0.05, 3), 7.815, 1e-3);
  EXPECT_NEAR(chi_square_quantile_of_tail(0.01, 60), 88.379, 1e-3);
}

TEST(ChiSquare, QuantileInvertsTail) {
  for (const int degrees : {1, 2, 5, 8, 61})
    for (const double rate : {0.9, 0.1, 1e-3, 1e-9})
      EXPECT_NEAR(chi_square_tail(chi_square_quantile_of_tail(rate, degrees), degrees) / rate, 1.0,
                  1e-9)
          << degrees << " " << rate;
}

}  // namespace
}  // namespace tofsmith
