// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "tofsmith/gpu.hpp"

namespace tofsmith::python {

/// A filter, with the device that does its work, if there is one.
class BoundFilter {
 public:
  /// @param device  "cpu", "auto" or a name, as device_filter() takes it
  BoundFilter(Filter filter, const std::string& device)
      : filter_(std::make_unique<const Filter>(std::move(filter))),
        on_device_(device_filter(device, *filter_)) {}

  const Filter& filter() const { return *filter_; }
  void apply(const RawView& raw, FilteredFrame& filtered, const Progress& progress = {},
             const Image<std::uint8_t>& left_out = {}) const {
    if (on_device_)
      on_device_->apply(raw, filtered, progress, left_out);
    else
      filter_->apply(raw, filtered, progress, left_out);
  }
  std::string device() const { return on_device_ ? on_device_->device().info().name : "cpu"; }

 private:
  std::unique_ptr<const Filter> filter_;  // stays where the device's looks for it
  std::optional<DeviceFilter> on_device_;
};

}  // namespace tofsmith::python
