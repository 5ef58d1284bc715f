// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "sweep/item_batch.hpp"

#include <fmt/format.h>

#include <chrono>
#include <stdexcept>
#include <utility>

#include "sweep/item_result.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/core/parallel.hpp"

namespace tofsmith {

namespace {

std::string computed(const WorkItem& item, const Progress& progress) {
  if (!item.design)
    return item_result_json(evaluate(*item.code, item.camera, item.options, progress));
  // Standard codes with three or more taps compete with other numbers of exposures.
  const DesignResult result = design(item.camera, *item.design, progress);
  const int exposures = item.design->exposures.front();
  for (const Candidate* c : by_geometric_mean_error(result, item.camera.operating.measure()))
    if (c->code.exposures() == exposures) return item_result_json(c->error, &c->code);
  throw std::runtime_error(fmt::format("no code of {} exposures was found", exposures));
}

ItemOutcome outcome_of(const WorkList& list, const ClaimedItem& claimed, const Progress& progress) {
  ItemOutcome outcome{.key = claimed.key};
  const auto begin = std::chrono::steady_clock::now();
  try {
    const WorkItem item = list.item(claimed.item);
    if (item.key != claimed.key)
      throw IoError(list.spec().source_name,
                    "a file that the sweep reads has changed since it started");
    outcome.result = computed(item, progress);
  } catch (const Interrupted&) {
    throw;
  } catch (const std::exception& error) {
    outcome.message = error.what();
  }
  outcome.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return outcome;
}

}  // namespace

std::vector<ItemOutcome> compute_items(const WorkList& list, std::span<const ClaimedItem> items) {
  std::vector<ItemOutcome> outcomes(items.size());
  parallel_for(static_cast<std::int64_t>(items.size()), [&](std::int64_t i) {
    const auto at = static_cast<std::size_t>(i);
    outcomes[at] = outcome_of(list, items[at], {});
  });
  return outcomes;
}

ItemBatch::ItemBatch(const WorkList& list, std::vector<ClaimedItem> items)
    : list_(list), items_(std::move(items)), thread_([this] { compute_all(); }) {}

ItemBatch::~ItemBatch() {
  stop_ = true;
  thread_.join();
}

std::vector<ItemOutcome> ItemBatch::wait(std::chrono::milliseconds max_wait) {
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, max_wait, [this] { return !outcomes_.empty() || done_; });
  return std::exchange(outcomes_, {});
}

std::vector<ItemOutcome> ItemBatch::stop() {
  stop_ = true;
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return done_.load(); });
  return std::exchange(outcomes_, {});
}

void ItemBatch::compute_all() {
  parallel_for(static_cast<std::int64_t>(items_.size()),
               [&](std::int64_t i) { compute(items_[static_cast<std::size_t>(i)]); });
  const std::lock_guard lock(mutex_);
  done_ = true;
  changed_.notify_all();
}

void ItemBatch::compute(const ClaimedItem& claimed) {
  if (stop_) return;
  const bool is_alone = items_.size() == 1;
  const auto progress = [&](double fraction, std::string_view) {
    if (is_alone) fraction_ = fraction;
    return !stop_;
  };
  try {
    ItemOutcome outcome = outcome_of(list_, claimed, progress);
    const std::lock_guard lock(mutex_);
    outcomes_.push_back(std::move(outcome));
    changed_.notify_all();
  } catch (const Interrupted&) {  // from stop()
  }
}

}  // namespace tofsmith
