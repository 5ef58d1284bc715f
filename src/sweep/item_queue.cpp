// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "sweep/item_queue.hpp"

#include <iterator>
#include <thread>
#include <utility>

namespace tofsmith {

void ItemQueue::give(std::vector<ClaimedItem> items) {
  waiting_.insert(waiting_.end(), std::make_move_iterator(items.begin()),
                  std::make_move_iterator(items.end()));
  if (!batch_) start_next();
}

std::vector<ItemOutcome> ItemQueue::wait(std::chrono::milliseconds max_wait) {
  if (!batch_) {
    std::this_thread::sleep_for(max_wait);
    return {};
  }
  const bool is_done = batch_->is_done();  // asked first: what comes out later is not missed
  std::vector<ItemOutcome> outcomes = batch_->wait(max_wait);
  if (is_done) {
    batch_.reset();
    start_next();
  }
  return outcomes;
}

std::vector<ItemOutcome> ItemQueue::stop() {
  waiting_.clear();
  if (!batch_) return {};
  batch_->stop();
  batch_->wait_until_done();
  std::vector<ItemOutcome> outcomes = batch_->wait(std::chrono::milliseconds(0));
  batch_.reset();
  return outcomes;
}

void ItemQueue::start_next() {
  if (!waiting_.empty()) batch_.emplace(list_, std::exchange(waiting_, {}));
}

}  // namespace tofsmith
