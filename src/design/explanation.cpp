// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/judge.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>

#include "design/baselines.hpp"
#include "tofsmith/core/units.hpp"

namespace tofsmith {

namespace {

std::string length_mm(const Estimate& e) { return estimate_mm_text(e) + " mm"; }

/// Returns null if there is none. Atlas codes are no baselines, because they were designed.
const Candidate* best_baseline(const DesignResult& result, DepthErrorMeasure measure) {
  for (const Candidate* c : by_geometric_mean_error(result, measure))
    if (c != &result.winner() && !c->is_designed() && c->method != "atlas") return c;
  return nullptr;
}

/// Returns " with 2 exposures" if the best code has another number of exposures.
std::string among_exposures(const DesignResult& result, DepthErrorMeasure measure,
                            const std::vector<int>& exposures) {
  const std::vector<const Candidate*> order = by_geometric_mean_error(result, measure);
  if (exposures.empty() ||
      std::count(exposures.begin(), exposures.end(), order.front()->code.exposures()) > 0)
    return "";
  return fmt::format(" with {} exposures", fmt::join(exposures, ", "));
}

std::string includes_text(const OperatingRange& range) {
  if (range.multipath && range.interference) return ", including multipath and interference";
  if (range.multipath) return ", including multipath";
  return range.interference ? ", including interference" : "";
}

std::string what_it_beats(const Camera& camera, const DesignResult& result,
                          DepthErrorMeasure measure, const std::vector<int>& exposures) {
  const Candidate& winner = result.winner();
  const std::string among = among_exposures(result, measure, exposures);
  std::string text = fmt::format("{} is the best code{}{}. Its {} error is {}", winner.code.name(),
                                 among, includes_text(camera.operating), name_of(measure),
                                 length_mm(winner.error.of(measure).geometric_mean_m));
  // Ratios of errors without other cameras would not explain the ranking.
  if (camera.operating.interference) return text + " without other cameras.";
  const bool is_standard = !winner.is_designed() && winner.method != "atlas";
  if (const Candidate* baseline = best_baseline(result, measure)) {
    const Estimate gain = gain_over(result, *baseline, measure);
    text += fmt::format(
        "; the error of {}, the best {}standard code{}, is {:.2f} ± {:.2f} times as large",
        baseline->code.name(), is_standard ? "other " : "",
        among.empty() ? "" : " with any number of exposures", gain.value, gain.standard_error);
  }
  if (!among.empty() || winner.is_designed()) return text + ".";
  const bool any_designed = std::any_of(result.candidates.begin(), result.candidates.end(),
                                        [](const Candidate& c) { return c.is_designed(); });
  return text + fmt::format(". The best code is {}; {}.",
                            is_standard ? "a standard code" : "an atlas code",
                            any_designed ? "no designed code is better" : "no code was designed");
}

std::map<int, double> error_by_exposures(const DesignResult& result, DepthErrorMeasure measure) {
  std::map<int, double> errors;
  for (const Candidate& c : result.candidates) {
    const auto [at, is_new] =
        errors.try_emplace(c.error.exposures, geometric_mean_error_m(c.error, measure));
    if (!is_new) at->second = std::min(at->second, geometric_mean_error_m(c.error, measure));
  }
  return errors;
}

std::string why_so_many_exposures(const Camera& camera, const DesignResult& result,
                                  DepthErrorMeasure measure) {
  const DepthErrorReport& winner = result.winner().error;
  std::string others;
  for (const auto& [exposures, error_m] : error_by_exposures(result, measure))
    if (exposures != winner.exposures)
      others += fmt::format("{}{} mm ({} exposure{})", others.empty() ? "" : ", ",
                            plain_number(1e3 * error_m, 3), exposures, exposures == 1 ? "" : "s");
  const int harmonics = useful_harmonics(camera);
  const std::string band =
      harmonics == 0
          ? std::string("unlimited bandwidth")
          : fmt::format("a bandwidth of {} harmonics (each with a transmission of at least 4 %)",
                        harmonics);
  return fmt::format(
      "The camera has {} and {} per exposure. The best code has {} exposure{}.{} More exposures or "
      "taps distinguish more depths, but divide the same light and add read noise.",
      band,
      camera.sensor.is_signed() ? std::string("one mixer output")
      : winner.taps == 1        ? std::string("one tap")
                                : fmt::format("{} taps", winner.taps),
      winner.exposures, winner.exposures == 1 ? "" : "s",
      others.empty()
          ? std::string()
          : fmt::format(" With other numbers of exposures, the smallest errors are {}.", others));
}

std::string what_limits_it(const DesignResult& result) {
  const std::vector<PointDepthError>& points = result.winner().error.points;
  const auto by_error = [](const PointDepthError& a, const PointDepthError& b) {
    return a.circular_mde_m.value < b.circular_mde_m.value;
  };
  const auto [min, max] = std::minmax_element(points.begin(), points.end(), by_error);
  constexpr double exceeds = 2.0;  // bound / error
  const bool is_rows = result.winner().code.is_rows();
  const auto describe = [is_rows](const PointDepthError& p) {
    const double error_m = p.circular_mde_m.value;
    // Errors are limited by the range, the bound is not: a few depths can dominate its mean.
    const bool is_meaningful = !(p.cramer_rao_mae_m > exceeds * error_m);
    std::vector<std::string> ratios;
    if (p.cramer_rao_mae_m > 0.0 && is_meaningful)
      ratios.push_back(fmt::format("{:.2f} times the Cramer-Rao bound of the code",
                                   error_m / p.cramer_rao_mae_m));
    if (p.receiver_bound_mae_m > 0.0)
      ratios.push_back(fmt::format(
          "{:.2f} times the {}", error_m / p.receiver_bound_mae_m,
          is_rows ? "bound of the full histogram of the light" : "receiver bound of the camera"));
    std::string text = plain_number(1e3 * error_m, 3) + " mm";
    if (!ratios.empty()) text += fmt::format(", which is {}", fmt::join(ratios, " and "));
    if (!is_meaningful)
      text +=
          "; the Cramer-Rao bound is not meaningful there, because the correlation functions are "
          "nearly flat at some depth or the light is too dim";
    return text;
  };
  if (points.size() == 1)
    return fmt::format("The circular error of the best code is {}.", describe(*min));
  return fmt::format(
      "The circular error of the best code is smallest at a signal of {:.3g} e/s and ambient light "
      "of {:.3g} e/s. There, the error is {}. The error is largest at a signal of {:.3g} e/s and "
      "ambient light of {:.3g} e/s. There, {:.0f} % of the depths are outliers, and the error is "
      "{}.",
      min->point.signal_e_per_s, min->point.ambient_e_per_s, describe(*min),
      max->point.signal_e_per_s, max->point.ambient_e_per_s, 100 * max->outlier_rate.value,
      describe(*max));
}

std::string behind_multipath(const OperatingMultipath& returns, const DesignResult& result,
                             DepthErrorKind kind) {
  const Candidate& winner = result.winner();
  const Estimate its = winner.multipath->single_path.of(kind);
  std::string text = fmt::format(
      "With a second return of ratio {} to {} and a delay of {} to {} m, the {} error of the best "
      "code is {}",
      returns.ratio[0], returns.ratio[1], returns.delay_m[0], returns.delay_m[1], name_of(kind),
      length_mm(its));
  if (const Candidate* baseline = best_baseline(result, kind)) {
    const Estimate other = baseline->multipath->single_path.of(kind);
    text += fmt::format("; the error of {} is {}", baseline->code.name(), length_mm(other));
  }
  if (const auto& two_return = winner.multipath->two_return)
    return text +
           fmt::format(". With two-return decoding, the circular error of the best code is {}.",
                       length_mm(two_return->circular_m));
  return text + ". The best code has too few independent means for two-return decoding.";
}

/// Gain over the code that would be the best one without other cameras.
std::string behind_interference(const OperatingInterference& others, const DesignResult& result,
                                DepthErrorMeasure measure) {
  const Candidate& winner = result.winner();
  const auto error_of = [&](const Candidate& c) {
    return c.interference->of(measure.kind).geometric_mean_m;
  };
  const std::string text = fmt::format(
      "With the light of {} other camera{}, each {} times the signal, the {} error of the best "
      "code is {}",
      others.cameras, others.cameras == 1 ? "" : "s", others.signal_ratio, name_of(measure.kind),
      length_mm(error_of(winner)));
  const Candidate& alone = *by_geometric_mean_error(result, measure).front();
  if (&alone == &winner)
    return text + "; this code also has the smallest error without other cameras.";
  const Estimate gain = ratio_of(error_of(alone), error_of(winner));
  return text +
         fmt::format(
             "; the error of {}, which is the best code without other cameras, is {}, {:.2f} "
             "± {:.2f} times as large.",
             alone.code.name(), length_mm(error_of(alone)), gain.value, gain.standard_error);
}

std::string behind_motion(double velocity_m_per_s, const ExposureOrder& chosen) {
  const auto rms_mm = [](double error_m) { return fmt::format("{:.3f} mm", 1e3 * error_m); };
  const std::string text = fmt::format(
      "At {} m/s along the ray, motion between the exposures of the best code causes an rms error "
      "of {}",
      velocity_m_per_s, rms_mm(chosen.rms_bias_m));
  if (std::is_sorted(chosen.order.begin(), chosen.order.end()))
    return text + "; no other order of the exposures was better.";
  return text +
         fmt::format("; the exposures were reordered to {}, and the error decreased from {}.",
                     fmt::join(chosen.order, ", "), rms_mm(chosen.given_rms_bias_m));
}

}  // namespace

std::vector<std::string> explain(const Camera& camera, const DesignResult& result,
                                 const std::vector<int>& exposures) {
  const DepthErrorMeasure measure = camera.operating.measure();
  std::vector<std::string> sentences{what_it_beats(camera, result, measure, exposures)};
  if (!result.winner().code.is_rows())
    sentences.push_back(why_so_many_exposures(camera, result, measure));
  sentences.push_back(what_limits_it(result));
  if (camera.operating.multipath)
    sentences.push_back(
        behind_multipath(*camera.operating.multipath, result, camera.operating.error));
  if (camera.operating.interference)
    sentences.push_back(behind_interference(*camera.operating.interference, result, measure));
  if (const auto& chosen = result.winner().exposure_order)
    sentences.push_back(behind_motion(*camera.operating.velocity_m_per_s, *chosen));
  return sentences;
}

}  // namespace tofsmith
