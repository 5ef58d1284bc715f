// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/io/code_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "damaged_files.hpp"
#include "io/arrays/shared/array_matrix.hpp"
#include "same_code.hpp"
#include "tofsmith/camera/forward_model.hpp"
#include "tofsmith/code/families.hpp"
#include "tofsmith/io/npy.hpp"

namespace tofsmith {
namespace {

using testing::HasSubstr;

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
    EXPECT_EQ(serialize_code_npz(back),
              serialize_code_npz(parse_code_npz(serialize_code_npz(back), "again.npz")));
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

TEST(CodeNpz, RefusesEveryTruncation) {
  const CodeSet code = make_family("hamiltonian-k3", {.samples = 12}).with_two_buckets();
  const FileBytes bytes = serialize_code_npz(code, TapOrder::blocked);
  const auto parse = [](std::span<const std::byte> part) {
    parse_code_npz(part, "a.npz", blocked);
  };
  expect_truncations_refused(bytes, parse);
}

}  // namespace
}  // namespace tofsmith
