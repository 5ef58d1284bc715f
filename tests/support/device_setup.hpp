// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "gpu/device_frames.hpp"
#include "output_setup.hpp"

namespace tofsmith {

inline std::optional<Device> device_of_tests() {
  try {
    const std::vector<Device> devices = Device::all();
    if (!devices.empty()) return devices.front();
  } catch (const IoError&) {
  }
  return std::nullopt;
}

/// Fixture of tests that need a device; skipped without one.
class OnDevice : public testing::Test {
 protected:
  void SetUp() override {
    if (!device_) GTEST_SKIP() << "OpenCL finds no device: install pocl-opencl-icd";
  }
  const Device& device() const { return *device_; }

  const DecodeSetup setup_{"hamiltonian-k4", camera_with("paper-10f0")};
  const DecodingTable& table_ = setup_.decoder.table();

 private:
  std::optional<Device> device_ = device_of_tests();
};

/// Codes and cameras for filters: of one tap, three measurements, counts, and differences.
inline std::vector<std::pair<const char*, Camera>> filtered_codes() {
  Camera counts = camera_with("paper-10f0");
  counts.sensor.adc_bits = 12;
  counts.sensor.gain_e_per_dn = 2.0;
  counts.sensor.black_level_dn = 40.0;
  counts.sensor.dark_current_e_per_s = 1e3;
  return {{"hamiltonian-k4", camera_with("paper-10f0")},
          {"hamiltonian-k3", camera_with("paper-10f0")},
          {"multifrequency-k5", counts},
          {"square-k4", camera_with("paper-10f0", 2, Readout::difference)}};
}

inline DecodingTable clipped_at(DecodingTable table, float level) {
  table.saturation_level = level;
  table.lower_saturation_level = -level;
  return table;
}

/// @param largest  lower limit of the magnitude that the relative tolerance applies to
inline void expect_near(const std::vector<float>& a, const std::vector<float>& b, double largest) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    ASSERT_EQ(std::isnan(a[i]), std::isnan(b[i])) << "pixel " << i;
    if (std::isnan(a[i]) || a[i] == b[i]) continue;  // infinities are equal
    ASSERT_NEAR(a[i], b[i], 2e-6 * std::max<double>(largest, std::abs(b[i]))) << "pixel " << i;
  }
}

/// Expects equal bins and statuses, and float planes within the rounding error of the device.
/// @param brightest_e_per_s  largest light level of a measurement
inline void expect_alike(const DeviceInfo& info, bool uses_doubles, const Outputs& a,
                         const Outputs& b, double brightest_e_per_s) {
  if (info.divides_as_processor && info.has_doubles && uses_doubles) return expect_same(a, b);
  for (const DecodedPlane plane : decoder_planes) {
    const double largest = plane == DecodedPlane::ambient       ? brightest_e_per_s
                           : description_of(plane).unit.empty() ? 1.0
                                                                : 0.0;
    with_plane(
        plane,
        [&]<typename Value>(const Image<Value>& one, const Image<Value>& other) {
          if constexpr (std::is_same_v<Value, float>)
            expect_near(one.pixels, other.pixels, largest);
          else
            EXPECT_EQ(one.pixels, other.pixels);
        },
        a, b);
  }
}

}  // namespace tofsmith
