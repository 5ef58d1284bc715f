// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/io/decoding_table_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "temporary_directory.hpp"
#include "tofsmith/camera/forward_model.hpp"

namespace tofsmith {
namespace {

TEST(CodeOfAFile, IsResampledToTheCamera) {
  const TemporaryDirectory directory;
  Camera camera = built_in_camera("paper-10f0");
  const CodeSet code = build_family("hamiltonian-k5", camera);
  for (const char* name : {"code.json", "code.npz"}) {
    const std::string file = directory.path() / name;
    write_code(file, code, OutputPolicy::refuse_existing);
    camera.samples = 2 * code.samples();
    const CodeSet fine = load_camera_code(file, camera);
    EXPECT_EQ(fine.samples(), camera.samples);
    const ForwardModel of_file(fine, camera),
        of_code(build_family("hamiltonian-k5", camera), camera);
    EXPECT_LT((of_file.correlation(100.5) - of_code.correlation(100.5)).norm(),
              1e-9 * of_code.correlation(100.5).norm())
        << name;
  }
}

TEST(TableOfACode, IsFineEnoughForAnyNumberOfSamples) {
  Camera camera = built_in_camera("paper-30x");
  for (const int samples : {8, 60, 1200}) {
    camera.samples = samples;
    const LoadedDecodingTable loaded = load_decoding_table("multifrequency-k5", camera);
    EXPECT_EQ(loaded.table.bin_count(), samples);
    EXPECT_EQ(furthest_turn_rad(loaded.table), 0.0);
    EXPECT_THAT(loaded.notes,
                testing::Not(testing::Contains(testing::HasSubstr("from row to row"))));
  }
}

}  // namespace
}  // namespace tofsmith
