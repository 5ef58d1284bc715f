// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>
#include <vector>

#include "gpu/device_tile.hpp"
#include "gpu/trial_parameters.h"
#include "simulate/shared/depth_trials.hpp"

namespace tofsmith {

/// decode_parameters.h, numbers.cl, capture_parameters.h, random.cl, trial_parameters.h and
/// trials.cl, one behind the other.
extern const std::string_view trial_kernels;

/// Trials of a code on a camera, drawn and decoded on a device.
class TrialDevice {
 public:
  /// @param trials  that are drawn in the plane; must outlive this
  TrialDevice(const Device& device, const DepthTrials& trials, const DeviceOptions& options);

  void run(const TrialRun& run);
  /// Trials that the processor has made so far.
  std::int64_t by_processor() const { return by_processor_; }

 private:
  void run_part(const TrialRun& part);
  void run_here(const TrialRun& part, std::int64_t trial);

  const DepthTrials& trials_;
  TrialParts parts_;
  Decoder decoder_;
  DeviceTile tile_;
  DeviceQueue queue_;
  DeviceKernel draw_;
  std::vector<TrialParameters> of_point_;
  DeviceMemory words_, true_bins_;
  std::int64_t part_trials_;
  std::int64_t by_processor_ = 0;
  TrialTile work_;
  std::vector<float> depth_m_;
  std::vector<std::int32_t> bins_;
};

}  // namespace tofsmith
