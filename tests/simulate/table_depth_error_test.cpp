// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/simulate/depth_error.hpp"

#include <gtest/gtest.h>

#include "decode_setup.hpp"
#include "tofsmith/core/parallel.hpp"

namespace tofsmith {
namespace {

TEST(TableDepthError, EqualsTheDepthErrorOfTheCode) {
  for (const Readout readout : {Readout::separate, Readout::difference}) {
    Camera camera = camera_with("paper-30x", 2, readout);
    camera.operating.signal_e_per_s = {1e4};
    camera.operating.ambient_e_per_s = {1e4};
    const CodeSet code = build_family("hamiltonian-k3", camera);
    const DecodingTable table = make_decoding_table(ForwardModel(code, camera), camera);
    const Estimate of_code = evaluate(code, camera).points[0].circular_mde_m;
    const Estimate of_table = table_depth_error_m(table, {1e4, 1e4});
    EXPECT_NEAR(of_table.value, of_code.value,
                4 * std::hypot(of_table.standard_error, of_code.standard_error));
    EXPECT_GT(of_table.standard_error, 0.0);
    EXPECT_LT(of_table.standard_error, 0.05 * of_table.value);
  }
}

TEST(TableDepthError, DoesNotDependOnGainOffsetOrThreads) {
  const DecodeSetup setup("hamiltonian-k4", camera_with("paper-10f0"));
  DecodingTable counts = setup.decoder.table();
  const double electrons_m = table_depth_error_m(counts, {2e4, 1e3}, 4000).value;
  counts.gain_e_per_raw << 0.5, 2.0, 0.25, 4.0;
  counts.black_level << 64.0, -32.0, 7.0, 0.0;
  EXPECT_NEAR(table_depth_error_m(counts, {2e4, 1e3}, 4000).value, electrons_m, 1e-5 * electrons_m);
  const ThreadLimit one(1);
  EXPECT_EQ(table_depth_error_m(setup.decoder.table(), {2e4, 1e3}, 4000).value, electrons_m);
}

TEST(TableDepthError, DecreasesWithLight) {
  const DecodeSetup setup("hamiltonian-k4", camera_with("paper-10f0"));
  const DecodingTable& table = setup.decoder.table();
  EXPECT_LT(table_depth_error_m(table, {1e5, 1e3}).value,
            0.5 * table_depth_error_m(table, {1e4, 1e3}).value);
  EXPECT_LT(table_depth_error_m(table, {1e9, 0.0}).value, 1e-3);
  EXPECT_THROW(table_depth_error_m(table, {1e5, 1e3}, 1), std::invalid_argument);
}

}  // namespace
}  // namespace tofsmith
