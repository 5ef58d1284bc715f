// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/sweep/run_sweep.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <thread>

#include "sweep_setup.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {
namespace {

using testing::HasSubstr;

TEST(RunSweep, EqualsEvaluate) {
  const TemporaryDirectory directory;
  const WorkList list = small_list();
  swept(directory / "s.sqlite", list);
  SweepStore store = SweepStore::read(directory / "s.sqlite");
  const auto results = sweep_results(list, list.keys(), store);
  ASSERT_EQ(results.size(), 12u);
  const WorkItem item = list.item(7);
  const DepthErrorReport expected = evaluate(*item.code, item.camera, item.options);
  EXPECT_EQ(results[7].item, 7);
  EXPECT_EQ(results[7].error.code, "hamiltonian-k3");
  ASSERT_EQ(results[7].error.points.size(), 1u);
  const PointDepthError &found = results[7].error.points[0], &is = expected.points[0];
  EXPECT_EQ(found.point, is.point);
  EXPECT_EQ(found.linear_mde_m.value, is.linear_mde_m.value);
  EXPECT_EQ(found.circular_mde_m.standard_error, is.circular_mde_m.standard_error);
  EXPECT_EQ(found.linear_rmse_m.value, is.linear_rmse_m.value);
  EXPECT_EQ(found.circular_rmse_m.standard_error, is.circular_rmse_m.standard_error);
  EXPECT_EQ(found.cramer_rao_mae_m, is.cramer_rao_mae_m);
}

TEST(RunSweep, StoresDesignedCodes) {
  const TemporaryDirectory directory;
  const WorkList list(parse_sweep_toml(
      "set = [\"samples=24\"]\ncode = \"optimized-k{exposures}\"\neffort = 0.01\ntrials = 1000\n"
      "outlier_threshold_m = 0.01\n[[axis]]\nkey = \"exposures\"\nvalues = [3, 4]\n"
      "[[axis]]\nkey = \"signal_e_per_s\"\nvalues = [1e5]\n"
      "[[axis]]\nkey = \"ambient_e_per_s\"\nvalues = [1e4]\n"));
  const std::string text = swept(directory / "s.sqlite", list);
  EXPECT_THAT(text, HasSubstr("\"designed\""));
  SweepStore store = SweepStore::read(directory / "s.sqlite");
  const auto results = sweep_results(list, list.keys(), store);
  ASSERT_EQ(results.size(), 2u);
  for (const SweepResult& result : results) {
    const WorkItem item = list.item(result.item);
    ASSERT_TRUE(result.code);
    EXPECT_EQ(result.code->exposures(), result.item == 0 ? 3 : 4);
    EXPECT_EQ(result.error.code, result.code->name());
    const DepthErrorReport again = evaluate(*result.code, item.camera, item.options);
    EXPECT_EQ(again.linear.geometric_mean_m.value, result.error.linear.geometric_mean_m.value);
    EXPECT_EQ(result.error.outlier_threshold_m, 0.01);
    EXPECT_EQ(again.points[0].outlier_rate.value, result.error.points[0].outlier_rate.value);
    EXPECT_GT(result.error.points[0].outlier_rate.value, 0.1) << "most err by more than 1 cm";
  }
  std::int64_t computed = 0;
  EXPECT_EQ(swept(directory / "s.sqlite", list, &computed), text);
  EXPECT_EQ(computed, 0);
}

TEST(RunSweep, NeverRecomputesAFinishedItem) {
  const TemporaryDirectory directory;
  const auto path = directory / "s.sqlite";
  std::int64_t computed = 0;
  const std::string few = swept(path, small_list(), &computed);
  EXPECT_EQ(computed, 12);
  EXPECT_EQ(swept(path, small_list(), &computed), few);
  EXPECT_EQ(computed, 0);
  const std::string more = swept(path, small_list("10, 12, 15"), &computed);
  EXPECT_EQ(computed, 6);
  EXPECT_EQ(swept(directory / "new.sqlite", small_list("10, 12, 15")), more);
  EXPECT_EQ(swept(path, small_list(), &computed), few);
  EXPECT_EQ(computed, 0);
}

TEST(RunSweep, ComputesEqualItemsOnce) {
  const TemporaryDirectory directory;
  std::int64_t computed = 0;
  swept(directory / "s.sqlite", small_list("12, 12.0, 15"), &computed);
  EXPECT_EQ(computed, 12);
}

TEST(RunSweep, TwoProcessesShareTheWorkWithEqualResults) {
  const TemporaryDirectory directory;
  const WorkList list = small_list("10, 11, 12, 13, 14, 15");
  std::int64_t first = 0, second = 0;
  const auto run = [&](std::int64_t* computed) {
    swept(directory / "s.sqlite", list, computed, {.batch_s = 1e-3});
  };
  std::thread other([&] { run(&first); });
  run(&second);
  other.join();
  // Items in progress at the end may be computed by both.
  EXPECT_GE(first + second, 36);
  EXPECT_LT(first + second, 2 * 36);
  const std::string both = swept(directory / "s.sqlite", list, &first);
  EXPECT_EQ(first, 0);
  EXPECT_EQ(swept(directory / "alone.sqlite", list), both);
}

TEST(SweepQueue, ReclaimsItemsOfAnotherProcessLast) {
  const TemporaryDirectory directory;
  const WorkList list = small_list();
  const std::vector<std::string> keys = list.keys();
  SweepStore store = SweepStore::open(directory / "s.sqlite");
  SweepStore other = SweepStore::open(directory / "s.sqlite");
  std::vector<std::string> claimed;
  {
    SweepQueue queue(list, keys, store);
    other.claim(keys, 3);
    while (queue.left() > 0)
      for (const ClaimedItem& item : queue.claim(2)) claimed.push_back(item.key);
    EXPECT_EQ(queue.claim(2).size(), 0u);
    EXPECT_EQ(store.count(keys).running, 12);
  }
  EXPECT_THAT(std::vector<std::string>(claimed.end() - 3, claimed.end()),
              testing::ElementsAreArray(keys.begin(), keys.begin() + 3));
  EXPECT_THAT(claimed, testing::UnorderedElementsAreArray(keys));
  EXPECT_EQ(store.count(keys).pending, 12) << "the destructor gives back unfinished items";
}

TEST(ComputeItems, EqualsTheResultsOfRunSweepAlthoughSomeItemsFail) {
  const TemporaryDirectory directory;
  const WorkList list = small_list("15", "method = \"unwrap\"\n");  // unwrap: sinusoids only
  const std::vector<std::string> keys = list.keys();
  SweepStore store = SweepStore::open(directory / "s.sqlite");
  const SweepRun run = run_sweep(list, keys, store);
  EXPECT_EQ(run.computed, 3);
  ASSERT_EQ(run.failures.size(), 3u);
  EXPECT_EQ(store.count(keys).failed, 3);
  EXPECT_EQ(store.find(keys.back())->message, run.failures.back());
  std::vector<ClaimedItem> items;
  for (std::size_t i = 0; i < keys.size(); ++i)
    items.push_back({static_cast<std::int64_t>(i), keys[i]});
  items.push_back({0, "another key"});
  const std::vector<ItemOutcome> outcomes = compute_items(list, items);
  ASSERT_EQ(outcomes.size(), keys.size() + 1);
  for (std::size_t i = 0; i < keys.size(); ++i) {
    EXPECT_EQ(outcomes[i].key, keys[i]);
    EXPECT_EQ(outcomes[i].result, store.find(keys[i])->result);
    EXPECT_EQ(outcomes[i].message, store.find(keys[i])->message);
  }
  EXPECT_THAT(outcomes.back().message, HasSubstr("has changed since it started"));
  EXPECT_EQ(run_sweep(list, keys, store).failures.size(), 3u);  // failed items are retried
}

TEST(RunSweep, AnInterruptedRunKeepsFinishedItems) {
  const TemporaryDirectory directory;
  const auto path = directory / "s.sqlite";
  const WorkList list = small_list("10, 11, 12, 13, 14, 15");
  const std::vector<std::string> keys = list.keys();
  {
    SweepStore store = SweepStore::open(path);
    const Progress stop_soon = [](double fraction, std::string_view) { return fraction < 0.2; };
    EXPECT_THROW(run_sweep(list, keys, store, {.batch_s = 1e-3}, stop_soon), Interrupted);
  }
  const SweepCounts counts = SweepStore::read(path).count(keys);
  EXPECT_EQ(counts.running, 0);
  EXPECT_GE(counts.finished, 36 / 5);
  std::int64_t computed = 0;
  const std::string resumed = swept(path, list, &computed);
  EXPECT_EQ(computed, 36 - counts.finished);
  EXPECT_EQ(swept(directory / "new.sqlite", list), resumed);
}

TEST(RunSweep, ShardsMergeToTheWhole) {
  const TemporaryDirectory directory;
  const WorkList list = small_list();
  std::vector<std::filesystem::path> parts;
  std::int64_t sum = 0;
  for (int i = 1; i <= 3; ++i) {
    parts.push_back(directory / std::to_string(i));
    std::int64_t computed = 0;
    swept(parts.back(), list, &computed, {.shard = {i, 3}});
    sum += computed;
  }
  EXPECT_EQ(sum, 12);
  SweepStore::merge(directory / "all.sqlite", parts);
  std::int64_t computed = -1;
  const std::string merged = swept(directory / "all.sqlite", list, &computed);
  EXPECT_EQ(computed, 0);
  EXPECT_EQ(swept(directory / "new.sqlite", list), merged);
}

TEST(SweepResults, AreEqualInEveryFormat) {
  const TemporaryDirectory directory;
  const WorkList list = small_list();
  swept(directory / "s.sqlite", list);
  SweepStore store = SweepStore::read(directory / "s.sqlite");
  const auto results = sweep_results(list, list.keys(), store);
  const std::string csv = sweep_csv(list, results);
  EXPECT_THAT(csv, testing::StartsWith("item,code,light.peak_factor,signal_e_per_s,"));
  EXPECT_THAT(csv, HasSubstr("\n8,hamiltonian-k3,12,10000,10000,"));
  EXPECT_EQ(std::ranges::count(csv, '\n'), 13);
  const NpzArrays arrays = sweep_arrays(list, results);
  EXPECT_EQ(arrays.at("linear_mde_m").size(), 12u);
  EXPECT_EQ(arrays.at("linear_mde_m").as<double>()[7],
            results[7].error.points[0].linear_mde_m.value);
  EXPECT_EQ(arrays.at("light.peak_factor").as<double>()[11], 15.0);
  EXPECT_EQ(arrays.at("code_index").as<std::int64_t>()[7], 1);
  EXPECT_EQ(arrays.at("code_names").shape(), (NpyShape{2, 14}));
}

TEST(RunSweep, RejectsInvalidOptions) {
  const TemporaryDirectory directory;
  const WorkList list = small_list();
  const std::vector<std::string> keys = list.keys();
  SweepStore store = SweepStore::open(directory / "s.sqlite");
  EXPECT_THROW(run_sweep(list, keys, store, {.shard = {4, 3}}), std::invalid_argument);
  EXPECT_THROW(run_sweep(list, keys, store, {.batch_s = 0.0}), std::invalid_argument);
}

TEST(SweepShard, EveryKeyIsInOneShard) {
  for (const char* key : {"00", "ab5a10d454601b56970c164d404ab0a3", "ffffffffffffffff"}) {
    int shards = 0;
    for (int i = 1; i <= 7; ++i) shards += SweepShard{i, 7}.holds(key) ? 1 : 0;
    EXPECT_EQ(shards, 1) << key;
  }
  EXPECT_FALSE((SweepShard{0, 3}.is_valid()));
  EXPECT_FALSE((SweepShard{4, 3}.is_valid()));
}

}  // namespace
}  // namespace tofsmith
