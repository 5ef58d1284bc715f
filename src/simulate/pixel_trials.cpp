// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "simulate/pixel_trials.hpp"

#include <algorithm>
#include <cmath>

#include "tofsmith/core/units.hpp"
#include "tofsmith/decode/decoding_table.hpp"

namespace tofsmith {

void PixelSums::add(const TrueDepths& true_m, double depth_m, double deviation_m,
                    PixelStatus status, double range_m) {
  inconsistent += status == PixelStatus::inconsistent;
  if (std::isnan(depth_m)) {  // as a guess; linear: in the middle of the range
    linear_m.add(std::abs(0.5 * range_m - true_m[0]));
    circular_m.add(0.25 * range_m);
    circular_square_m2.add(range_m * range_m / 12.0);
    return;
  }
  const double first_m = circular_difference(depth_m, true_m[0], range_m);
  const double second_m = circular_difference(depth_m, true_m[1], range_m);
  const double nearest_m = std::abs(second_m) < std::abs(first_m) ? second_m : first_m;
  linear_m.add(std::min(std::abs(depth_m - true_m[0]), std::abs(depth_m - true_m[1])));
  circular_m.add(std::abs(nearest_m));
  circular_square_m2.add(nearest_m * nearest_m);
  bias_m.add(nearest_m);
  if (!(std::abs(nearest_m) > 3.0 * deviation_m)) return;
  ++wrong;
  wrong_ok += status == PixelStatus::ok;
  wrong_inconsistent += status == PixelStatus::inconsistent;
}

Estimate PixelSums::circular_rmse_m() const {
  const double rmse_m = std::sqrt(circular_square_m2.mean());
  if (rmse_m == 0.0) return {};
  return {rmse_m, 0.5 * circular_square_m2.standard_error() / rmse_m};
}

WrongShares PixelSums::shares() const {
  const auto share = [&](std::int64_t count) {
    return static_cast<double>(count) / static_cast<double>(circular_m.count());
  };
  return {.wrong = share(wrong),
          .wrong_ok = share(wrong_ok),
          .wrong_inconsistent = share(wrong_inconsistent),
          .inconsistent = share(inconsistent)};
}

WrongShares mean_shares(const std::vector<WrongShares>& shares) {
  WrongShares mean;
  for (const WrongShares& one : shares)
    for (const auto share : {&WrongShares::wrong, &WrongShares::wrong_ok,
                             &WrongShares::wrong_inconsistent, &WrongShares::inconsistent})
      mean.*share += one.*share / static_cast<double>(shares.size());
  return mean;
}

std::optional<double> WrongShares::detected() const {
  if (!(wrong > 0.0)) return std::nullopt;
  return wrong_inconsistent / wrong;
}

PixelTrials::PixelTrials(const CodeSet& code, const Camera& camera, const EvaluateOptions& options)
    : camera_(camera),
      options_(options),
      depths_(camera),
      model_(code, camera),
      pixel_(model_, camera),
      decoder_(make_decoder(options.method, make_decoding_table(model_, camera), {},
                            options.unwrap_weights)) {}

std::pair<double, double> PixelTrials::draw_surface(double quantile, double signal_e_per_s,
                                                    RandomStream& random) const {
  const OperatingRange& operating = camera_.operating;
  const double albedo = operating.uniform_albedo ? random.uniform() : operating.albedo;
  return {depths_.quantile(quantile) * camera_.range_m(), albedo * signal_e_per_s};
}

void PixelTrials::add_decoded(const RawFrames& raw, const std::vector<TrueDepths>& true_m,
                              PixelSums& sums) const {
  DepthImage image({DecodedPlane::depth, DecodedPlane::deviation, DecodedPlane::status}, 1,
                   raw.width);
  decoder_->decode(RawView::interleaved(raw.values.data(), 1, raw.width, raw.measurements),
                   DecodedView::of(image));
  for (std::size_t i = 0; i < true_m.size(); ++i)
    sums.add(true_m[i], image.depth_m.pixels[i], image.deviation_m.pixels[i],
             image.status.pixels[i], camera_.range_m());
}

}  // namespace tofsmith
