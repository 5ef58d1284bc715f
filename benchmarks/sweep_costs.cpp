// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// What rank 0 of a sweep spends on an item and on a transaction: the costs that
// scheduler_simulation.py reckons with.
//
//   benchmark_sweep_costs DIRECTORY [ITEMS]
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>

#include "core/shared/hash.hpp"
#include "sweep/rank_messages.hpp"

namespace {

using namespace tofsmith;
using Clock = std::chrono::steady_clock;

/// Time of `work` for each of `count` [us].
template <typename Work>
double each_us(std::size_t count, const Work& work) {
  const auto begin = Clock::now();
  work();
  return std::chrono::duration<double, std::micro>(Clock::now() - begin).count() /
         static_cast<double>(count);
}

std::vector<ItemOutcome> outcomes_for(std::span<const std::string> keys) {
  const std::string result(900, 'x');  // about what one operating point takes
  std::vector<ItemOutcome> outcomes;
  for (const std::string& key : keys) outcomes.push_back({key, result, "", 0.1});
  return outcomes;
}

/// Claims and finishes all keys, so many a transaction. @return both, for each item [us]
std::pair<double, double> claim_and_finish(SweepStore& store, std::span<const std::string> keys,
                                           std::size_t at_once) {
  double claim_us = 0.0, finish_us = 0.0;
  for (std::size_t begin = 0; begin < keys.size(); begin += at_once) {
    const auto part = keys.subspan(begin, std::min(at_once, keys.size() - begin));
    const std::vector<ItemOutcome> outcomes = outcomes_for(part);
    claim_us += each_us(1, [&] { store.claim(part, part.size()); });
    finish_us += each_us(1, [&] { store.finish(outcomes); });
  }
  const auto count = static_cast<double>(keys.size());
  return {claim_us / count, finish_us / count};
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) return 2;
  const std::filesystem::path path = std::filesystem::path(argv[1]) / "sweep_costs.sqlite";
  const std::size_t count = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 20000;
  std::vector<std::string> keys;
  for (std::size_t i = 0; i < count; ++i) keys.push_back(fnv1a_128_hex(fmt::format("item {}", i)));
  SweepStore store = SweepStore::open(path);
  const std::string settings = R"({"code":"hamiltonian-k4","signal_e_per_s":1000.0,"seed":1})";
  fmt::print("add        {:8.2f} us an item\n",
             each_us(count, [&] { store.add(keys, [&](std::size_t) { return settings; }); }));
  const std::span<const std::string> all(keys);
  const auto [claim_one, finish_one] = claim_and_finish(store, all.subspan(0, count / 20), 1);
  const auto [claim_many, finish_many] = claim_and_finish(store, all.subspan(count / 2), 256);
  fmt::print("claim      {:8.2f} us an item, {:.2f} us alone in its transaction\n", claim_many,
             claim_one);
  fmt::print("finish     {:8.2f} us an item, {:.2f} us alone in its transaction\n", finish_many,
             finish_one);
  const std::vector<ItemOutcome> outcomes = outcomes_for(all.subspan(0, 10));
  std::size_t bytes = 0;
  fmt::print("message    {:8.2f} us packed and unpacked, of 10 results\n", each_us(1000, [&] {
               for (int i = 0; i < 1000; ++i) bytes += outcomes_of(bytes_of(outcomes)).size();
             }));
  std::filesystem::remove(path);
  return bytes > 0 ? 0 : 1;
}
