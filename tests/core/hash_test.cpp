// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "core/shared/hash.hpp"

#include <gtest/gtest.h>

namespace tofsmith {
namespace {

// Test vectors of draft-eastlake-fnv.
TEST(Hash, AgreesWithThePublishedVectors) {
  EXPECT_EQ(fnv1a_64(""), 0xcbf29ce484222325ull);
  EXPECT_EQ(fnv1a_64("foobar"), 0x85944171f73967e8ull);
  EXPECT_EQ(fnv1a_128_hex(""), "6c62272e07bb014262b821756295c58d");
  EXPECT_EQ(fnv1a_128_hex("a"), "d228cb696f1a8caf78912b704e4a8964");
  EXPECT_EQ(fnv1a_128_hex("foobar"), "343e1662793c64bf6f0d3597ba446f18");
}

}  // namespace
}  // namespace tofsmith
