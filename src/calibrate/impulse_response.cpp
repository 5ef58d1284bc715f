// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/calibrate/impulse_response.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "calibrate/parametric_response.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/core/statistics.hpp"

namespace tofsmith {
namespace {

/// Peaks, highest first: at least 15 % of the highest and 5 `noise_rms`, and separated from higher
/// peaks by a valley below 70 % of their height.
std::vector<ResponsePeak> peaks_of(const ImpulseResponse& response, double noise_rms) {
  constexpr double lowest = 0.15, deepest_valley = 0.7;
  const std::vector<double>& h = response.samples;
  std::vector<std::size_t> maxima;
  for (std::size_t i = 1; i + 1 < h.size(); ++i)
    if (h[i] > h[i - 1] && h[i] >= h[i + 1]) maxima.push_back(i);
  std::ranges::sort(maxima, std::greater{}, [&](std::size_t i) { return h[i]; });
  std::vector<std::size_t> kept;
  for (const std::size_t i : maxima) {
    if (!kept.empty() && h[i] < std::max(lowest, 5 * noise_rms) * h[kept.front()]) break;
    const auto is_apart = [&](std::size_t other) {
      const auto [first, last] = std::minmax(i, other);
      const auto begin = h.begin() + static_cast<std::ptrdiff_t>(first);
      const auto end = h.begin() + static_cast<std::ptrdiff_t>(last);
      return *std::min_element(begin, end) < deepest_valley * h[i];
    };
    if (std::ranges::all_of(kept, is_apart)) kept.push_back(i);
  }
  std::vector<ResponsePeak> peaks;
  for (const std::size_t i : kept)
    peaks.push_back(
        {(static_cast<double>(i) - static_cast<double>(kept.front())) * response.time_step_s,
         h[i] / h[kept.front()]});
  return peaks;
}

using Eigen::Index;

Eigen::VectorXd moving_average(const Eigen::VectorXd& x, Index width) {
  const Index before = width / 2, after = width - 1 - before;
  Eigen::VectorXd sums(x.size() + 1);
  sums[0] = 0.0;
  for (Index i = 0; i < x.size(); ++i) sums[i + 1] = sums[i] + x[i];
  Eigen::VectorXd result(x.size());
  for (Index i = 0; i < x.size(); ++i) {
    const Index first = std::max<Index>(0, i - before), last = std::min(x.size(), i + after + 1);
    result[i] = (sums[last] - sums[first]) / static_cast<double>(last - first);
  }
  return result;
}

double median_of_all(const Eigen::VectorXd& x) {
  return tofsmith::median_of(std::vector<double>(x.begin(), x.end()));
}

double rms_about_mean(const Eigen::VectorXd& x) {
  return std::sqrt((x.array() - x.mean()).square().sum() /
                   static_cast<double>(std::max<Index>(1, x.size() - 1)));
}

Excitation excitation_of(const Eigen::VectorXd& values) {
  const Index tenth = std::max<Index>(1, values.size() / 10);
  const Eigen::VectorXd smooth = moving_average(values, std::max<Index>(1, values.size() / 100));
  const double rise = std::abs(values.tail(tenth).mean() - values.head(tenth).mean());
  return rise > 0.5 * (smooth.maxCoeff() - smooth.minCoeff()) ? Excitation::step
                                                              : Excitation::pulse;
}

/// Rotates a whole period whose pulse wraps around, so that the pulse is at one third of the
/// record.
void unroll(CalibratedResponse& result, Eigen::VectorXd& values) {
  Index peak = 0;
  values.maxCoeff(&peak);
  const Index count = values.size(), edge = std::max<Index>(2, count / 50);
  const double middle = median_of_all(values), half = middle + 0.05 * (values[peak] - middle);
  const bool wraps =
      (peak < edge && values.tail(edge).maxCoeff() > half && values[count - 1] > half) ||
      (peak >= count - edge && values[0] > half);
  if (!wraps) return;
  const Index move = count / 3 - peak;
  Eigen::VectorXd rolled(count);
  for (Index i = 0; i < count; ++i) rolled[((i + move) % count + count) % count] = values[i];
  values = std::move(rolled);
  result.record.start_time_s -= static_cast<double>(move) * result.record.time_step_s;
  result.notes.emplace_back(
      "the pulse extends over the ends of the record, which was assumed to be a whole period and "
      "rotated");
}

struct Place {
  Index centre = 0;    // of the peak, or half of the step
  double width = 1.0;  // full width at half maximum [samples]
};

/// Locates a pulse by the points at half height.
Place place_of_pulse(const Eigen::VectorXd& values) {
  Place place;
  const double middle = median_of_all(values);
  const double peak = values.maxCoeff(&place.centre), half = middle + 0.5 * (peak - middle);
  Index first = place.centre, last = place.centre;
  while (first > 0 && values[first - 1] > half) --first;
  while (last + 1 < values.size() && values[last + 1] > half) ++last;
  place.width = static_cast<double>(last - first + 1);
  return place;
}

/// Locates a step by the points at 10 %, 50 % and 90 %; the width is that of a Gaussian.
Place place_of_step(const Eigen::VectorXd& values) {
  const Index tenth = std::max<Index>(1, values.size() / 10);
  const double base = median_of_all(values.head(tenth)), top = median_of_all(values.tail(tenth));
  const auto crossing = [&](double share) {
    Index i = 0;
    while (i + 1 < values.size() && values[i] < base + share * (top - base)) ++i;
    return i;
  };
  const double rise_per_width = 1.088;  // 2 * 1.2816 / 2.3548
  return {crossing(0.5),
          std::max(1.0, static_cast<double>(crossing(0.9) - crossing(0.1)) / rise_per_width)};
}

/// Values before the response, or, if there are too few, after a pulse.
Eigen::VectorXd quiet_values(const Eigen::VectorXd& values, Excitation excitation,
                             const Place& place) {
  constexpr Index min_samples = 8;
  const auto reach = static_cast<Index>(std::ceil(3 * place.width));
  const Index ahead = place.centre - reach;
  if (ahead >= min_samples) return values.head(ahead);
  const Index behind = values.size() - (place.centre + 3 * reach);
  if (excitation == Excitation::pulse && behind >= min_samples) return values.tail(behind);
  reject("record", fmt::format("{} values before the response", std::max<Index>(0, ahead)),
         fmt::format("must contain the level before the response: at least {} values that end 3 "
                     "widths before it",
                     min_samples));
}

/// Range of significant values, with a margin.
std::pair<Index, Index> support_of(const Eigen::VectorXd& response, const Place& place,
                                   double noise_of_smoothed, Index smoothing) {
  const Eigen::VectorXd smooth = moving_average(response, smoothing);
  const double out =
      (1.0 + std::sqrt(2 * std::log(static_cast<double>(smooth.size())))) * noise_of_smoothed;
  Index first = smooth.size(), last = -1;
  for (Index i = 0; i < smooth.size(); ++i) {
    if (smooth[i] <= out) continue;
    first = std::min(first, i);
    last = i;
  }
  require(last >= first, "record", "noise",
          "must contain a response that exceeds its noise by 4 standard deviations");
  const auto room = static_cast<Index>(std::ceil(2 * place.width));
  return {std::max<Index>(0, first - room), std::min(smooth.size() - 1, last + room)};
}

ResponseWindow window_of(const CalibratedResponse& result, const Eigen::VectorXd& values,
                         const Eigen::VectorXd& variance, double background_variance,
                         const Place& place) {
  ResponseWindow window{.time_step_s = result.record.time_step_s};
  const bool is_step = result.excitation == Excitation::step;
  window.differentiated = is_step;
  window.background_variance = background_variance;
  const auto width = static_cast<Index>(std::max(1.0, place.width));
  Eigen::VectorXd response = values.array() - result.background;
  Index smoothing = std::max<Index>(1, width / 3);
  double smoothed_noise = result.noise_rms / std::sqrt(static_cast<double>(smoothing));
  if (is_step) {
    response = (values.tail(values.size() - 1) - values.head(values.size() - 1)).eval();
    smoothing = width;
    smoothed_noise = std::numbers::sqrt2 * result.noise_rms / static_cast<double>(smoothing);
  }
  const auto [first, last] = support_of(response, place, smoothed_noise, smoothing);
  window.values = response.segment(first, last - first + 1);
  window.variance = variance.segment(first, last - first + 1);
  if (is_step) {  // end levels are known much better than single values
    window.values[0] = values[first + 1] - result.background;
    window.values[window.values.size() - 1] = result.background + result.height - values[last];
  }
  window.start_time_s =
      result.record.start_time_s + static_cast<double>(first) * result.record.time_step_s;
  return window;
}

/// A period over a multiple of N, fine enough for the response.
double output_step_s(const ResponseCalibrationOptions& options, double width_s, double span_s) {
  constexpr double steps_per_width = 16.0, max_samples = 16384.0;
  const double grid_s = 1.0 / (options.fundamental_frequency_hz * options.samples);
  const double wanted = std::ceil(grid_s * steps_per_width / width_s);
  const double max_factor = std::floor(max_samples * grid_s / span_s);
  return grid_s / std::max(1.0, std::min(wanted, max_factor));
}

void fit_kinds(CalibratedResponse& result, const Eigen::VectorXd& values,
               const Eigen::VectorXd& variance, const Place& place, double sign) {
  ResponseFitProblem problem{
      .excitation = result.excitation,
      .values = values,
      .weights = variance.cwiseInverse() * result.noise_rms * result.noise_rms,
      .time_step_s = result.record.time_step_s,
      .place_s = static_cast<double>(place.centre) * result.record.time_step_s,
      .width_s = place.width * result.record.time_step_s};
  for (const auto kind : {ImpulseResponse::Kind::hann, ImpulseResponse::Kind::gaussian,
                          ImpulseResponse::Kind::lowpass}) {
    ParametricResponse fit = fit_parametric_response(kind, problem);
    fit.fit *= sign;
    fit.residual_rms /= result.height;
    result.fits.push_back(std::move(fit));
  }
  std::ranges::stable_sort(result.fits, {}, &ParametricResponse::residual_rms);
}

/// Number n of equal highest values if a pulse was clipped, else 0. If values are only rounded to
/// steps q, the top is a parabola, which falls by 4 q over the next n / 2 values; a clipped pulse
/// falls faster.
Index clipped_values(const Eigen::VectorXd& values) {
  constexpr Index fewest = 3;
  constexpr double steeper = 2.0;
  Index first = 0;
  const double top = values.maxCoeff(&first);
  Index longest = 0;
  for (Index begin = first; begin < values.size(); ++begin) {
    Index end = begin;
    while (end < values.size() && values[end] == top) ++end;
    if (end - begin > longest) {
      longest = end - begin;
      first = begin;
    }
    begin = end;
  }
  const Index reach = (longest + 1) / 2;
  if (longest < fewest || first < reach || first + longest + reach > values.size()) return 0;
  const double step = top - (values.array() < top).select(values, values.minCoeff()).maxCoeff();
  const double fall = top - std::max(values[first - reach], values[first + longest + reach - 1]);
  return fall > steeper * 4.0 * step ? longest : 0;
}

}  // namespace

void ResponseCalibrationOptions::validate() const {
  require(std::isfinite(fundamental_frequency_hz) && fundamental_frequency_hz > 0.0,
          "fundamental_frequency_hz", fundamental_frequency_hz, "must be finite and > 0");
  require(samples >= 8 && samples <= 65536, "samples", samples, "must be in [8, 65536]");
}

bool CalibratedResponse::fit_is_good() const {
  return !fits.empty() && fits.front().residual_rms * height <= 1.3 * noise_rms;
}

double bandwidth_hz(const ImpulseResponse& response) {
  response.validate("response");
  require(response.kind != ImpulseResponse::Kind::none, "response.kind", "none",
          "must be a response with a finite bandwidth");
  // Step: 1/64 of a scale at which every kind has negligible loss.
  const double scale_hz =
      response.kind == ImpulseResponse::Kind::hann ? response.f_max_hz
      : response.kind == ImpulseResponse::Kind::file
          ? 1.0 / (response.time_step_s * static_cast<double>(response.samples.size()))
          : response.cutoff_hz;
  const double level = std::numbers::sqrt2 / 2;
  double low_hz = 0.0, high_hz = scale_hz / 64;
  for (int i = 0; std::abs(response.transfer(high_hz)) > level; ++i) {
    require(i < 1 << 22, "response", "all-pass", "must have a finite bandwidth");
    low_hz = high_hz;
    high_hz += scale_hz / 64;
  }
  for (int i = 0; i < 60; ++i) {
    const double middle_hz = 0.5 * (low_hz + high_hz);
    (std::abs(response.transfer(middle_hz)) > level ? low_hz : high_hz) = middle_hz;
  }
  return 0.5 * (low_hz + high_hz);
}

CalibratedResponse calibrate_impulse_response(ResponseRecord record,
                                              const ResponseCalibrationOptions& options) {
  options.validate();
  require(record.values.size() >= 16, "record", record.values.size(), "must have >= 16 values");
  require(record.values.allFinite(), "record", "not finite", "must be finite");
  require(record.values.maxCoeff() > record.values.minCoeff(), "record", "constant",
          "must contain a response");
  CalibratedResponse result;
  result.notes = record.notes;
  result.record = std::move(record);
  Eigen::VectorXd values = result.record.values;

  // Determine excitation, sign and position.
  result.excitation =
      options.excitation == Excitation::automatic ? excitation_of(values) : options.excitation;
  const bool is_step = result.excitation == Excitation::step;
  const Index tenth = std::max<Index>(1, values.size() / 10);
  const double middle = median_of_all(values);
  result.falling = is_step ? values.tail(tenth).mean() < values.head(tenth).mean()
                           : middle - values.minCoeff() > values.maxCoeff() - middle;
  const double sign = result.falling ? -1.0 : 1.0;
  values *= sign;
  if (!is_step) unroll(result, values);
  result.record.values = sign * values;
  Place place = is_step ? place_of_step(values) : place_of_pulse(values);
  const auto smoothing = static_cast<Index>(std::max(1.0, place.width / 8));
  const Eigen::VectorXd smooth = moving_average(values, smoothing);
  place = is_step ? place_of_step(smooth) : place_of_pulse(smooth);

  const Eigen::VectorXd quiet = quiet_values(values, result.excitation, place);
  result.background = result.record.counts ? quiet.mean() : median_of_all(quiet);
  result.height = is_step ? median_of_all(values.tail(tenth)) - result.background
                          : smooth.maxCoeff() - result.background;
  result.noise_rms = rms_about_mean(quiet);
  if (result.noise_rms < 1e-5 * result.height) {
    result.noise_rms = 1e-3 * result.height;
    result.notes.emplace_back(
        "the level before the response has no noise, so the record was processed before; its noise "
        "was assumed to be 1/1000 of its height");
  }
  result.snr_db = 20 * std::log10(result.height / result.noise_rms);
  Eigen::VectorXd variance =
      Eigen::VectorXd::Constant(values.size(), result.noise_rms * result.noise_rms);
  if (result.record.counts)  // variance = mean, estimated from adjacent values
    variance = moving_average(values, std::max<Index>(3, smoothing)).cwiseMax(variance);

  fit_kinds(result, values, variance, place, sign);
  const double background_variance =
      result.noise_rms * result.noise_rms / static_cast<double>(quiet.size());
  const ResponseWindow window = window_of(result, values, variance, background_variance, place);
  result.bandwidth_hz = measured_bandwidth_hz(window);
  const double width_s = place.width * result.record.time_step_s;
  const double span_s =
      static_cast<double>(window.values.size()) * result.record.time_step_s + 2 * width_s;
  const double step_s = output_step_s(options, width_s, span_s);
  const DenoisedResponse denoised = denoised_response(window, step_s, width_s);
  result.response = denoised.response;
  result.response_centre_s = denoised.response_centre_s;
  result.delay_s = denoised.centre_s;

  result.peaks = peaks_of(result.response, denoised.noise_rms);
  for (std::size_t i = 1; i < result.peaks.size(); ++i)
    result.notes.push_back(fmt::format(
        "{} peak of {:.2f} times the highest, {:+.4g} ns from it, was kept; remove it from the "
        "record if it is a reflection or second path outside the arm",
        i == 1 ? "a second" : "another", result.peaks[i].height, 1e9 * result.peaks[i].time_s));
  if (const Index clipped = is_step ? 0 : clipped_values(values); clipped > 0)
    result.notes.push_back(fmt::format(
        "the top of the pulse is flat: {} consecutive values equal {:.4g}. If the oscilloscope "
        "clipped the pulse, the bandwidth is too low; measure again with more volts per division",
        clipped, sign * values.maxCoeff()));
  if (!result.fit_is_good())
    result.notes.push_back(fmt::format(
        "no parametric kind describes the record down to its noise (best {}, residual {:.2g} % of "
        "the height, noise {:.2g} %); use the measured response (--as file)",
        name_of(result.fits.front().response.kind), 100 * result.fits.front().residual_rms,
        100 * result.noise_rms / result.height));
  const double grid_s = 1.0 / (options.fundamental_frequency_hz * options.samples);
  // A second peak degrades the response even if both peaks are narrow.
  const bool is_short = std::ranges::all_of(
      result.peaks, [&](const auto& peak) { return std::abs(peak.time_s) < 2 * grid_s; });
  if (width_s < 2 * grid_s && is_short)
    result.notes.push_back(
        fmt::format("the response, {:.3g} ns wide, is shorter than two of the camera's time "
                    "samples of {:.3g} ns and has hardly any effect",
                    1e9 * width_s, 1e9 * grid_s));
  if (result.snr_db < 20)
    result.notes.push_back(
        fmt::format("the record's signal is only {:.0f} dB above its noise; average more records",
                    result.snr_db));
  result.background *= sign;
  return result;
}

}  // namespace tofsmith
