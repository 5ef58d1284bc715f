// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "options.hpp"
#include "tofsmith/gpu.hpp"
#include "tofsmith/simulate/capture.hpp"

namespace tofsmith::python {

/// A scene from its planes by name, each (H, W) or None.
/// @throws std::invalid_argument naming the plane that does not fit
SceneImage scene_of(const py::dict& planes);

/// What draws the noise of captures: a device, or this computer.
class BoundCapture {
 public:
  /// @throws std::invalid_argument, IoError as device_capture()
  explicit BoundCapture(const std::string& device);

  /// While this lives.
  ExposeBy expose_by() const { return on_device_ ? on_device_->expose_by() : ExposeBy(); }

 private:
  std::optional<DeviceCapture> on_device_;
};

}  // namespace tofsmith::python
