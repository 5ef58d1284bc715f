// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>

#include <memory>
#include <string>
#include <utility>

#include "tofsmith/decode/filter.hpp"
#include "tofsmith/gpu.hpp"

namespace tofsmith::python {

namespace py = pybind11;

/// Returns the options of the strength in entry "strength", overridden by the other entries.
/// @throws std::invalid_argument for unknown names and violated rules
FilterOptions filter_options(const py::dict& values);
/// Returns the options of a temporal filter, which has no strength.
TimeFilterOptions time_filter_options(const py::dict& values);

/// A spatial filter and its backend.
class BoundFilter {
 public:
  /// @param device  as in frame_backend()
  BoundFilter(Filter filter, const std::string& device)
      : filter_(std::make_unique<const Filter>(std::move(filter))),
        backend_(frame_backend(device, make_decoder(DecodeMethod::zncc, filter_->table()))) {}

  const Filter& filter() const { return *filter_; }
  /// Prepares to filter frames of this size, without other steps.
  std::unique_ptr<FramePipeline> pipeline(int height, int width) const {
    return backend_->prepare({.filter = filter_.get(), .keeps_filtered = true}, height, width);
  }
  std::string device() const { return backend_->device(); }

 private:
  std::unique_ptr<const Filter> filter_;  // pipelines point to it
  std::unique_ptr<FrameBackend> backend_;
};

}  // namespace tofsmith::python
