// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "paper/range_emulation.hpp"

#include <cmath>

#include "simulate/shared/pixel_capture.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/core/parallel.hpp"
#include "tofsmith/core/units.hpp"

namespace tofsmith {

namespace {

EmulatedDepth error_of(const std::vector<double>& decoded_bin, double true_m,
                       const Camera& camera) {
  RunningStatistics signed_error, linear, circular;
  for (const double bin : decoded_bin) {
    const double decoded_m = bin * camera.bin_m();
    const double difference_m = circular_difference(decoded_m, true_m, camera.range_m());
    signed_error.add(difference_m);
    circular.add(std::abs(difference_m));
    linear.add(std::abs(decoded_m - true_m));
  }
  return {true_m, signed_error.estimate(), linear.estimate(), circular.estimate()};
}

Estimate mean_over_depths(const std::vector<EmulatedDepth>& depths,
                          Estimate EmulatedDepth::*error) {
  std::vector<Estimate> errors;
  for (const EmulatedDepth& depth : depths) errors.push_back(depth.*error);
  return mean_of(errors);
}

}  // namespace

void RangeEmulationOptions::validate() const {
  require(std::isfinite(target_m) && target_m >= 0.0, "target_m", target_m,
          "must be finite and >= 0");
  require(shifts >= 1, "shifts", shifts, "must be >= 1");
  require(estimates >= 2, "estimates", estimates, "must be >= 2");
  require(std::isfinite(point.signal_e_per_s) && point.signal_e_per_s >= 0.0,
          "point.signal_e_per_s", point.signal_e_per_s, "must be finite and >= 0");
  require(std::isfinite(point.ambient_e_per_s) && point.ambient_e_per_s >= 0.0,
          "point.ambient_e_per_s", point.ambient_e_per_s, "must be finite and >= 0");
}

Estimate RangeEmulation::percent_of_range(const Estimate& error_m) const {
  return {100 * error_m.value / range_m, 100 * error_m.standard_error / range_m};
}

RangeEmulation emulate_range(const CodeSet& code, const Camera& camera,
                             const RangeEmulationOptions& options, const Progress& progress) {
  options.validate();
  const ForwardModel model(code, camera);
  const PixelCapture pixel(model, camera);
  const AnyDecoder decoder = make_decoder(options.method, make_decoding_table(model, camera));
  const auto measurements = static_cast<std::size_t>(pixel.measurements());
  const auto estimates = static_cast<std::size_t>(options.estimates);

  RangeEmulation result{.range_m = camera.range_m()};
  result.depths.resize(static_cast<std::size_t>(options.shifts));
  report(progress, 0.0, "range emulation");
  parallel_for(options.shifts, [&](std::int64_t shift) {
    const double delay_m = camera.range_m() * static_cast<double>(shift) / options.shifts;
    const double true_m = wrap(options.target_m + delay_m, camera.range_m());
    std::vector<double> work(static_cast<std::size_t>(pixel.tap_values()));
    std::vector<float> raw(estimates * measurements);
    for (std::size_t t = 0; t < estimates; ++t) {
      RandomStream random(options.seed, static_cast<std::uint64_t>(shift),
                          static_cast<std::uint32_t>(t));
      pixel(true_m, options.point.signal_e_per_s, options.point.ambient_e_per_s, random, work,
            raw.data() + t * measurements);
    }
    std::vector<double> decoded_bin(estimates);
    std::visit(
        [&](const auto& d) {
          d.decode_depth_bins(raw.data(), options.estimates, decoded_bin.data());
        },
        decoder);
    result.depths[static_cast<std::size_t>(shift)] = error_of(decoded_bin, true_m, camera);
  });
  result.linear_mde_m = mean_over_depths(result.depths, &EmulatedDepth::linear_mde_m);
  result.circular_mde_m = mean_over_depths(result.depths, &EmulatedDepth::circular_mde_m);
  report(progress, 1.0, "range emulation");
  return result;
}

}  // namespace tofsmith
