// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "decode/search/cell_table.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "core/shared/random.hpp"
#include "decode/search/arc_search.hpp"
#include "decode/search/chord_matcher.hpp"
#include "decode_setup.hpp"
#include "each_target.hpp"
#include "generated_shapes.hpp"
#include "reference_decoder.hpp"
#include "tofsmith/core/units.hpp"

namespace tofsmith {

namespace {

// Branch and bound over arcs, compared with an exhaustive search in double.

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

/// @param deviation  noise of each component, relative to unit directions
Vectors noisy_vectors(const DirectionTable& directions, double deviation, int count,
                      std::uint64_t seed) {
  RandomStream random(seed, 1);
  const int rank = directions.rank();
  Vectors vectors{rank, {}, {}, {}};
  vectors.plane.resize(
      static_cast<std::size_t>((count + tile_pixels - 1) / tile_pixels * tile_pixels * rank));
  for (int i = 0; i < count; ++i) {
    const double scale = std::exp(5.0 * random.normal());
    const auto row = static_cast<std::int32_t>(directions.samples() * random.uniform());
    const double t = random.uniform();
    Eigen::VectorXd q(rank);
    for (int j = 0; j < rank; ++j)
      q[j] = scale * ((1.0 - t) * directions.direction(row, j) +
                      t * directions.direction((row + 1) % directions.samples(), j) +
                      deviation * random.normal());
    float* first = &vectors.plane[static_cast<std::size_t>(i / tile_pixels * tile_pixels * rank +
                                                           i % tile_pixels)];
    double square = 0.0;
    for (int j = 0; j < rank; ++j) {
      vectors.exact.push_back(q[j]);
      first[j * tile_pixels] = static_cast<float>(q[j]);
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
std::int32_t lowest_best_row(const DirectionTable& directions, const double* q) {
  Eigen::VectorXd score = Eigen::VectorXd::Zero(directions.samples());
  for (std::int32_t n = 0; n < directions.samples(); ++n)
    for (int j = 0; j < directions.rank(); ++j) score[n] += q[j] * directions.direction(n, j);
  const double length = Eigen::Map<const Eigen::VectorXd>(q, directions.rank()).norm();
  const double least = score.maxCoeff() - tie_tolerance * length;
  return static_cast<std::int32_t>(
      std::find_if(score.begin(), score.end(), [&](double s) { return s >= least; }) -
      score.begin());
}

/// Returns the smallest fraction of proven vectors.
double expect_agreement(const DirectionTable& directions, const ArcSearch& search,
                        const Vectors& vectors) {
  std::vector<std::int32_t> expected;
  for (int i = 0; i < vectors.count(); ++i)
    expected.push_back(lowest_best_row(directions, vectors[i]));
  std::size_t min_proven = expected.size();
  for_each_target([&](std::int64_t target) {
    const std::vector<std::int32_t> rows = search_all(search, vectors);
    std::size_t proven = 0, wrong = 0;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      proven += rows[i] >= 0;
      wrong += rows[i] >= 0 && rows[i] != expected[i];
    }
    EXPECT_EQ(wrong, 0u);
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

// Cells of a cube map, each with a list of directions.

TEST(CellTable, SupportsRanksThreeAndFourOnly) {
  for (const auto& [code, serves] : {std::pair{"hamiltonian-k3", false},
                                     {"hamiltonian-k4", true},
                                     {"hamiltonian-k5", true},
                                     {"hamiltonian-k6", false}})
    EXPECT_EQ(CellTable::serves(DistinctDirections(directions_of(code, 240, 240))), serves) << code;
}

TEST(CellTable, StaysSmallOnFineGrids) {
#ifdef NDEBUG
  const DirectionTable directions = directions_of("hamiltonian-k5", 240, 9960);
  const DistinctDirections distinct(directions);
  const CellTable cells(distinct);
  EXPECT_EQ(cells.rank(), 4);
  EXPECT_LE((cells.cells().size() + cells.lists().size()) * sizeof(CellRecord) +
                cells.roots().size() * sizeof(std::uint32_t),
            std::size_t{16} << 20);
#else
  GTEST_SKIP() << "takes too long without optimization";
#endif
}

// Tables with large angles between bins, compared with a search of all their chords.

/// Returns a curve of random harmonics with large angles between rows. A component at the highest
/// frequency prevents interpolation as a smooth curve.
DecodingTable coarse_table(int measurements, int samples, std::uint64_t seed) {
  const int harmonics = measurements;
  DecodingTable table =
      decoding_table_of("sinusoid-k" + std::to_string(measurements), camera_with("paper-10f0"));
  RandomStream random(seed, 0);
  table.correlation.resize(samples, measurements);
  for (int k = 0; k < measurements; ++k) {
    Eigen::VectorXd of_tap = Eigen::VectorXd::Zero(samples);
    for (int h = 1; h <= harmonics; ++h) {
      const double phase = 2.0 * std::numbers::pi * random.uniform(), size = random.uniform();
      for (int n = 0; n < samples; ++n)
        of_tap[n] += size * std::cos(2.0 * std::numbers::pi * h * n / samples + phase);
    }
    for (int n = 0; n < samples; n += 2) of_tap[n] += 1e-3;
    of_tap.array() -= of_tap.minCoeff();
    table.correlation.col(k) = of_tap / of_tap.maxCoeff();
  }
  table.shot_correlation = {};
  table.validate();
  return table;
}

/// Chords up to 10 degrees are not subdivided; two depths closer than half of that may be confused.
constexpr double closest_score = 1.0 - 4e-3;

/// Excludes jumps.
double best_score(const ReferenceDecoder& reference, const Eigen::VectorXd& difference,
                  const Eigen::VectorXd& turn_rad) {
  double best = 0.0;
  for (int n = 0; n < turn_rad.size(); ++n) {
    const auto before = n > 0 ? n - 1 : turn_rad.size() - 1;
    if (std::max(turn_rad[n], turn_rad[before]) <= jump_turn_rad)
      best = std::max(best, reference.best_score_beside(difference, n));
  }
  return best;
}

class CoarseTable : public testing::TestWithParam<int> {};

TEST_P(CoarseTable, FindsEveryDepthBetweenItsBinsWithoutNoise) {
  for (const int samples : {24, 36, 60}) {
    const DecodingTable table = coarse_table(GetParam(), samples, 7);
    ASSERT_GT(furthest_turn_rad(table), coarse_turn_rad);
    const Eigen::VectorXd turn_rad = turns_of(AmbientProjection(table).curve);
    const Decoder decoder(table);
    const ReferenceDecoder reference(table);
    std::vector<float> raw;
    std::vector<double> truth;
    for (int i = 0; i < 10 * samples; ++i) {
      const double depth_bin = 0.1 * i;
      if (turn_rad[static_cast<int>(depth_bin)] > jump_turn_rad) continue;
      truth.push_back(depth_bin);
      append_pixel(table, 1e6, 0.0, depth_bin, nullptr, raw);
    }
    const std::vector<double> found = depth_bins_of(decoder, raw);
    int off = 0;
    for (std::size_t i = 0; i < truth.size(); ++i) {
      const Eigen::VectorXd difference =
          reference.difference(&raw[i * static_cast<std::size_t>(table.measurements())]);
      EXPECT_GE(reference.score_at(difference, found[i]), closest_score * difference.norm());
      off += std::abs(circular_difference(found[i], truth[i], samples)) > 1e-3;
    }
    EXPECT_LE(off, std::ssize(truth) / 50) << samples;
  }
}

TEST_P(CoarseTable, FindsTheBestOfAllChords) {
  const DecodingTable table = coarse_table(GetParam(), 60, 3);
  const Eigen::VectorXd turn_rad = turns_of(AmbientProjection(table).curve);
  const Decoder decoder(table);
  const ReferenceDecoder reference(table);
  constexpr int pixels = 400;
  const std::vector<float> raw = noisy_pixels(table, 1e5, 1e4, pixels, 5);
  const std::vector<double> found = depth_bins_of(decoder, raw);
  std::vector<float> depth_m(pixels);
  DecodedView planes;
  planes.depth_m = depth_m.data();
  decoder.decode(RawView::interleaved(raw.data(), 1, pixels, table.measurements()), planes);
  int ties = 0;
  for (std::size_t i = 0; i < pixels; ++i) {
    const Eigen::VectorXd difference =
        reference.difference(&raw[i * static_cast<std::size_t>(table.measurements())]);
    const double best = best_score(reference, difference, turn_rad);
    const double score = reference.score_at(difference, found[i]);
    EXPECT_GE(score, closest_score * best);
    ties += score < (1.0 - 1e-9) * best;
    EXPECT_NEAR(circular_difference(depth_m[i] / table.bin_m(), found[i], 60.0), 0.0, 1e-3);
  }
  EXPECT_LE(ties, pixels / 50);
}

TEST_P(CoarseTable, DoesNotChangeTheBestBins) {
  const DecodingTable table = coarse_table(GetParam(), 60, 3);
  const Decoder decoder(table);
  const ReferenceDecoder reference(table);
  constexpr int pixels = 500;
  const std::vector<float> raw = noisy_pixels(table, 1e4, 1e4, pixels, 5);
  const std::vector<std::int32_t> bins = bins_of(decoder, raw);
  std::vector<std::int32_t> plane(pixels);
  std::vector<float> depth_m(pixels);
  DecodedView planes;
  planes.bin = plane.data();
  planes.depth_m = depth_m.data();
  decoder.decode(RawView::interleaved(raw.data(), 1, pixels, table.measurements()), planes);
  EXPECT_EQ(plane, bins);
  for (std::size_t i = 0; i < pixels; ++i)
    EXPECT_EQ(bins[i], reference.bin(&raw[i * static_cast<std::size_t>(table.measurements())]));
}

INSTANTIATE_TEST_SUITE_P(Measurements, CoarseTable, testing::Values(4, 5, 7));

TEST(ChordMatcher, DoesNotSubdivideFineTablesOrJumps) {
  for (const char* code :
       {"hamiltonian-k3", "hamiltonian-k4", "hamiltonian-k5", "sinusoid-k4", "double-ramp-k3"}) {
    const DecodingTable table = decoding_table_of(code, camera_with("paper-10f0"));
    EXPECT_FALSE(ChordMatcher(table, AmbientProjection(table)).is_coarse()) << code;
  }
}

}  // namespace

}  // namespace tofsmith
