// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>
#include <vector>

#include "gpu/device_tile.hpp"
#include "gpu/trial_parameters.h"
#include "simulate/shared/depth_trials.hpp"

namespace tofsmith {

/// decode_parameters.h, numbers.cl, random.cl, vector_math.cl, trial_parameters.h, trials.cl and
/// trial_measurements.cl, one behind the other.
extern const std::string_view trial_kernels;

/// Trials of a code on a camera, drawn and decoded on a device.
class TrialDevice {
 public:
  /// @param trials  that ZNCC decodes; must outlive this
  TrialDevice(const Device& device, const DepthTrials& trials, const DeviceOptions& options);

  void run(const TrialRun& run);
  /// Trials that the processor has drawn so far, and others that it has decoded.
  std::int64_t drawn_here() const { return drawn_here_; }
  std::int64_t decoded_here() const { return decoded_here_; }

  double margin = 1.0;  ///< times the bounds on what functions of the device may differ by

 private:
  void run_part(const TrialRun& part);
  void draw_part(const TrialRun& part);
  void run_here(const TrialRun& part, std::int64_t trial);
  void decode_here(const std::vector<std::int32_t>& open, double* decoded_bin);

  const DepthTrials& trials_;
  Decoder decoder_;
  DeviceTile tile_;
  DeviceQueue queue_;
  DeviceKernel draw_;
  std::vector<TrialParameters> of_point_;
  DeviceMemory words_, true_bins_, opened_, open_;
  std::int64_t part_trials_;
  std::int64_t drawn_here_ = 0, decoded_here_ = 0;
  std::vector<std::int32_t> undrawn_;  // of a part, which the device leaves open
  TrialTile work_;
};

}  // namespace tofsmith
