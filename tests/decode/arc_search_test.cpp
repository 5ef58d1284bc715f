// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Branch and bound over arcs, compared with an exhaustive search in double.
#include "decode/search/arc_search.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <string>

#include "directions_setup.hpp"
#include "each_target.hpp"
#include "generated_curves.hpp"

namespace tofsmith {
namespace {

// Debug builds and sanitizers test a sample only.
#ifdef NDEBUG
constexpr int vectors_per_level = 4096;
#else
constexpr int vectors_per_level = 128;
#endif

/// Noisy vectors near the curve, in double and as scaled floats.
struct Vectors {
  int rank;
  std::vector<double> exact;  // (count, rank)
  std::vector<float> plane;   // [tile of 64][rank][64]
  std::vector<float> error;

  int count() const { return static_cast<int>(error.size()); }
  const double* operator[](int i) const { return &exact[static_cast<std::size_t>(i * rank)]; }
  const float* tile(int first) const { return &plane[static_cast<std::size_t>(first * rank)]; }
};
constexpr int tile_pixels = 64;

/// @param deviation       noise of each component, relative to unit directions
/// @param relative_error  error of the float vectors, relative to their length
Vectors noisy_vectors(const DirectionTable& directions, double deviation, int count,
                      std::uint64_t seed, double relative_error = 0.0) {
  RandomStream random(seed, 1);
  const int rank = directions.rank();
  Vectors vectors{rank, {}, {}, {}};
  vectors.plane.resize(
      static_cast<std::size_t>((count + tile_pixels - 1) / tile_pixels * tile_pixels * rank));
  for (int i = 0; i < count; ++i) {
    const double scale = std::exp(5.0 * random.normal());
    const auto row = static_cast<std::int32_t>(directions.samples() * random.uniform());
    const double t = random.uniform();
    Eigen::VectorXd q(rank), wrong(rank);
    for (int j = 0; j < rank; ++j) {
      q[j] = (1.0 - t) * directions.direction(row, j) +
             t * directions.direction((row + 1) % directions.samples(), j) +
             deviation * random.normal();
      wrong[j] = random.normal();
    }
    q *= scale;
    wrong *= relative_error * q.norm() / wrong.norm();
    float* first = &vectors.plane[static_cast<std::size_t>(i / tile_pixels * tile_pixels * rank +
                                                           i % tile_pixels)];
    double square = 0.0;
    for (int j = 0; j < rank; ++j) {
      vectors.exact.push_back(q[j]);
      first[j * tile_pixels] = static_cast<float>(q[j] + wrong[j]);
      square += (q[j] - first[j * tile_pixels]) * (q[j] - first[j * tile_pixels]);
    }
    vectors.error.push_back(std::nextafter(static_cast<float>(std::sqrt(square)), 1e30f));
  }
  return vectors;
}

std::vector<std::int32_t> search_all(const ArcSearch& search, const Vectors& vectors) {
  std::vector<std::int32_t> rows(static_cast<std::size_t>(vectors.count()));
  for (int first = 0; first < vectors.count(); first += tile_pixels)
    search.search(vectors.tile(first), tile_pixels, &vectors.error[static_cast<std::size_t>(first)],
                  std::min(tile_pixels, vectors.count() - first),
                  &rows[static_cast<std::size_t>(first)]);
  return rows;
}

/// Reference: dot products in double, lowest row of equal ones.
std::int32_t lowest_best_row(const DirectionTable& directions, const double* q,
                             std::vector<double>& score) {
  const int samples = directions.samples();
  score.resize(static_cast<std::size_t>(samples));
  double length = 0.0;
  for (int j = 0; j < directions.rank(); ++j) length += q[j] * q[j];
  length = std::sqrt(length);
  for (std::int32_t n = 0; n < samples; ++n) {
    double sum = q[0] * directions.direction(n, 0);
    for (int j = 1; j < directions.rank(); ++j) sum += q[j] * directions.direction(n, j);
    score[static_cast<std::size_t>(n)] = sum;
  }
  const double least = *std::max_element(score.begin(), score.end()) - tie_tolerance * length;
  return static_cast<std::int32_t>(
      std::find_if(score.begin(), score.end(), [&](double s) { return s >= least; }) -
      score.begin());
}

std::vector<double> unit_of(const double* q, int rank) {
  const Eigen::VectorXd unit = Eigen::Map<const Eigen::VectorXd>(q, rank).normalized();
  return {unit.begin(), unit.end()};
}

/// Returns the smallest fraction of proven vectors.
double expect_agreement(const DirectionTable& directions, const ArcSearch& search,
                        const Vectors& vectors) {
  std::vector<std::int32_t> expected, chosen;
  std::vector<std::vector<double>> units;
  std::vector<double> score;
  for (int i = 0; i < vectors.count(); ++i) {
    expected.push_back(lowest_best_row(directions, vectors[i], score));
    units.push_back(unit_of(vectors[i], vectors.rank));
    chosen.push_back(lowest_best_row(directions, units.back().data(), score));
  }
  std::size_t min_proven = expected.size();
  for_each_target([&](std::int64_t target) {
    const std::vector<std::int32_t> rows = search_all(search, vectors);
    std::size_t proven = 0, wrong = 0, wrongly_chosen = 0;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      proven += rows[i] >= 0;
      wrong += rows[i] >= 0 && rows[i] != expected[i];
      wrongly_chosen += search.choose(directions, units[i].data(), 1, tie_tolerance) != chosen[i];
    }
    EXPECT_EQ(wrong, 0u);
    EXPECT_EQ(wrongly_chosen, 0u);
    if (target != HWY_SCALAR) min_proven = std::min(min_proven, proven);
  });
  return static_cast<double>(min_proven) / static_cast<double>(expected.size());
}

constexpr double noise_levels[] = {0.0, 0.02, 0.15, 0.6, 100.0};

/// Returns the fraction proven at the middle level.
double expect_agreement_at_all_levels(const DirectionTable& directions, int count) {
  const ArcSearch search(directions);
  double share = 0.0;
  std::uint64_t seed = 1;
  for (const double deviation : noise_levels) {
    SCOPED_TRACE("deviation " + std::to_string(deviation));
    const double proven =
        expect_agreement(directions, search, noisy_vectors(directions, deviation, count, seed++));
    if (deviation == 0.15) share = proven;
  }
  return share;
}

struct CodeCase {
  const char* code;
  int code_samples;
  int samples;
  double min_proven;
};

class ArcSearchOfCode : public testing::TestWithParam<CodeCase> {};

TEST_P(ArcSearchOfCode, AgreesWithExhaustiveSearchAndProvesAlmostAll) {
  const CodeCase& c = GetParam();
  const DirectionTable directions = directions_of(c.code, c.code_samples, c.samples);
  const double proven = expect_agreement_at_all_levels(directions, vectors_per_level);
  EXPECT_GT(proven, c.min_proven);
}

INSTANTIATE_TEST_SUITE_P(
    Codes, ArcSearchOfCode,
    testing::Values(CodeCase{"hamiltonian-k6", 240, 240, 0.99},
                    CodeCase{"hamiltonian-k7", 252, 1000, 0.99},
                    CodeCase{"hamiltonian-k8", 252, 1000, 0.99},
                    CodeCase{"hamiltonian-k8", 252, 4100, 0.98},
                    CodeCase{"multifrequency-1x3-2x3-3x3-4x3", 240, 1000, 0.99},
                    CodeCase{"gray-k4", 240, 1000, 0.9}, CodeCase{"gray-k6", 256, 256, 0.9}));

TEST(ArcSearch, ProvesNothingForUnknownVectors) {
  const DirectionTable directions = directions_of(random_smooth_curve(5, 500, 9));
  const ArcSearch search(directions);
  constexpr float infinity = std::numeric_limits<float>::infinity();
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  const Vectors known = noisy_vectors(directions, 0.0, tile_pixels, 10);
  const auto expect_none = [&](const Vectors& vectors) {
    for_each_target([&](std::int64_t) {
      for (const std::int32_t row : search_all(search, vectors)) EXPECT_EQ(row, -1);
    });
  };
  for (const float error : {infinity, nan}) {
    Vectors vectors = known;
    std::fill(vectors.error.begin(), vectors.error.end(), error);
    expect_none(vectors);
  }
  for (const float factor : {0.0f, 1e-30f, 1e30f, infinity, nan}) {
    Vectors vectors = known;
    for (float& component : vectors.plane) component *= factor;
    std::fill(vectors.error.begin(), vectors.error.end(), 0.0f);
    expect_none(vectors);
  }
  const std::vector<double> zero(5, 0.0);
  EXPECT_EQ(search.choose(directions, zero.data(), 1, tie_tolerance), 0);
}

}  // namespace
}  // namespace tofsmith
