// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "simulate/row_capture.hpp"

#include <algorithm>
#include <cmath>

namespace tofsmith {

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
