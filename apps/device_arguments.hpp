// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <optional>
#include <string>

#include "tofsmith/gpu.hpp"
#include "tofsmith/io/decode_recording.hpp"

namespace tofsmith::apps {

/// A device that decodes recordings, and adds their frames up and filters them before.
class RecordingDevice {
 public:
  /// @param decoder  of the request's recording; outlives this
  /// @param name     of the device, for its filter
  RecordingDevice(DeviceDecoder on_device, const Decoder& decoder, std::string name);

  /// Has it do the work of a request, while this lives and stays where it is.
  void take(DecodeRequest& request);
  const DeviceInfo& info() const { return on_device_.device().info(); }

 private:
  DeviceDecoder on_device_;
  const Decoder& decoder_;
  std::string name_;
  std::unique_ptr<const Filter> filter_;
  std::optional<DeviceFilter> filter_on_device_;
  std::unique_ptr<const TimeFilter> time_filter_;
  std::optional<DeviceFrames> frames_;  // where frames are added up on the device
};

/// What computes: `--device`. Nothing of OpenCL is loaded unless another one than cpu is named.
class DeviceArguments {
 public:
  void add_to(CLI::App& command);
  /// What decodes in place of `decoder`, which must outlive it; none: it does so itself.
  /// @throws UsageError if a device is named and no device decodes by this method; IoError if there
  ///         is no such device, or it fails
  std::optional<RecordingDevice> device_for(const AnyDecoder& decoder) const;

 private:
  std::string name_ = "cpu";
};

}  // namespace tofsmith::apps
