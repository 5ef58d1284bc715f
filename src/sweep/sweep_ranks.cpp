// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/sweep/run_sweep.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <thread>

#include "sweep/item_queue.hpp"
#include "sweep/rank_state.hpp"
#include "tofsmith/core/build_info.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/version.hpp"

namespace tofsmith {

namespace {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::milliseconds moment(1);
/// After so long, a rank that was sent home and says nothing is lost.
constexpr std::chrono::seconds max_goodbye(5);
/// Results are sent together if they come so soon after one another: rank 0 serves many.
constexpr std::chrono::milliseconds gathering(100);

RankHello own_hello() {
  std::array<char, 256> host{};
  if (::gethostname(host.data(), host.size() - 1) != 0) host[0] = '\0';
  return {host.data(), fmt::format("{} (results {})", TOFSMITH_VERSION, sweep_result_version),
          dispatch_target()};
}

void wait_for_hellos(SweepRanks::State& state, const Progress& progress) {
  for (int missing = state.world->size() - 1; missing > 0;) {
    report(progress, 0.0, fmt::format("waiting for {} ranks", missing));
    std::optional<RankMessage> message = state.world->receive();
    if (!message) {
      std::this_thread::sleep_for(moment);
    } else if (message->tag == static_cast<int>(RankTag::hello)) {
      state.hellos[static_cast<std::size_t>(message->rank)] = hello_of(message->bytes);
      --missing;
    } else {  // it was interrupted already
      throw Interrupted();
    }
  }
}

/// All must give the same bits.
void require_alike(const SweepRanks::State& state) {
  const RankHello& first = state.hellos.front();
  for (int rank = 1; rank < state.world->size(); ++rank) {
    const RankHello& other = state.hellos[static_cast<std::size_t>(rank)];
    if (other.version != first.version)
      throw std::runtime_error(
          fmt::format("{} is tofsmith {}, and {} is tofsmith {}; expected the "
                      "same everywhere",
                      state.name_of(rank), other.version, state.name_of(0), first.version));
    if (other.target != first.target)
      throw std::runtime_error(fmt::format(
          "{} uses {}, and {} uses {}: results would differ in their last digits; set "
          "TOFSMITH_TARGET to one that all machines have (mpirun -x "
          "TOFSMITH_TARGET={})",
          state.name_of(rank), other.target, state.name_of(0), first.target, other.target));
  }
}

/// A rank that is not the first.
class Worker {
 public:
  Worker(SweepRanks::State& state, const std::function<WorkList()>& read, const Progress& progress)
      : state_(state), read_(read), progress_(progress) {}

  void run() {
    bool is_able = true;
    while (!is_sent_home_) {
      try {
        take_messages();
        is_able ? work() : std::this_thread::sleep_for(moment);
      } catch (const std::exception& error) {
        if (is_able) state_.send(0, RankTag::trouble, error.what());
        is_able = false;
      }
      if (!was_interrupted_ && progress_ && !progress_(0.0, "")) {
        was_interrupted_ = true;
        state_.send(0, RankTag::interrupted);
      }
    }
    keep(queue_ ? queue_->stop() : std::vector<ItemOutcome>());
    send_outcomes();
    state_.send(0, RankTag::goodbye);
    while (!state_.world->all_sent()) std::this_thread::sleep_for(moment);
  }

 private:
  void take_messages() {
    while (std::optional<RankMessage> message = state_.world->receive()) {
      if (message->tag == static_cast<int>(RankTag::go_home)) is_sent_home_ = true;
      if (message->tag != static_cast<int>(RankTag::items)) continue;
      if (!list_) queue_.emplace(list_.emplace(read_()));
      queue_->give(items_of(message->bytes));
    }
  }

  void work() {
    if (!queue_) return std::this_thread::sleep_for(moment);
    keep(queue_->wait(moment));
    if (queue_->is_empty() || Clock::now() - sent_at_ > gathering) send_outcomes();
  }

  void keep(std::vector<ItemOutcome> outcomes) {
    for (ItemOutcome& outcome : outcomes) outcomes_.push_back(std::move(outcome));
  }

  void send_outcomes() {
    if (outcomes_.empty()) return;
    state_.send(0, RankTag::outcomes, bytes_of(outcomes_));
    outcomes_.clear();
    sent_at_ = Clock::now();
  }

  SweepRanks::State& state_;
  const std::function<WorkList()>& read_;
  const Progress& progress_;
  std::optional<WorkList> list_;
  std::optional<ItemQueue> queue_;
  std::vector<ItemOutcome> outcomes_;
  Clock::time_point sent_at_ = Clock::now();
  bool is_sent_home_ = false, was_interrupted_ = false;
};

}  // namespace

std::string SweepRanks::State::name_of(int rank) const {
  return fmt::format("rank {} on {}", rank, hellos[static_cast<std::size_t>(rank)].host);
}

std::vector<ItemOutcome> SweepRanks::State::send_home() {
  std::vector<ItemOutcome> outcomes;
  if (are_home || !world) return outcomes;
  are_home = true;
  for (int rank = 1; rank < world->size(); ++rank) send(rank, RankTag::go_home);
  int away = world->size() - 1;
  const Clock::time_point begin = Clock::now();
  while ((away > 0 || !world->all_sent()) && Clock::now() - begin < max_goodbye) {
    const std::optional<RankMessage> message = world->receive();
    if (!message) std::this_thread::sleep_for(moment);
    if (!message) continue;
    if (message->tag == static_cast<int>(RankTag::goodbye)) --away;
    if (message->tag != static_cast<int>(RankTag::outcomes)) continue;
    for (ItemOutcome& outcome : outcomes_of(message->bytes)) outcomes.push_back(std::move(outcome));
  }
  is_lost = away > 0;
  return outcomes;
}

SweepRanks::SweepRanks(std::unique_ptr<State> state) : state_(std::move(state)) {}
SweepRanks::SweepRanks(SweepRanks&&) noexcept = default;
SweepRanks::~SweepRanks() {
  if (!state_ || !state_->world || state_->world->rank() != 0) return;
  try {
    state_->send_home();
  } catch (const std::exception&) {  // what came was no message of ours
    state_->is_lost = true;
  }
  if (state_->is_lost) state_->world->end_all(1);  // who is lost would be waited for
}

SweepRanks SweepRanks::join(const Progress& progress) {
  SweepRanks ranks(std::make_unique<State>());
  if (launched_processes() == 1) return ranks;
  State& state = ranks.state();
  state.world.emplace();
  const RankHello hello = own_hello();
  if (ranks.rank() > 0) {
    state.send(0, RankTag::hello, bytes_of(hello));
    return ranks;
  }
  state.hellos.assign(static_cast<std::size_t>(ranks.count()), hello);
  wait_for_hellos(state, progress);
  require_alike(state);
  return ranks;
}

int SweepRanks::rank() const { return state_->world ? state_->world->rank() : 0; }
int SweepRanks::count() const { return state_->world ? state_->world->size() : 1; }

void work_for_sweep(SweepRanks& ranks, const std::function<WorkList()>& list,
                    const Progress& progress) {
  require(ranks.rank() > 0, "rank", ranks.rank(), "must be > 0: rank 0 runs the sweep");
  Worker(ranks.state(), list, progress).run();
}

}  // namespace tofsmith
