// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/io/code_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <numbers>

#include "damaged_files.hpp"
#include "design_setup.hpp"
#include "io/arrays/shared/array_matrix.hpp"
#include "rows_setup.hpp"
#include "temporary_directory.hpp"
#include "tofsmith/camera/forward_model.hpp"
#include "tofsmith/code/families.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/decode/decoding_table.hpp"
#include "tofsmith/io/atomic_file.hpp"
#include "tofsmith/io/camera_toml.hpp"
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
    return io_error_of([&] { read_rows(light, rows); });
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

using testing::HasSubstr;

Camera mixer_camera() {
  Camera camera = built_in_camera("paper-10f0");
  camera.sensor.demodulation = Demodulation::weight;
  return camera;
}

CodeSet analog_code() {
  Eigen::MatrixXd weights(48, 3);
  for (int e = 0; e < 3; ++e)
    for (int n = 0; n < 48; ++n)
      weights(n, e) = std::sin(2 * std::numbers::pi * ((n + 0.5) / 48 - e / 3.0));
  return CodeSet::create_signed("analog", std::vector<Waveform>(3, rectangular_pulse(0.25)),
                                weights);
}

void expect_same_weights(const CodeSet& a, const CodeSet& b) {
  ASSERT_TRUE(a.is_signed());
  ASSERT_EQ(a.measurements(), b.measurements());
  for (int i = 0; i < a.measurements(); ++i)
    EXPECT_EQ(a.demodulation(i).is_binary(), b.demodulation(i).is_binary());
  EXPECT_LT((a.demodulation_samples() - b.demodulation_samples()).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_LT((a.modulation_samples() - b.modulation_samples()).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(SignedCodes, AreReadBackFromEveryFormat) {
  const TemporaryDirectory directory;
  Camera camera = mixer_camera();
  for (const CodeSet& code : {build_family("hamiltonian-k4", camera), analog_code()}) {
    camera.samples = code.samples();
    for (const char* name : {"a.code.json", "a.npz"}) {
      const std::string path = directory.path() / name;
      write_code(path, code, OutputPolicy::overwrite);
      expect_same_weights(load_code(path, camera), code);
    }
    const std::string csv = directory.path() / "a.csv";
    write_file_atomically(csv, waveforms_to_csv(code, 1e7), OutputPolicy::overwrite);
    const CodeSet read = load_code(csv, camera);
    EXPECT_TRUE(read.is_signed());
    EXPECT_LT((read.demodulation_samples() - code.demodulation_samples()).cwiseAbs().maxCoeff(),
              1e-8);
  }
}

std::string refusal(const std::string& json) {
  return io_error_of([&] { parse_code_json(json, "a.code.json"); });
}

TEST(SignedCodes, RejectInvalidWeights) {
  const std::string json = code_to_json(analog_code());
  const auto with = [&](const std::string& before, const std::string& after) {
    std::string changed = json;
    const std::size_t at = changed.find(before);
    EXPECT_NE(at, std::string::npos) << before;
    return changed.replace(at, before.size(), after);
  };
  EXPECT_THAT(refusal(with("\"signed\": true", "\"signed\": true, \"rows\": true")),
              HasSubstr("is not valid for rows, whose weights are always signed"));
  EXPECT_THAT(refusal(with("\"taps\": 1", "\"taps\": 2")), HasSubstr("1 for a mixer"));
  EXPECT_NE(refusal(with("\"signed\": true", "\"signed\": false")), "");
  const std::string npz_path = "a.npz";
  const auto archive = serialize_code_npz(analog_code());
  EXPECT_THROW(parse_code_npz(archive, npz_path), IoError) << "gains are not negative";
  EXPECT_NO_THROW(parse_code_npz(archive, npz_path, {.is_signed = true}));
}

TEST(SignedCameras, AreReadAndWritten) {
  const Camera camera = mixer_camera();
  const std::string toml = camera_to_toml(camera);
  EXPECT_THAT(toml, HasSubstr("demodulation = \"signed\""));
  EXPECT_EQ(parse_camera_toml(toml, "a.toml"), camera);
}

constexpr TapLayout blocked = {2, TapOrder::blocked}, interleaved = {2, TapOrder::interleaved};

CodeSet hamiltonian() { return make_family("hamiltonian-k3", {.samples = 60, .peak_factor = 10}); }

Eigen::MatrixXd matrix(const NpzArrays& arrays, const char* name) {
  return matrix_of(arrays.at(name), name);
}

FileBytes with_value(const CodeSet& code, const char* name, int n, int i, double value) {
  NpzArrays arrays = parse_npz(serialize_code_npz(code, TapOrder::interleaved), "a.npz");
  Eigen::MatrixXd changed = matrix(arrays, name);
  changed(n, i) = value;
  arrays[name] = array_of(changed);
  return serialize_npz(arrays);
}
std::string refusal(const FileBytes& bytes, const TapLayout& layout = {}) {
  return io_error_of([&] { parse_code_npz(bytes, "a.npz", layout); });
}

TEST(CodeNpz, BinaryCodesOnTheGridAreReadBack) {
  for (const char* name : {"hamiltonian-k3", "hamiltonian-k4", "hamiltonian-k5", "gray-k4"}) {
    const int samples = std::string(name) == "gray-k4" ? 64 : 60;
    const CodeSet code = make_family(name, {.samples = samples});
    const CodeSet back = parse_code_npz(serialize_code_npz(code), "dir/my-code.npz");
    EXPECT_EQ(back.name(), "my-code");
    ASSERT_EQ(back.measurements(), code.measurements());
    for (int i = 0; i < code.measurements(); ++i) {
      EXPECT_TRUE(back.demodulation(i).is_binary());
      EXPECT_TRUE(back.modulation(i).is_binary());
    }
    expect_same_samples(back, code);
  }
}

TEST(CodeNpz, SampledCodesAreReadBackExactly) {
  const CodeSet code = make_family("sinusoid-k4", {.samples = 64, .peak_factor = 10});
  const CodeSet back = parse_code_npz(serialize_code_npz(code), "a.npz");
  EXPECT_FALSE(back.modulation(0).is_binary());
  EXPECT_EQ(back.modulation_samples(), code.modulation_samples());
  // Values rounded below 0 are clipped.
  EXPECT_LT((back.demodulation_samples() - code.demodulation_samples()).norm(), 1e-12);
}

TEST(CodeNpz, CorrelationsAreSamplesOfTheContinuousFunctions) {
  const CodeSet code = hamiltonian();
  const NpzArrays arrays = parse_npz(serialize_code_npz(code), "a.npz");
  const Eigen::MatrixXd correlation = matrix(arrays, "corrfs");
  for (int i = 0; i < code.measurements(); ++i) {
    const CorrelationFunction exact(code.demodulation(i), code.modulation_of(i));
    EXPECT_TRUE(correlation.col(i).isApprox(exact.table(code.samples()), 1e-12)) << i;
  }
}

TEST(CodeNpz, TapsAreReadBackInTheOrderWritten) {
  const CodeSet code = hamiltonian().with_two_buckets();
  const FileBytes in_blocks = serialize_code_npz(code, TapOrder::blocked);
  const FileBytes in_turn = serialize_code_npz(code, TapOrder::interleaved);
  EXPECT_NE(in_blocks, in_turn);
  expect_same_samples(parse_code_npz(in_blocks, "a.npz", blocked), code);
  expect_same_samples(parse_code_npz(in_turn, "a.npz", interleaved), code);
  EXPECT_THROW(serialize_code_npz(code), std::invalid_argument);
}

TEST(CodeNpz, TheOrderOfTapsIsNeverGuessed) {
  const FileBytes bytes =
      serialize_code_npz(hamiltonian().with_two_buckets(), TapOrder::interleaved);
  EXPECT_EQ(refusal(bytes, {2, std::nullopt}),
            "a.npz: does not specify the column order of its 2 taps; expected --tap-order blocked "
            "or interleaved");
  EXPECT_EQ(refusal(bytes, {4, TapOrder::blocked}),
            "a.npz: found 6 columns; expected a multiple of taps = 4");
}

TEST(CodeNpz, OneExposureNeedsNoOrder) {
  std::vector<Waveform> gates;
  for (int tap = 0; tap < 3; ++tap) {
    Eigen::VectorXd gate = Eigen::VectorXd::Zero(60);
    gate.segment(20 * tap, 10 + 5 * tap).setConstant(0.5);
    gates.push_back(Waveform::sampled(gate));
  }
  const CodeSet code = CodeSet::create("a", 60, 3, {square_wave(1, 0.0)}, gates);
  const FileBytes bytes = serialize_code_npz(code);
  for (const std::optional<TapOrder> order :
       {std::optional<TapOrder>(), std::optional(TapOrder::blocked),
        std::optional(TapOrder::interleaved)}) {
    EXPECT_EQ(serialize_code_npz(code, order), bytes);
    expect_same_samples(parse_code_npz(bytes, "a.npz", {3, order}), code);
  }
}

TEST(CodeNpz, TapsOfOneExposureShareTheLight) {
  const CodeSet code = hamiltonian().with_two_buckets();
  EXPECT_EQ(refusal(with_value(code, "modfs", 7, 3, 0.25), interleaved),
            "a.npz: modfs[7, 3]: found 0.25; expected 6 as in column 2, a tap of the same "
            "exposure");
}

TEST(CodeNpz, RoundingErrorIsNotANegativeGain) {
  const CodeSet code = hamiltonian();
  expect_same_samples(parse_code_npz(with_value(code, "demodfs", 59, 0, -1e-16), "a.npz"), code);
  expect_same_samples(parse_code_npz(with_value(code, "demodfs", 1, 0, 1 + 1e-15), "a.npz"), code);
}

TEST(CodeNpz, KeepsTheScaleOfTheModulation) {
  const Eigen::MatrixXd light = 0.9375 * hamiltonian().modulation_samples();
  const CodeSet code =
      parse_code_npz(serialize_npz({{"modfs", array_of(light)},
                                    {"demodfs", array_of(hamiltonian().demodulation_samples())}}),
                     "a.npz");
  EXPECT_TRUE(code.modulation(0).is_binary());
  EXPECT_NEAR(code.modulation(0).mean(), 0.9375, 1e-12);
}

TEST(CodeNpz, RejectsInvalidValues) {
  EXPECT_EQ(refusal(with_value(hamiltonian(), "demodfs", 2, 1, -0.25)),
            "a.npz: demodfs[2, 1]: found -0.25; expected a gain in [0, 1]");
  EXPECT_EQ(refusal(with_value(hamiltonian(), "demodfs", 2, 1, 1.5)),
            "a.npz: demodfs[2, 1]: found 1.5; expected a gain in [0, 1]");
  EXPECT_EQ(refusal(with_value(hamiltonian(), "modfs", 2, 1, -0.25)),
            "a.npz: modfs[2, 1]: found -0.25; expected power over average power, >= 0");
  EXPECT_EQ(refusal(with_value(hamiltonian(), "modfs", 2, 1, std::nan(""))),
            "a.npz: modfs[2, 1]: found nan; expected a finite number");
  EXPECT_THAT(refusal(with_value(hamiltonian(), "modfs", 30, 1, 6.0)),
              HasSubstr("a.npz: modulation 1 mean = 1.1; must be <= 1"));
}

TEST(CodeNpz, RejectsInconsistentArrays) {
  const auto refusal_of = [](NpyShape light, NpyShape gains, NpyShape correlation) {
    return refusal(serialize_npz({{"modfs", NpyArray(NpyType::float64, light)},
                                  {"demodfs", NpyArray(NpyType::float64, gains)},
                                  {"corrfs", NpyArray(NpyType::float64, correlation)}}));
  };
  EXPECT_EQ(refusal_of({8, 3}, {8, 4}, {8, 3}),
            "a.npz: demodfs: found the shape (8, 4); expected (8, 3) as of a.npz: modfs");
  EXPECT_EQ(refusal_of({8, 3}, {8, 3}, {9, 3}),
            "a.npz: corrfs: found the shape (9, 3); expected (8, 3) as of a.npz: modfs");
  EXPECT_EQ(refusal_of({8}, {8, 3}, {8, 3}), "a.npz: modfs: found the shape (8,); expected (N, K)");
  EXPECT_EQ(refusal_of({8, 0}, {8, 0}, {8, 0}),
            "a.npz: modfs: found the shape (8, 0); expected (N, K)");
  EXPECT_THAT(refusal_of({70000, 1}, {70000, 1}, {70000, 1}), HasSubstr("with N in [2, 65536]"));
  EXPECT_THAT(refusal(serialize_npz({{"modfs", array_of(hamiltonian().modulation_samples())}})),
              HasSubstr("there is no array 'demodfs'"));
  EXPECT_EQ(refusal(serialize_npz({{"curves", array_of(hamiltonian().modulation_samples())}})),
            "a.npz: found the arrays curves; expected modfs and demodfs, a code, or corrfs, a "
            "measured table");
}

}  // namespace

}  // namespace tofsmith
