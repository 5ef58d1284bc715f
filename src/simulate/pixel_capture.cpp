// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "simulate/pixel_capture.hpp"

#include <cmath>

#include "tofsmith/core/units.hpp"

namespace tofsmith {

PixelCapture::PixelCapture(const ForwardModel& model, const Camera& camera)
    : range_m_(camera.range_m()),
      bin_m_(camera.bin_m()),
      dark_e_per_s_(camera.sensor.dark_current_e_per_s),
      correlation_(model),
      noise_(camera.sensor),
      exposure_s_(model.tap_exposure_s()),
      ambient_gain_(model.tap_ambient_gain()) {}

void PixelCapture::operator()(double depth_m, double signal_e_per_s, double ambient_e_per_s,
                              RandomStream& random, std::vector<double>& work, float* raw) const {
  const double position_bin = std::isnan(depth_m) ? 0.0 : wrap(depth_m, range_m_) / bin_m_;
  correlation_.at(position_bin, work.data());
  for (std::size_t j = 0; j < work.size(); ++j) {
    const auto i = static_cast<Eigen::Index>(j);
    const double expected_e = exposure_s_[i] * (signal_e_per_s * work[j] +
                                                ambient_e_per_s * ambient_gain_[i] + dark_e_per_s_);
    work[j] = noise_.convert(noise_.draw_electrons(expected_e, random));
  }
  noise_.read_out(work.data(), tap_values());
  for (int i = 0; i < measurements(); ++i)
    raw[i] = static_cast<float>(work[static_cast<std::size_t>(i)]);
}

}  // namespace tofsmith
