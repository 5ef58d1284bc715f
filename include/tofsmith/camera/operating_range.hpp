// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tofsmith/core/field_visitor.hpp"
#include "tofsmith/core/fields.hpp"

namespace tofsmith {

/// Light levels, as photo-electron rates of a fully open sensor.
struct OperatingPoint {
  double signal_e_per_s = 0.0;   ///< S
  double ambient_e_per_s = 0.0;  ///< A

  friend bool operator==(const OperatingPoint&, const OperatingPoint&) = default;
};
auto fields_of(ConstOrNot<OperatingPoint> auto& p) {
  return std::tuple(
      Field("signal_e_per_s", p.signal_e_per_s, at_least(0), Help{"modulated light"}),
      Field("ambient_e_per_s", p.ambient_e_per_s, at_least(0), Help{"all other light"}));
}

enum class DepthErrorKind {
  linear,    ///< |decoded - true|, as in the paper: a wrap costs the whole range
  circular,  ///< the shorter way around the range
};
constexpr auto words_of(DepthErrorKind /*any*/) { return word_list("linear", "circular"); }

enum class ErrorStatistic {
  mae,   ///< mean absolute error
  rmse,  ///< root mean square error; wrong lobes have more weight
};
constexpr auto words_of(ErrorStatistic /*any*/) { return word_list("mae", "rmse"); }

/// Depth error that designs minimize.
struct DepthErrorMeasure {
  DepthErrorKind kind;
  ErrorStatistic statistic;

  constexpr DepthErrorMeasure(DepthErrorKind kind_, ErrorStatistic statistic_ = ErrorStatistic::mae)
      : kind(kind_), statistic(statistic_) {}
};
constexpr std::string_view name_of(DepthErrorMeasure measure) {
  if (measure.statistic == ErrorStatistic::mae) return name_of(measure.kind);
  return measure.kind == DepthErrorKind::linear ? "linear root mean square"
                                                : "circular root mean square";
}

/// Multipath in the scenes of a camera: one second return with uniformly distributed ratio and
/// delay.
struct OperatingMultipath {
  std::array<double, 2> ratio{0.1, 0.5};    ///< S2 / S1, smallest and largest
  std::array<double, 2> delay_m{0.5, 3.0};  ///< behind the direct return, below the range
  /// Designs minimize E1^(1 - weight) E2^weight, with the errors E1 of single returns and E2 with
  /// such a second return, decoded as a single one.
  double weight = 0.2;

  /// For numbers that are uniform on [0, 1).
  double ratio_at(double uniform) const { return ratio[0] + uniform * (ratio[1] - ratio[0]); }
  double delay_at_m(double uniform) const {
    return delay_m[0] + uniform * (delay_m[1] - delay_m[0]);
  }

  /// E1^(1 - weight) E2^weight.
  double weighed(double single_return_error, double operating_multipath_error) const;

  /// @throws InvalidArgument
  void validate(double range_m) const;

  friend bool operator==(const OperatingMultipath&, const OperatingMultipath&) = default;
};

/// Keys of [operating.multipath].
inline void describe(FieldVisitor& fields, OperatingMultipath& multipath) {
  fields.value(Key("ratio", "Smallest and largest ratio of the second return to the direct one",
                   closed(0, 1)),
               multipath.ratio);
  fields.value(Key("delay_m", "Shortest and longest delay behind the direct return", above(0)),
               multipath.delay_m);
  fields.value(
      Key("weight", "Weight of the error with multipath in the design criterion", open(0, 1)),
      multipath.weight);
}

/// Changes of light and demodulation from part to part of an exposure, against other cameras.
enum class Spreading {
  none,
  phases,  ///< independent delays, uniform over the period
  signs,   ///< independent delays of 0 or half a period, as in pseudo-noise modulation
};
constexpr auto words_of(Spreading /*any*/) { return word_list("none", "phases", "signs"); }

/// Other cameras that light the same surfaces. They are not synchronized: the phase of each is
/// random in every frame, as is the exposure with which its frame begins.
struct OperatingInterference {
  int cameras = 1;            ///< with independent phases
  double signal_ratio = 0.1;  ///< light of each, divided by the signal
  std::string code = "same";  ///< family of their modulation
  double frequency_offset_hz = 0.0;
  Spreading spreading = Spreading::none;
  int parts = 16;  ///< of each exposure

  bool spreads() const { return spreading != Spreading::none; }

  /// @throws InvalidArgument
  void validate(double fundamental_frequency_hz) const;

