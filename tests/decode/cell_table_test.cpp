// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "decode/search/cell_table.hpp"

#include <gtest/gtest.h>

#include "core/shared/random.hpp"
#include "directions_setup.hpp"

namespace tofsmith {
namespace {

#ifdef NDEBUG
constexpr int vectors = 20000;
#else
constexpr int vectors = 500;
#endif

struct Cells {
  explicit Cells(DirectionTable table)
      : directions(std::move(table)), distinct(directions), cells(distinct) {}

  DirectionTable directions;
  DistinctDirections distinct;
  CellTable cells;
};

bool holds(const CellRecord& run, std::int32_t direction, std::int32_t count) {
  return (direction - run.first + count) % count <= run.length;
}

Eigen::VectorXd draw(const DistinctDirections& distinct, RandomStream& random) {
  const double noise = random.uniform() < 0.3 ? 100.0 : 0.5 * random.uniform();
  const auto n = static_cast<Eigen::Index>(distinct.count() * random.uniform());
  Eigen::VectorXd q = distinct.unit.row(n).transpose();
  for (double& component : q) component += noise * random.normal();
  return q.normalized();
}

void expect_winners_in_their_cells(const Cells& all, std::uint64_t seed) {
  RandomStream random(seed, 0);
  int lists = 0;
  for (int i = 0; i < vectors; ++i) {
    const Eigen::VectorXd q = draw(all.distinct, random);
    Eigen::Index winner = 0;
    (all.distinct.unit * q).maxCoeff(&winner);
    const std::span<const CellRecord> runs = all.cells.runs(q.data());
    lists += runs.size() > 1 ? 1 : 0;
    ASSERT_TRUE(std::any_of(runs.begin(), runs.end(), [&](const CellRecord& run) {
      return holds(run, static_cast<std::int32_t>(winner), all.distinct.count());
    })) << q.transpose();
  }
  EXPECT_LT(lists, vectors / 2);
}

TEST(CellTable, ContainsEveryWinner) {
  std::uint64_t seed = 1;
  for (const auto& [code, samples] : {std::pair{"hamiltonian-k4", 240},
                                      {"hamiltonian-k5", 240},
                                      {"gray-k4", 240},
                                      {"multifrequency-k5", 300},
                                      {"hamiltonian-k4", 1020},
                                      {"hamiltonian-k5", 1020}})
    expect_winners_in_their_cells(Cells(directions_of(code, 240, samples)), seed++);
}

TEST(CellTable, SupportsRanksThreeAndFourOnly) {
  for (const auto& [code, serves] : {std::pair{"hamiltonian-k3", false},
                                     {"hamiltonian-k4", true},
                                     {"hamiltonian-k5", true},
                                     {"hamiltonian-k6", false}})
    EXPECT_EQ(CellTable::serves(DistinctDirections(directions_of(code, 240, 240))), serves) << code;
}

TEST(CellTable, StaysSmallOnFineGrids) {
#ifdef NDEBUG
  const Cells all(directions_of("hamiltonian-k5", 240, 9960));
  EXPECT_EQ(all.cells.rank(), 4);
  EXPECT_LE(all.cells.bytes(), std::size_t{16} << 20);
  expect_winners_in_their_cells(all, 77);
#else
  GTEST_SKIP() << "takes too long without optimization";
#endif
}

}  // namespace
}  // namespace tofsmith
