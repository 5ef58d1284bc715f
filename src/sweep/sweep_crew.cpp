// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "sweep/sweep_crew.hpp"

#include <fmt/format.h>

#include <iterator>
#include <stdexcept>

#include "sweep/rank_state.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

namespace {

/// Long enough to leave the processor to others, short enough for the user; shorter where other
/// ranks wait for us.
constexpr std::chrono::milliseconds alone_wait(50), served_wait(1);

}  // namespace

SweepCrew::SweepCrew(const WorkList& list, SweepRanks* ranks, bool computes_here)
    : ranks_(ranks),
      computes_here_(computes_here),
      others_(ranks == nullptr ? 0 : static_cast<std::size_t>(ranks->count() - 1)),
      own_(list) {}

void SweepCrew::give(std::size_t member, std::vector<ClaimedItem> items) {
  if (computes_here_ && member == 0) return own_.give(std::move(items));
  const int rank = static_cast<int>(member) + (computes_here_ ? 0 : 1);
  ranks_->state().send(rank, RankTag::items, bytes_of(items));
}

std::vector<SweepCrew::Delivery> SweepCrew::wait() {
  std::vector<Delivery> deliveries;
  auto own = own_.wait(others_ > 0 ? served_wait : alone_wait);
  if (!own.empty()) deliveries.push_back({0, std::move(own)});
  if (others_ == 0) return deliveries;
  SweepRanks::State& state = ranks_->state();
  while (std::optional<RankMessage> message = state.world->receive()) {
    const auto tag = static_cast<RankTag>(message->tag);
    if (tag == RankTag::interrupted) throw Interrupted();
    if (tag == RankTag::trouble)
      throw std::runtime_error(fmt::format("{}: {}", state.name_of(message->rank), message->bytes));
    if (tag == RankTag::outcomes)
      deliveries.push_back({static_cast<std::size_t>(message->rank) - (computes_here_ ? 0 : 1),
                            outcomes_of(message->bytes)});
  }
  return deliveries;
}

std::vector<ItemOutcome> SweepCrew::stop() {
  std::vector<ItemOutcome> outcomes = own_.stop();
  if (others_ == 0) return outcomes;
  std::vector<ItemOutcome> theirs = ranks_->state().send_home();
  outcomes.insert(outcomes.end(), std::make_move_iterator(theirs.begin()),
                  std::make_move_iterator(theirs.end()));
  return outcomes;
}

}  // namespace tofsmith