  friend bool operator==(const OperatingInterference&, const OperatingInterference&) = default;
};

/// Keys of [operating.interference].
inline void describe(FieldVisitor& fields, OperatingInterference& interference) {
  fields.value(
      Key("cameras", "Number of other cameras that light the same surfaces", closed(1, 1000)),
      interference.cameras);
  fields.value(Key("signal_ratio",
                   "Light of each other camera that the surface reflects, divided by the signal",
                   left_open(0, 100)),
               interference.signal_ratio);
  fields.value(Key("code",
                   "Modulation of the other cameras: \"same\" as this camera, or the name of a "
                   "family"),
               interference.code);
  fields.value(Key("frequency_offset_hz",
                   "Fundamental frequency of the other cameras minus the one of this camera",
                   closed(-1e9, 1e9)),
               interference.frequency_offset_hz);
  fields.choice(Key("spreading",
                    "Change of this camera's light and demodulation between the parts of an "
                    "exposure: random phases, or random signs as in pseudo-noise modulation"),
                interference.spreading);
  fields.value(
      Key("parts", "Number of equal parts of each exposure with independent phases or signs",
          closed(1, 4096))
          .only(interference.spreads(), "spreading = \"phases\" or \"signs\""),
      interference.parts);
}

/// Conditions under which codes are evaluated: every pair of signal and ambient light.
struct OperatingRange {
  std::vector<double> signal_e_per_s;   ///< S
  std::vector<double> ambient_e_per_s;  ///< A
  DepthErrorKind error = DepthErrorKind::circular;
  ErrorStatistic statistic = ErrorStatistic::mae;
  double albedo = 1.0;
  bool uniform_albedo = false;  ///< instead: drawn from (0, 1) for every trial
  /// See judged_camera().
  int neighbours = 1;
  /// Absent: single returns.
  std::optional<OperatingMultipath> multipath = {};
  /// Absent: no other cameras.
  std::optional<OperatingInterference> interference = {};
  std::optional<std::array<double, 2>> working_distance_m = {};
  std::optional<std::vector<double>> depths = {};
  /// Velocity of surfaces along the ray [m/s], positive: away from the camera. Designs choose the
  /// order of exposures for it. None: static surfaces.
  std::optional<double> velocity_m_per_s = {};

  /// All pairs, in the order of the signals.
  std::vector<OperatingPoint> points() const;
  /// Depth error that designs minimize.
  DepthErrorMeasure measure() const { return {error, statistic}; }
  /// The pair in the middle of both lists.
  OperatingPoint middle() const;

  friend bool operator==(const OperatingRange&, const OperatingRange&) = default;
};

/// Keys of [operating].
inline void describe(FieldVisitor& fields, OperatingRange& range) {
  fields.value(Key("signal_e_per_s",
                   "Levels of the modulated light, as photo-electron rates of a fully open "
                   "sensor",
                   left_open(0, 1e18))
                   .because("no sensor sees more electrons")
                   .usually(1e3, 1e7),
               range.signal_e_per_s);
  fields.value(Key("ambient_e_per_s", "Levels of all other light", closed(0, 1e18))
                   .because("no sensor sees more electrons")
                   .usually(1e2, 1e8),
               range.ambient_e_per_s);
  fields.choice(Key("error",
                    "Definition of the depth error: circular (the shorter way around the range), "
                    "or linear as in the paper")
                    .basic(),
                range.error);
  fields.choice(Key("statistic",
                    "Statistic by which design ranks codes and optimizes rows: mean absolute or "
                    "root mean square error"),
                range.statistic);
  fields.value(Key("albedo",
                   "Factor of the signal; \"uniform\": drawn uniformly from (0, 1) in every "
                   "trial",
                   left_open(0, 1))
                   .usually(0.05, 1),
               NumberOrWord{range.albedo, "uniform", range.uniform_albedo});
  fields.value(
      Key("neighbours", "Number of pixels at the same depth that a filter combines before decoding",
          closed(1, 10000)),
      range.neighbours);
  fields.value(Key("working_distance_m",
                   "Nearest and farthest depth, between which decoding searches; default: the "
                   "whole unambiguous range",
                   at_least(0)),
               range.working_distance_m);
  fields.value(Key("depths",
                   "Histogram of depths: weights of equal parts of the working distance; "
                   "without it, all depths are equally frequent",
                   at_least(0)),
               range.depths);
  fields.value(Key("velocity_m_per_s",
                   "Velocity of surfaces along the ray; positive: away from the camera; without "
                   "it, surfaces are static",
                   closed(-1000, 1000)),
               range.velocity_m_per_s);
  fields.table(Key("multipath", "Multipath that designs take into account"), range.multipath);
  fields.table(Key("interference",
                   "Other cameras that light the same surfaces; designs take them into account"),
               range.interference);
}

/// Conditions of the paper: linear error, S in {1e3, 10^3.5, 1e4, 10^4.5, 1e5} and A in {1e2, 1e3,
/// 1e4, 10^4.5, 1e5}.
OperatingRange paper_operating_range();

/// Default conditions: the light levels of the paper and the circular error.
OperatingRange default_operating_range();

}  // namespace tofsmith
