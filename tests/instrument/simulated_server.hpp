// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <functional>
#include <mutex>
#include <thread>

#include "simulated_generator.hpp"

namespace tofsmith {

/// A simulated generator at a port of the loopback, in a thread of its own. One connection at a
/// time, as many instruments have it.
class SimulatedServer {
 public:
  explicit SimulatedServer(SimulatedGenerator generator, std::function<void()> on_end = {});
  ~SimulatedServer();
  SimulatedServer(const SimulatedServer&) = delete;
  SimulatedServer& operator=(const SimulatedServer&) = delete;

  int port() const { return port_; }
  /// Looks at the generator, or changes it, while nothing else does.
  template <typename Function>
  auto with_generator(Function function) {
    const std::lock_guard lock(mutex_);
    return function(generator_);
  }
  /// Answers go out byte by byte.
  void split_answers() { splits_ = true; }

 private:
  void serve();
  void talk(int connection);

  SimulatedGenerator generator_;
  std::function<void()> on_end_;
  std::mutex mutex_;
  int listener_ = -1, port_ = 0;
  std::atomic<bool> stops_{false}, splits_{false};
  std::thread thread_;
};

}  // namespace tofsmith
