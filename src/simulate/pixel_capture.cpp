// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "simulate/pixel_capture.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "camera/shared/raw_numbers.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/core/units.hpp"

namespace tofsmith {

namespace {

Sensor validated(const Sensor& sensor) {
  Camera camera;
  camera.sensor = sensor;
  camera.sensor.generator.reset();  // no effect on noise
  camera.operating = default_operating_range();
  camera.validate();
  return sensor;
}

}  // namespace

PixelNoise::PixelNoise(const Sensor& sensor)
    : parts_{.model = validated(sensor).noise,
             .subtracts = sensor.subtracts(),
             .is_signed = sensor.is_signed(),
             .read_noise_e = sensor.read_noise_e,
             .full_well_e = sensor.full_well_e.value_or(std::numeric_limits<double>::infinity()),
             .has_adc = sensor.adc_bits.has_value()} {
  if (!parts_.has_adc) return;
  parts_.gain_e_per_dn = *sensor.gain_e_per_dn;
  parts_.black_level_dn = sensor.black_level_dn.value_or(0.0);
  const ConverterNumbers numbers = raw_numbers(sensor);
  parts_.min_dn = numbers.min_dn;
  parts_.max_dn = numbers.max_dn;
}

double PixelNoise::draw_electrons(double expected_e, RandomStream& random) const {
  const double mean = std::max(expected_e, 0.0);
  if (parts_.model == NoiseModel::gaussian)
    return mean + std::sqrt(mean + parts_.read_noise_e * parts_.read_noise_e) * random.normal();
  return random.poisson(mean) + parts_.read_noise_e * random.normal();
}

double PixelNoise::draw_count(double expected_e, RandomStream& random) const {
  const double mean = std::max(expected_e, 0.0);
  if (parts_.model == NoiseModel::gaussian) return mean + std::sqrt(mean) * random.normal();
  return random.poisson(mean);
}

double PixelNoise::draw_difference(double a, double b, RandomStream& random) const {
  const double variance = std::max(a + b, 0.0);
  if (parts_.model == NoiseModel::gaussian)
    return a - b +
           std::sqrt(variance + parts_.read_noise_e * parts_.read_noise_e) * random.normal();
  const SignedElectrons electrons = SignedElectrons::of(a - b, variance);
  const double plus = random.poisson(electrons.plus), minus = random.poisson(electrons.minus);
  return electrons.size * (plus - minus) + parts_.read_noise_e * random.normal();
}

double PixelNoise::convert(double electrons) const {
  double kept = std::min(electrons, parts_.full_well_e);
  if (parts_.is_signed) kept = std::max(kept, -parts_.full_well_e);
  if (!parts_.has_adc) return kept;
  return std::clamp(std::round(kept / parts_.gain_e_per_dn + parts_.black_level_dn), parts_.min_dn,
                    parts_.max_dn);
}

void PixelNoise::read_out(double* raw, int tap_values) const {
  if (!parts_.subtracts || parts_.is_signed) return;
  for (int i = 0; i < tap_values / 2; ++i) raw[i] = raw[2 * i] - raw[2 * i + 1];
}

FineCorrelation::FineCorrelation(const ForwardModel& model)
    : FineCorrelation(model, model.straight_points_per_bin(least_points_per_bin)) {}

FineCorrelation::FineCorrelation(const ForwardModel& model, int points_per_bin)
    : FineCorrelation(
          (require(points_per_bin >= 1, "points_per_bin", points_per_bin, "must be >= 1"),
           model.has_rows()
               ? Eigen::MatrixXd(model.time_bin_table(model.samples() * points_per_bin))
               : model.tap_correlation_table(model.samples() * points_per_bin)),
          points_per_bin) {
  is_time_bin_ = model.has_rows();
  if (is_time_bin_) tap_values_ = model.samples();
}

FineCorrelation::FineCorrelation(const Eigen::MatrixXd& table, int points_per_bin)
    : tap_values_(static_cast<int>(table.cols())),
      points_(static_cast<int>(table.rows())),
      points_per_bin_(points_per_bin) {
  table_.reserve(static_cast<std::size_t>(points_ + 1) * static_cast<std::size_t>(tap_values_));
  for (int row = 0; row <= points_; ++row)
    for (int j = 0; j < tap_values_; ++j) table_.push_back(table(row % points_, j));
}

void FineCorrelation::at(double depth_bin, double* chi) const {
  const double position = depth_bin * points_per_bin_;
  const int cell = std::clamp(static_cast<int>(position), 0, points_ - 1);
  const double share = position - cell;
  if (is_time_bin_) {
    const int step = static_cast<int>(points_per_bin_);
    for (int n = 0, at = cell; n < tap_values_; ++n, at -= step) {
      if (at < 0) at += points_;
      const double* bin = table_.data() + at;
      chi[n] = bin[0] + share * (bin[1] - bin[0]);
    }
    return;
  }
  const double* below = table_.data() + static_cast<std::ptrdiff_t>(cell) * tap_values_;
  const double* above = below + tap_values_;
  for (int j = 0; j < tap_values_; ++j) chi[j] = below[j] + share * (above[j] - below[j]);
}

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

RowCapture::RowCapture(const SceneImage& scene, const ForwardModel& model, const Camera& camera,
                       const CaptureOptions& options)
    : scene_(&scene), bin_m_(camera.bin_m()), options_(options), pixel_(model, camera) {
  scene.validate();
  options.validate();
}

RowCapture::RowCapture(const SceneImage& scene, const SceneLight& light, const ForwardModel& model,
                       const Camera& camera, const CaptureOptions& options)
    : RowCapture(scene, model, camera, options) {
  see(scene, light, model, camera);
}

void RowCapture::see(const SceneImage& scene, const SceneLight& light, const ForwardModel& model,
                     const Camera& camera) {
  scene.validate();
  scene_ = &scene;
  light_ = nullptr;
  tail_.reset();
  transient_.reset();
  if (light.is_direct_only()) return;
  light_ = &light;
  constexpr int points_per_bin = 16;
  const int points = points_per_bin * model.samples();
  if (light.tail)
    tail_.emplace(tap_tail_table(model, *light.tail, camera.range_m(), points), points_per_bin);
  if (light.transients.size() == 1)
    transient_.emplace(
        tap_transient_table(model, light.transients.front(), camera.range_m(), points),
        points_per_bin);
}

void RowCapture::add_all_light(int row, int column, std::vector<double>& work,
                               std::vector<double>& light) const {
  const double depth_m = scene_->depth_m(row, column);
  const double signal_e_per_s = pixel_signal_e_per_s(*scene_, row, column, options_);
  if (std::isnan(depth_m)) return;
  if (transient_) return pixel_.add_light(*transient_, depth_m, signal_e_per_s, work, light);
  if (!light_->transients.empty()) {
    const auto pixel = static_cast<std::size_t>(row) * static_cast<std::size_t>(scene_->width()) +
                       static_cast<std::size_t>(column);
    for (const Return& r :
         light_->transients[pixel].returns(depth_m / bin_m_, signal_e_per_s, bin_m_))
      pixel_.add_light(r.depth_bin * bin_m_, r.signal_e_per_s, work, light);
    return;
  }
  pixel_.add_light(depth_m, signal_e_per_s, work, light);
  if (!light_->returns.empty())
    for (const MultipathReturn& later : light_->returns.of(row, column))
      pixel_.add_light(later.distance_m, signal_e_per_s * later.ratio, work, light);
  if (tail_) pixel_.add_light(*tail_, depth_m, signal_e_per_s * light_->tail->ratio, work, light);
}

void RowCapture::light_at(int row, int column, std::vector<double>& work,
                          std::vector<double>& light) const {
  std::fill(light.begin(), light.end(), 0.0);
  if (light_) return add_all_light(row, column, work, light);
  pixel_.add_light(scene_->depth_m(row, column),
                   pixel_signal_e_per_s(*scene_, row, column, options_), work, light);
}

double RowCapture::ambient_e_per_s(int row, int column) const {
  const double scale = scene_->ambient_scale.empty() ? 1.0 : scene_->ambient_scale(row, column);
  return options_.ambient_e_per_s * scale;
}

void RowCapture::expose(int frame, std::uint64_t pixel, double ambient_e_per_s,
                        std::vector<double>& light, float* raw) const {
  RandomStream random(options_.seed, pixel, static_cast<std::uint32_t>(frame));
  pixel_.expose(ambient_e_per_s, random, light, raw);
}

void RowCapture::row(int frame, int row, float* raw) const {
  std::vector<double> work(static_cast<std::size_t>(tap_values())), light(work.size());
  const int width = scene_->width();
  for (int column = 0; column < width; ++column, raw += measurements()) {
    const auto pixel = static_cast<std::uint64_t>(row) * static_cast<std::uint64_t>(width) +
                       static_cast<std::uint64_t>(column);
    light_at(row, column, work, light);
    expose(frame, pixel, ambient_e_per_s(row, column), light, raw);
  }
}

}  // namespace tofsmith
