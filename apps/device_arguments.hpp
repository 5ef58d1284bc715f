// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <string>

#include "tofsmith/gpu.hpp"

namespace tofsmith::apps {

/// Option `--device`. OpenCL is loaded only if a device other than cpu is named.
class DeviceArguments {
 public:
  void add_to(CLI::App& command);
  /// Returns the backend of the selected device.
  /// @throws UsageError if devices do not support the decoding method; IoError if the device does
  ///   not exist or fails
  std::unique_ptr<FrameBackend> backend(std::unique_ptr<const DepthDecoder> decoder) const;

 private:
  std::string name_ = "cpu";
};

}  // namespace tofsmith::apps
