// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "simulate/pixel_capture.hpp"

#include <cmath>

#include "tofsmith/core/units.hpp"

namespace tofsmith {

PixelCapture::PixelCapture(const ForwardModel& model, const Camera& camera)
    : range_m_(camera.range_m()),
      bin_m_(camera.bin_m()),
      dark_e_per_s_(model.tap_dark_e_per_s()),
      is_signed_(camera.sensor.is_signed()),
      correlation_(model),
      noise_(camera.sensor),
      exposure_s_(model.tap_exposure_s()),
      ambient_gain_(model.tap_ambient_gain()) {
  if (model.has_rows()) rows_ = model.readout();
}

void PixelCapture::add_light(const FineCorrelation& correlation, double depth_m,
                             double signal_e_per_s, std::vector<double>& work,
                             std::vector<double>& light) const {
  const double position_bin = std::isnan(depth_m) ? 0.0 : wrap(depth_m, range_m_) / bin_m_;
  correlation.at(position_bin, work.data());
  for (std::size_t j = 0; j < light.size(); ++j) light[j] += signal_e_per_s * work[j];
}

void PixelCapture::expose(double ambient_e_per_s, RandomStream& random, std::vector<double>& light,
                          float* raw) const {
  for (std::size_t j = 0; j < light.size(); ++j) {
    const auto i = static_cast<Eigen::Index>(j);
    const double expected_e =
        exposure_s_[i] * (light[j] + ambient_e_per_s * ambient_gain_[i] + dark_e_per_s_);
    light[j] = rows_        ? noise_.draw_count(expected_e, random)
               : is_signed_ ? expected_e
                            : noise_.convert(noise_.draw_electrons(expected_e, random));
  }
  if (is_signed_)
    for (std::size_t k = 0; k < light.size() / 2; ++k)
      light[k] = noise_.convert(noise_.draw_difference(light[2 * k], light[2 * k + 1], random));
  if (rows_) {
    const Eigen::Map<const Eigen::VectorXd> counts(light.data(), rows_->cols());
    for (int i = 0; i < measurements(); ++i)
      raw[i] =
          static_cast<float>(rows_->row(i).dot(counts) + noise_.read_noise_e() * random.normal());
    return;
  }
  noise_.read_out(light.data(), tap_values());
  for (int i = 0; i < measurements(); ++i)
    raw[i] = static_cast<float>(light[static_cast<std::size_t>(i)]);
}

void PixelCapture::operator()(double depth_m, double signal_e_per_s, double ambient_e_per_s,
                              RandomStream& random, std::vector<double>& work, float* raw) const {
  const double position_bin = std::isnan(depth_m) ? 0.0 : wrap(depth_m, range_m_) / bin_m_;
  correlation_.at(position_bin, work.data());
  for (double& value : work) value *= signal_e_per_s;
  expose(ambient_e_per_s, random, work, raw);
}

}  // namespace tofsmith
