// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <Eigen/SVD>
#include <cmath>
#include <numbers>
#include <numeric>

#include "decode_setup.hpp"
#include "tofsmith/io/code_file.hpp"
#include "tofsmith/io/depth_file.hpp"
#include "tofsmith/io/measured_table_file.hpp"
#include "tofsmith/io/mesh_file.hpp"
#include "tofsmith/scene/bounced_light.hpp"
#include "tofsmith/scene/ray_caster.hpp"
#include "tofsmith/simulate/bounds.hpp"
#include "tofsmith/simulate/depth_error.hpp"
#include "tofsmith/simulate/multipath_error.hpp"

namespace tofsmith {

namespace {

// A rendered scene published by others; not part of this repository.

const std::filesystem::path groove_file = std::filesystem::path(TOFSMITH_SOURCE_DIR) /
                                          "../shared/data/vgroove_depth_rgb/vgroove_depth.npy";

struct FittedPlane {
  Eigen::Vector3d point, normal;
  double rms_m = 0.0;
};

FittedPlane fit(const Image<float>& depth_m, const PinholeView& view, int first, int last) {
  Eigen::MatrixX3d points(Eigen::Index{depth_m.height} * (last - first), 3);
  Eigen::Index i = 0;
  for (int row = 0; row < depth_m.height; ++row)
    for (int column = first; column < last; ++column)
      points.row(i++) = view.ray(row, column) * static_cast<double>(depth_m(row, column));
  const Eigen::Vector3d centre = points.colwise().mean();
  points.rowwise() -= centre.transpose();
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(points, Eigen::ComputeThinV);
  return {centre, svd.matrixV().col(2),
          svd.singularValues()[2] / std::sqrt(static_cast<double>(points.rows()))};
}

TEST(PublishedScenes, IndirectLightBendsTheWallsOfTheGrooveAsPredicted) {
  if (!std::filesystem::exists(groove_file)) GTEST_SKIP() << "needs " << groove_file;
  const Image<float> depth_m = read_depth(groove_file);
  const auto view = PinholeView::centred(depth_m.width, depth_m.height, std::numbers::pi / 3);
  const FittedPlane left = fit(depth_m, view, 0, 75), right = fit(depth_m, view, 90, 160);
  EXPECT_LT(std::max(left.rms_m, right.rms_m), 0.2e-3) << "half-precision numbers";
  EXPECT_NEAR(left.normal.dot(right.normal), 0.0, 1e-3) << "a right angle";

  const auto wall = [](const FittedPlane& its) {
    return Plane{.point = its.point, .normal = its.normal, .texture = {.albedo = 0.5}};
  };
  const StagedScene groove{.shapes = {wall(left), wall(right)}, .view = view};
  const SceneImage image = RayCaster(groove.shapes, embree_search()).see(view).image;
  float farthest_m = 0.0f;
  for (std::size_t i = 0; i < depth_m.size(); ++i)
    farthest_m = std::max(farthest_m, std::abs(image.depth_m.pixels[i] - depth_m.pixels[i]));
  EXPECT_LT(farthest_m, 2e-3f);

  // Indirect light arrives a few centimetres late, too close for any decoder to separate.
  Camera camera = built_in_camera("paper-10f0");
  camera.sensor.taps = 2;
  const MultipathReturns returns =
      bounced_light(groove, {.rays = 32, .range_m = camera.range_m()}, {}, embree_search());
  const MultipathScene scene = multipath_scene(
      "v-groove", image, view, returns, build_family("hamiltonian-k5", camera), camera,
      {.signal_e_per_s = 1e7, .ambient_e_per_s = 0.0, .reference_distance_m = 0.6});
  double law_m = 0.0;
  for (std::size_t i = 0; i < scene.multipath_ratio.size(); ++i)
    law_m += single_path_bias_m(scene.multipath_ratio.pixels[i], scene.multipath_delay_m.pixels[i]);
  law_m /= static_cast<double>(scene.multipath_ratio.size());
  EXPECT_GT(law_m, 0.01);
  EXPECT_LT(scene.all.bias_m[0], law_m) << "some light comes later than the law reaches";
  EXPECT_GT(scene.all.bias_m[0], 0.8 * law_m);
}

// Measured tables published by others; not part of this repository.

const std::filesystem::path published =
    std::filesystem::path(TOFSMITH_SOURCE_DIR) / "../shared/data";
const std::filesystem::path kea = published / "kea_corrf_hamk3/keatof_2MHz_ham-k3_min.npy";

Camera ideal_camera(int samples, int taps, Readout readout = Readout::separate) {
  Camera camera = camera_with("paper-30x", taps, readout);
  camera.samples = samples;
  camera.light.peak_factor = 1000.0;
  return camera;
}

/// Norm of each bin's measurements after projecting out ambient light (N).
Eigen::VectorXd contrast_of(const DecodingTable& table) {
  const Eigen::VectorXd a = table.exposure_s.cwiseProduct(table.ambient_gain);
  Eigen::MatrixXd x = table.correlation * table.exposure_s.asDiagonal();
  if (!a.isZero(0.0)) x -= x * a * a.transpose() / a.squaredNorm();
  return x.rowwise().norm();
}

/// Number of bins that decode to another bin, except bins equal to a lower one and bins without
/// contrast.
int wrong_bins(const DecodingTable& table) {
  std::vector<std::int32_t> expected(static_cast<std::size_t>(table.samples()));
  std::iota(expected.begin(), expected.end(), 0);
  for (const AmbiguousDepths& pair : ambiguous_depths(table))
    expected[static_cast<std::size_t>(pair.second_bin)] = pair.first_bin;
  const double signal = 1e6 / table.correlation.cwiseAbs().maxCoeff(), ambient = 1e6;
  std::vector<float> raw;
  for (int n = 0; n < table.samples(); ++n)
    for (int k = 0; k < table.measurements(); ++k)
      raw.push_back(static_cast<float>(table.exposure_s[k] * (signal * table.correlation(n, k) +
                                                              ambient * table.ambient_gain[k])));
  const std::vector<std::int32_t> found = bins_of(Decoder(table), raw);
  const Eigen::VectorXd contrast = contrast_of(table);
  int wrong = 0;
  for (int n = 0; n < table.samples(); ++n) {
    const auto at = static_cast<std::size_t>(n);
    wrong += contrast[n] > 1e-6 * contrast.maxCoeff() && found[at] != expected[at];
  }
  return wrong;
}

/// Returns the mean circular depth error [m] at equal light: correlation functions of taps have a
/// peak-to-peak amplitude of 1e5 e/s, differences of taps twice that; A = 1e4 e/s.
Estimate estimated_error_m(const DecodingTable& table, Readout readout = Readout::separate) {
  const Eigen::MatrixXd& chi = table.correlation;
  const double swing = (chi.colwise().maxCoeff() - chi.colwise().minCoeff()).maxCoeff();
  const double swing_e_per_s = readout == Readout::difference ? 2e5 : 1e5;
  return table_depth_error_m(table, {swing_e_per_s / swing, 1e4});
}

double error_m(const DecodingTable& table, Readout readout = Readout::separate) {
  return estimated_error_m(table, readout).value;
}

double ideal_hamiltonian_error_m(int exposures, int taps, Readout readout = Readout::separate) {
  const Camera camera = ideal_camera(240, taps, readout);
  const CodeSet code = build_family("hamiltonian-k" + std::to_string(exposures), camera);
  return error_m(make_decoding_table(ForwardModel(code, camera), camera), readout);
}

TEST(PublishedTables, TheMeasuredHamiltonianTableDecodesItsOwnFrames) {
  if (!std::filesystem::exists(kea)) GTEST_SKIP() << "no published table beside the source";
  MeasuredTableFile file = read_measured_table(kea, {.layout = {2, TapOrder::interleaved}});
  EXPECT_EQ(file.table.samples(), 1939);
  EXPECT_EQ(file.table.columns(), 6);
  EXPECT_EQ(file.notes.size(), 2u);             // transposed, and end point dropped
  file.table.ambient_gain.setConstant(6, 0.5);  // each bucket is open for half of the period
  for (const Readout readout : {Readout::separate, Readout::difference}) {
    const Camera camera = ideal_camera(240, 2, readout);
    const DecodingTable table = make_decoding_table(file.table, camera);
    EXPECT_EQ(table.measurements(), readout == Readout::separate ? 6 : 3);
    EXPECT_EQ(wrong_bins(table), 0);
    const double measured = error_m(table, readout);
    const double ideal = ideal_hamiltonian_error_m(3, 2, readout);
    EXPECT_GT(measured, 0.8 * ideal);
    EXPECT_LT(measured, 2.0 * ideal);
  }
}

TEST(PublishedTables, EveryCodeDecodesItsOwnFramesAsCodeAndAsTable) {
  const std::filesystem::path directory = published / "itof_codes";
  if (!std::filesystem::exists(directory)) GTEST_SKIP() << "no published codes beside the source";
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(directory)) {
    if (entry.path().extension() != ".npz") continue;
    const std::string name = entry.path().stem().string();
    SCOPED_TRACE(name);
    ++files;
    const TapLayout layout = {name.find("complementary") == std::string::npos ? 1 : 2,
                              TapOrder::blocked};
    const CodeSet code = read_code(entry.path(), layout);
    for (int e = 0; e < code.exposures(); ++e) EXPECT_TRUE(code.modulation(e).is_binary());
    const Camera camera = ideal_camera(code.samples(), layout.taps);
    const DecodingTable as_code = make_decoding_table(ForwardModel(code, camera), camera);
    MeasuredTable measured =
        read_measured_table(entry.path(), {.layout = layout, .keep_end_point = true}).table;
    measured.ambient_gain = ambient_gain_of(measured.correlation, MeasuredAmbient::mean);
    const DecodingTable as_table = make_decoding_table(measured, camera);

    EXPECT_LT((as_table.correlation - as_code.correlation).cwiseAbs().maxCoeff(), 1e-9);
    EXPECT_EQ(wrong_bins(as_code), 0);
    EXPECT_EQ(wrong_bins(as_table), 0);
    // The projections of both differ by rounding at most, so that only chance separates the errors.
    const Estimate of_code = estimated_error_m(as_code), of_table = estimated_error_m(as_table);
    const double error = of_code.value;
    EXPECT_NEAR(of_table.value, error,
                5.0 * std::hypot(of_code.standard_error, of_table.standard_error) + 1e-3 * error);
    if (name.find("hamilt") == std::string::npos) continue;
    const double ideal = ideal_hamiltonian_error_m(code.exposures(), layout.taps);
    // Their edges are rounded to few samples, so that neighbouring bins are equal.
    const std::size_t repeated = ambiguous_depths(as_code).size();
    const double lost_m = static_cast<double>(repeated) / code.samples() * as_code.bin_m();
    EXPECT_GT(error, 0.8 * ideal);
    EXPECT_LT(error, 2.0 * ideal + 2.0 * lost_m);
  }
  EXPECT_EQ(files, 13);
}

}  // namespace

}  // namespace tofsmith
