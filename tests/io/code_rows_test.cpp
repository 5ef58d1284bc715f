// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "io/arrays/shared/array_matrix.hpp"
#include "rows_setup.hpp"
#include "same_code.hpp"
#include "temporary_directory.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/decode/decoding_table.hpp"
#include "tofsmith/io/code_file.hpp"
#include "tofsmith/io/npy.hpp"

namespace tofsmith {
namespace {

struct Pair {
  Pair(const Eigen::MatrixXd& light_values, const Eigen::MatrixXd& rows_values)
      : light(directory.path() / "light.npy"), rows(directory.path() / "rows.npy") {
    write_npy(light, array_of(light_values), OutputPolicy::overwrite);
    write_npy(rows, array_of(rows_values), OutputPolicy::overwrite);
  }
  std::string refusal() const {
    try {
      read_rows(light, rows);
      return "";
    } catch (const IoError& error) {
      return error.what();
    }
  }

  TemporaryDirectory directory;
  std::filesystem::path light, rows;
};

Eigen::VectorXd pulse(int samples) {
  Eigen::VectorXd light = Eigen::VectorXd::Constant(samples, 0.01);
  light.segment(3, 4).setConstant(7.0);
  return light;
}

TEST(CodeRows, AnyScaleAndOrientationGivesTheSameCode) {
  const Eigen::MatrixXd weights = Eigen::MatrixXd::Random(32, 5);
  const Pair columns(pulse(32), weights);
  const CodeSet code = read_rows(columns.light, columns.rows);
  EXPECT_EQ(code.name(), "rows");
  EXPECT_NEAR(code.modulation(0).mean(), 1.0, 1e-12);
  EXPECT_LT((code.demodulation_samples() - weights).norm(), 1e-12);
  const Pair lines(1024 * pulse(32).transpose(), weights.transpose());
  expect_same_code(read_rows(lines.light, lines.rows), code);
  const Pair repeated(pulse(32).replicate(1, 5), weights);
  expect_same_code(read_rows(repeated.light, repeated.rows), code);
  expect_same_code(load_code(columns.light.string() + "," + columns.rows.string(), rows_camera(32)),
                   code);
}

TEST(CodeRows, JsonStoresRows) {
  const CodeSet code = build_family("fourier-k5", rows_camera());
  const CodeSet read = parse_code_json(code_to_json(code));
  EXPECT_TRUE(read.is_rows());
  expect_same_code(read, code);
}

TEST(CodeRows, ErrorsReportTheirPlace) {
  const Eigen::MatrixXd weights = Eigen::MatrixXd::Random(32, 5);
  Eigen::VectorXd negative = pulse(32);
  negative[7] = -1.0;
  EXPECT_THAT(Pair(negative, weights).refusal(), testing::HasSubstr("light.npy[7, 0]: found -1"));
  EXPECT_THAT(Pair(0 * pulse(32), weights).refusal(), testing::HasSubstr("only zeros"));
  EXPECT_THAT(Pair(pulse(32), 0 * weights).refusal(), testing::HasSubstr("zeros in row 0"));
  EXPECT_THAT(Pair(pulse(31), weights).refusal(),
              testing::HasSubstr("found the shape (32, 5); expected (N, K) or (K, N) with the N = "
                                 "31 time bins of the light; a period omits its end point"));
  EXPECT_THAT(Pair(pulse(32), Eigen::MatrixXd::Ones(32, 17)).refusal(),
              testing::HasSubstr("found 17 rows"));
  Eigen::MatrixXd infinite = weights;
  infinite(3, 1) = INFINITY;
  EXPECT_THAT(Pair(pulse(32), infinite).refusal(),
              testing::HasSubstr("rows.npy[3, 1]: found inf; expected a finite number"));
  Eigen::MatrixXd two_lights = pulse(32).replicate(1, 2);
  two_lights(4, 1) = 1.0;
  EXPECT_THAT(Pair(two_lights, weights).refusal(), testing::HasSubstr("the same light"));
}

TEST(CodeRows, PublishedCodesAreUsableAsRows) {
  const std::filesystem::path folder =
      std::filesystem::path(TOFSMITH_SOURCE_DIR) / "../shared/data/itof_codes";
  const std::filesystem::path file = folder / "k-4_n-64_hamilt.npz";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "without the published codes";
  const Camera camera = rows_camera(64);
  const CodeSet code = load_code(file.string(), camera);
  EXPECT_EQ(code.measurements(), 4);
  EXPECT_FALSE(why_not_decodable(make_decoding_table(ForwardModel(code, camera), camera)));
}

}  // namespace
}  // namespace tofsmith
