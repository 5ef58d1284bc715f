// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "tofsmith/code/families.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {
namespace {

std::string refused_field(const Eigen::VectorXd& light, const Eigen::MatrixXd& rows) {
  try {
    CodeSet::create_rows("rows", Waveform::sampled(light), rows);
    return "";
  } catch (const InvalidArgument& error) {
    return error.field();
  }
}

TEST(Rows, WeightsMayHaveAnySignAndScale) {
  const Eigen::MatrixXd weights = 1e3 * Eigen::MatrixXd::Random(12, 5);
  const CodeSet code =
      CodeSet::create_rows("rows", Waveform::sampled(Eigen::VectorXd::Ones(12)), weights);
  EXPECT_TRUE(code.is_rows());
  EXPECT_EQ(code.exposures(), 1);
  EXPECT_EQ(code.measurements(), 5);
  EXPECT_EQ(code.demodulation_samples(), weights);
  EXPECT_EQ(code.resampled(24).demodulation_samples().row(3), weights.row(1));
}

TEST(Rows, ArraysOfAnyScaleAndOrientationGiveTheSameRows) {
  const Eigen::MatrixXd weights = Eigen::MatrixXd::Random(12, 5);
  const Eigen::VectorXd light = Eigen::VectorXd::LinSpaced(12, 0, 11);
  const CodeSet code = CodeSet::create_rows("rows", light, weights);
  EXPECT_NEAR(code.modulation(0).mean(), 1.0, 1e-12);
  EXPECT_EQ(code.demodulation_samples(), weights);
  EXPECT_EQ(CodeSet::create_rows("rows", light, weights.transpose()).demodulation_samples(),
            weights);
  EXPECT_THROW(CodeSet::create_rows("rows", Eigen::VectorXd(-light), weights), InvalidArgument);
}

TEST(Rows, RejectsInvalidLightAndRows) {
  const Eigen::VectorXd light = Eigen::VectorXd::Ones(12);
  const Eigen::MatrixXd rows = Eigen::MatrixXd::Identity(12, 4);
  EXPECT_EQ(refused_field(light, rows), "");
  EXPECT_EQ(refused_field(-light, rows), "modulation 0 minimum");
  EXPECT_EQ(refused_field(0 * light, rows), "light mean");
  EXPECT_EQ(refused_field(2 * light, rows), "modulation 0 mean");
  EXPECT_EQ(refused_field(light.head(11), rows), "light length");
  EXPECT_EQ(refused_field(light, 0 * rows), "row 0");
  EXPECT_EQ(refused_field(light, rows.leftCols(1)), "number of rows");
  EXPECT_EQ(refused_field(Eigen::VectorXd::Ones(20), Eigen::MatrixXd::Ones(20, 17)),
            "number of rows");
}

TEST(Rows, FourierRowsAreOrthogonalAndCancelConstantLight) {
  const CodeSet code = make_family("fourier-k7", {.samples = 60, .peak_factor = 15});
  const Eigen::MatrixXd rows = code.demodulation_samples();
  EXPECT_LT((rows.transpose() * rows - 30 * Eigen::MatrixXd::Identity(7, 7)).norm(), 1e-9);
  EXPECT_LT(rows.colwise().sum().norm(), 1e-9);
  EXPECT_NEAR(code.peak(), 15.0, 1e-12);
}

TEST(Rows, GatesOfAHistogramCoverAllBins) {
  const Eigen::MatrixXd rows = make_family("histogram-k5", {.samples = 60}).demodulation_samples();
  EXPECT_LT((rows.rowwise().sum() - Eigen::VectorXd::Ones(60)).norm(), 1e-9);
  EXPECT_TRUE(why_no_family("histogram-k7", {.samples = 60}));
  EXPECT_TRUE(why_no_family("histogram-k17", {.samples = 340}));
}

TEST(Rows, CodesOfOneLightBecomeRowsWithoutTheirMeans) {
  for (const char* name : {"hamiltonian-k5", "gray-k4", "sinusoid-k4", "square-k4"}) {
    const CodeSet code = make_family(name, {.samples = 240});
    const CodeSet rows = rows_of(code);
    const Eigen::MatrixXd difference = code.demodulation_samples() - rows.demodulation_samples();
    for (int k = 0; k < code.measurements(); ++k)
      EXPECT_LT((difference.col(k).array() - code.demodulation(k).mean()).matrix().norm(), 1e-9);
    EXPECT_EQ(rows.modulation(0), code.modulation(0));
  }
  EXPECT_TRUE(why_no_rows(make_family("multifrequency-k5", {})));
  EXPECT_TRUE(why_no_rows(make_family("sinusoid-k4", {}).with_two_buckets()));
}

}  // namespace
}  // namespace tofsmith
