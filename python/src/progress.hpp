// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>

#include <chrono>
#include <exception>
#include <mutex>
#include <optional>
#include <utility>

#include "tofsmith/core/error.hpp"
#include "tofsmith/core/parallel.hpp"
#include "tofsmith/core/progress.hpp"

namespace tofsmith::python {

namespace py = pybind11;

/// Connects the library's progress to Python: runs signal handlers, so that Ctrl-C cancels, and
/// calls `callback(fraction, step)` unless it is None, at most 50 times per second. The work is
/// cancelled if the callback returns False or raises.
class ProgressBridge {
 public:
  explicit ProgressBridge(py::object callback) : callback_(std::move(callback)) {}
  Progress progress() {
    return [this](double fraction, std::string_view step) { return call(fraction, step); };
  }
  /// Rethrows an exception of Python that was raised during the work.
  void rethrow() const {
    if (error_) std::rethrow_exception(error_);
  }

 private:
  bool call(double fraction, std::string_view step);

  py::object callback_;
  std::exception_ptr error_;
  std::chrono::steady_clock::time_point next_;
};

/// Calls work(progress) without the GIL. Exceptions of the callback or of a signal handler
/// propagate.
template <typename Work>
auto without_gil(const py::object& callback, Work&& work) {
  ProgressBridge bridge(callback);
  try {
    const py::gil_scoped_release release;
    return work(bridge.progress());
  } catch (const Interrupted&) {
    bridge.rethrow();
    throw;
  }
}

/// A ThreadLimit shared by calls in several threads: it exists while any of them runs, with the
/// number of threads of the first call.
class SharedThreadLimit {
 public:
  explicit SharedThreadLimit(int threads) {
    const std::lock_guard lock(mutex_);
    if (calls_++ == 0 && threads > 0) limit_.emplace(threads);
  }
  ~SharedThreadLimit() {
    const std::lock_guard lock(mutex_);
    if (--calls_ == 0) limit_.reset();
  }
  SharedThreadLimit(const SharedThreadLimit&) = delete;
  SharedThreadLimit& operator=(const SharedThreadLimit&) = delete;

 private:
  static inline std::mutex mutex_;
  static inline int calls_ = 0;
  static inline std::optional<ThreadLimit> limit_;
};

}  // namespace tofsmith::python
