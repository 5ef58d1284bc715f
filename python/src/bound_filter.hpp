// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <utility>

#include "tofsmith/gpu.hpp"

namespace tofsmith::python {

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
