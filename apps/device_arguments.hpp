// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "tofsmith/gpu.hpp"

namespace tofsmith::apps {

/// What decodes: `--device`. Nothing of OpenCL is loaded unless another one than cpu is named.
class DeviceArguments {
 public:
  void add_to(CLI::App& command);
  /// What decodes in place of `decoder`, which must outlive it; none: it does so itself.
  /// @throws UsageError if a device is named and no device decodes by this method; IoError if there
  ///         is no such device, or it fails
  std::optional<DeviceDecoder> decoder_like(const AnyDecoder& decoder) const;

 private:
  std::string name_ = "cpu";
};

}  // namespace tofsmith::apps
