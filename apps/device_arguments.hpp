// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <string>

#include "tofsmith/gpu.hpp"

namespace tofsmith::apps {

/// What computes: `--device`. Nothing of OpenCL is loaded unless another one than cpu is named.
class DeviceArguments {
 public:
  void add_to(CLI::App& command);
  /// Returns the backend of the device that was named.
  /// @throws UsageError if a device is named and no device decodes by this method; IoError if there
  ///         is no such device, or it fails
  std::unique_ptr<FrameBackend> backend(std::unique_ptr<const DepthDecoder> decoder) const;

 private:
  std::string name_ = "cpu";
};

}  // namespace tofsmith::apps
