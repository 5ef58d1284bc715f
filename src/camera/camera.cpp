// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/camera/camera.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

#include "camera/frequency_lists.hpp"
#include "camera/shared/actual_code.hpp"
#include "camera/shared/listed_exposures.hpp"
#include "tofsmith/code/families.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/core/units.hpp"

namespace tofsmith {
namespace {

void validate_adc(const Sensor& sensor) {
  if (sensor.adc_bits)
    require(sensor.gain_e_per_dn.has_value(), "sensor.adc_bits", *sensor.adc_bits,
            "requires sensor.gain_e_per_dn");
  if (sensor.gain_e_per_dn)
    require(sensor.adc_bits.has_value(), "sensor.gain_e_per_dn", *sensor.gain_e_per_dn,
            "requires sensor.adc_bits");
  if (sensor.black_level_dn) {
    require(sensor.adc_bits.has_value(), "sensor.black_level_dn", *sensor.black_level_dn,
            "requires sensor.adc_bits");
    require(*sensor.black_level_dn < std::exp2(*sensor.adc_bits), "sensor.black_level_dn",
            *sensor.black_level_dn, "must be below 2^sensor.adc_bits");
  }
}

/// Rows are sums of counts.
void validate_rows(const Sensor& sensor) {
  const auto require_none = [](bool none, const char* field, const char* value) {
    require(none, field, value, "cannot be combined with sensor.readout = \"rows\"");
  };
  require(sensor.taps == 1, "sensor.taps", sensor.taps,
          "must be 1 with sensor.readout = \"rows\"; the code determines the number of rows");
  require(sensor.tap_mismatch == 0.0, "sensor.tap_mismatch", sensor.tap_mismatch,
          "must be 0 with sensor.readout = \"rows\"");
  require_none(!sensor.generator, "sensor.generator", "a generator");
  require_none(!sensor.full_well_e, "sensor.full_well_e", "a limit");
  require_none(!sensor.adc_bits, "sensor.adc_bits", "a converter");
}

/// A mixer returns one signed number and has no drain.
void validate_mixer(const Sensor& sensor) {
  const char* const beside = "sensor.demodulation = \"signed\"";
  require(sensor.taps == 1, "sensor.taps", sensor.taps,
          fmt::format("must be 1 with {}: a mixer delivers one number per exposure", beside));
  require(sensor.readout == Readout::separate, "sensor.readout",
          sensor.readout == Readout::rows ? "rows" : "difference",
          fmt::format("must be \"separate\" with {}: {}", beside,
                      sensor.readout == Readout::rows
                          ? "rows of one exposure already have signed weights"
                          : "the number of a mixer is already a difference"));
  require(
      sensor.drain, "sensor.drain", "false",
      fmt::format("must be omitted with {}: a mixer weights all light and has no drain", beside));
  require(!sensor.adc_bits || !sensor.black_level_dn || *sensor.black_level_dn > 0.0,
          "sensor.black_level_dn", 0.0,
          fmt::format("must be > 0 with {}, or omitted for signed counts", beside));
}

void validate_sensor(const Sensor& sensor) {
  sensor.impulse_response.validate("sensor.impulse_response");
  std::vector<double> contrasts = sensor.modulation_contrasts;
  if (contrasts.empty()) contrasts = {sensor.modulation_contrast};
  for (const double contrast : contrasts)
    require(contrast == 1.0 || sensor.mixes_taps(), "sensor.modulation_contrast", contrast,
            "must be 1 for one tap: contrast mixes taps");
  validate_adc(sensor);
  if (sensor.integration_times_s)
    require_distinct("sensor.integration_times_s", *sensor.integration_times_s);
  require(sensor.decoder == RowDecoder::whitened || sensor.readout == Readout::rows,
          "sensor.decoder", "plain", "is only valid with sensor.readout = \"rows\"");
  require(sensor.drain || sensor.mixes_taps(), "sensor.drain", "false",
          "requires sensor.taps >= 2: a single tap that is always open does not measure depth");
  require(sensor.readout != Readout::difference || sensor.taps == 2, "sensor.readout", "difference",
          "requires sensor.taps = 2");
  if (sensor.readout == Readout::rows) validate_rows(sensor);
  if (sensor.is_signed()) validate_mixer(sensor);
}

void validate_depths(const OperatingRange& range, double range_m) {
  if (const auto& distance_m = range.working_distance_m) {
    const auto [nearest_m, farthest_m] = *distance_m;
    require(nearest_m < farthest_m && farthest_m <= range_m, "operating.working_distance_m",
            fmt::format("[{}, {}]", nearest_m, farthest_m),
            fmt::format("must be [nearest, farthest] with nearest < farthest <= the "
                        "unambiguous range, {:.6g} m",
                        range_m));
  }
  if (!range.depths) return;
  constexpr std::size_t max_parts = 10000;
  const std::vector<double>& weights = *range.depths;
  require(!weights.empty(), "operating.depths", "[]", "must list at least one weight");
  require(
      weights.size() <= max_parts, "operating.depths", fmt::format("{} weights", weights.size()),
      fmt::format("must be at most {}, one for each equal part of the working distance or range",
                  max_parts));
  require(*std::max_element(weights.begin(), weights.end()) > 0.0, "operating.depths",
          "weights that are all 0", "must have one > 0");
}

void validate_operating(const OperatingRange& range, double range_m,
                        double fundamental_frequency_hz) {
  require(!range.signal_e_per_s.empty(), "operating.signal_e_per_s", "[]",
          "must list at least one level");
  require(!range.ambient_e_per_s.empty(), "operating.ambient_e_per_s", "[]",
          "must list at least one level");
  if (range.multipath) range.multipath->validate(range_m);
  if (range.interference) range.interference->validate(fundamental_frequency_hz);
  validate_depths(range, range_m);
}

Eigen::VectorXcd arm_transfer(const ImpulseResponse& response, double edge_jitter_s,
                              double fundamental_frequency_hz, int highest) {
  Eigen::VectorXcd transfer(highest + 1);
  for (int n = 0; n <= highest; ++n) {
    const double frequency_hz = n * fundamental_frequency_hz;
    transfer[n] = response.transfer(frequency_hz);
    if (edge_jitter_s == 0.0) continue;
    const double phase_rad = 2.0 * std::numbers::pi * frequency_hz * edge_jitter_s;
    transfer[n] *= std::exp(-0.5 * phase_rad * phase_rad);
  }
  return transfer;
}

}  // namespace

double OperatingMultipath::weighed(double single_return_error,
                                   double operating_multipath_error) const {
  return std::pow(single_return_error, 1.0 - weight) * std::pow(operating_multipath_error, weight);
}

void OperatingMultipath::validate(double range_m) const {
  check_ranges(*this, "operating.multipath.");
  const auto limits = [](const std::array<double, 2>& ends) {
    return fmt::format("[{}, {}]", ends[0], ends[1]);
  };
  require(ratio[1] >= ratio[0], "operating.multipath.ratio", limits(ratio),
          "must be [min, max] with min <= max");
  require(delay_m[1] >= delay_m[0] && delay_m[1] < range_m, "operating.multipath.delay_m",
          limits(delay_m),
          fmt::format("must be [shortest, longest] with shortest <= longest and below the "
                      "unambiguous range, {:.4g} m",
                      range_m));
}

void OperatingInterference::validate(double fundamental_frequency_hz) const {
  check_ranges(*this, "operating.interference.");
  require(code == "same" || is_family(code), "operating.interference.code", code,
          "must be \"same\" or the name of a family such as sinusoid-k4");
  constexpr double min_frequency_hz = 1e3;
  require(fundamental_frequency_hz + frequency_offset_hz >= min_frequency_hz,
          "operating.interference.frequency_offset_hz", frequency_offset_hz,
          fmt::format("must be >= {:.6g} Hz, so that the fundamental frequency of the other "
                      "cameras is at least 1 kHz",
                      min_frequency_hz - fundamental_frequency_hz));
}

std::vector<OperatingPoint> OperatingRange::points() const {
  std::vector<OperatingPoint> all;
  for (const double s : signal_e_per_s)
    for (const double a : ambient_e_per_s) all.push_back({s, a});
  return all;
}

OperatingPoint OperatingRange::middle() const {
  return {signal_e_per_s.at(signal_e_per_s.size() / 2),
          ambient_e_per_s.at(ambient_e_per_s.size() / 2)};
}

double ExposureTime::of(int exposure, int exposures) const {
  return each_s.empty() ? total_s / exposures : each_s.at(static_cast<std::size_t>(exposure));
}

double ExposureTime::sum_s() const {
  return each_s.empty() ? total_s : std::accumulate(each_s.begin(), each_s.end(), 0.0);
}

std::vector<double> exposure_times_s(const CodeSet& code, const Camera& camera) {
  require(other_exposures_listed(camera, code.exposures(), " of code " + code.name()));
  if (!camera.exposure_s.each_s.empty()) return camera.exposure_s.each_s;
  const double total_s = camera.exposure_s.total_s;
  std::vector<double> times_s;
  for (const double share : code.exposure_shares()) times_s.push_back(total_s * share);
  if (times_s.empty())
    times_s.assign(static_cast<std::size_t>(code.exposures()), total_s / code.exposures());
  return in_camera_order(std::move(times_s), camera);
}

Camera timed_by(const CodeSet& code, Camera camera) {
  if (!code.exposure_shares().empty()) camera.exposure_s.each_s = exposure_times_s(code, camera);
  return camera;
}

double Camera::range_m() const { return unambiguous_range_m(fundamental_frequency_hz); }
double Camera::bin_m() const { return range_m() / samples; }

bool Camera::light_is_band_limited() const {
  return light.impulse_response.kind != ImpulseResponse::Kind::none || light.edge_jitter_s > 0.0;
}

bool Camera::band_limited() const {
  return light_is_band_limited() || sensor.impulse_response.kind != ImpulseResponse::Kind::none ||
         sensor.edge_jitter_s > 0.0;
}

Eigen::VectorXcd Camera::transfer(int highest) const {
  Eigen::VectorXcd of_sensor = sensor_transfer(highest);
  if (sensor.readout == Readout::rows) of_sensor = of_sensor.conjugate().eval();
  return of_sensor.cwiseProduct(light_transfer(highest).conjugate());
}

Eigen::VectorXcd Camera::light_transfer(int highest) const {
  return arm_transfer(light.impulse_response, light.edge_jitter_s, fundamental_frequency_hz,
                      highest);
}

Eigen::VectorXcd Camera::sensor_transfer(int highest) const {
  return arm_transfer(sensor.impulse_response, sensor.edge_jitter_s, fundamental_frequency_hz,
                      highest);
}

void Playback::validate(int taps) const {
  check_ranges(*this, "playback.");
  require(!inverted || taps <= 2, "playback.inverted", "true",
          "is only valid with one or two taps");
  std::vector<int> sorted = order;
  std::sort(sorted.begin(), sorted.end());
  for (std::size_t e = 0; e < sorted.size(); ++e)
    require(sorted[e] == static_cast<int>(e), "playback.order",
            fmt::format("{}", fmt::join(order, ", ")),
            "must list each of 0, 1, ... once: the code's exposures in the order in which the "
            "camera captures them");
  const int given =
      (offset_m != 0.0 || !offsets_m.empty()) + !offset_rad.empty() + !offset_counts.empty();
  require(given <= 1, "playback.offset_m", fmt::format("{} kinds of offset", given),
          "must be the only one of offset_m, offset_rad and offset_counts");
}

double Temperature::offset_m() const {
  const double of_sensor_m = sensor ? sensor->offset_m_per_c * sensor->above_reference_c() : 0.0;
  return offset_m_per_c * above_reference_c() + of_sensor_m;
}

double Temperature::signal_gain() const {
  const double of_sensor = sensor ? sensor->signal_per_c * sensor->above_reference_c() : 0.0;
  return std::exp(signal_per_c * above_reference_c() + of_sensor);
}

namespace {

void check_signal_gain(const std::string& prefix, const auto& temperature) {
  const double gain = std::exp(temperature.signal_per_c * temperature.above_reference_c());
  constexpr double max_gain = 1e3;
  require(gain <= max_gain && gain >= 1.0 / max_gain, prefix + "signal_per_c",
          temperature.signal_per_c,
          fmt::format("gives {:.3g} times the signal at the reference temperature, {} degrees "
                      "away; expected a factor from 0.001 to 1000",
                      gain, temperature.above_reference_c()));
}

}  // namespace

void Temperature::validate() const {
  check_ranges(*this, "temperature.");
  check_signal_gain("temperature.", *this);
  if (sensor) check_signal_gain("temperature.sensor.", *sensor);
}

void Camera::validate() const {
  check_ranges(*this);
  light.impulse_response.validate("light.impulse_response");
  validate_sensor(sensor);
  raw.validate();
  if (light.generator) light.generator->validate("light.generator", fundamental_frequency_hz);
  if (light.square) light.square->validate();
  if (sensor.generator) sensor.generator->validate("sensor.generator", fundamental_frequency_hz);
  if (lens && !lens->rays.empty()) {
    require(*lens == Lens{.rays = lens->rays}, "lens.rays", lens->rays,
            "must not be given together with keys of a pinhole, which it replaces");
  } else if (lens) {
    if (lens->distortion) lens->distortion->validate("lens.distortion");
    require(lens->width_px.has_value() == lens->height_px.has_value(), "lens.width_px",
            lens->width_px ? fmt::format("{}", *lens->width_px) : "none",
            "requires lens.height_px: set both or neither");
  }
  if (blur) blur->validate();
  if (optics) optics->validate();
  validate_operating(operating, range_m(), fundamental_frequency_hz);
  if (playback) playback->validate(sensor.taps);
  if (temperature) temperature->validate();
  if (sensor.readout != Readout::rows) return;
  constexpr int max_time_bins = 4096;
  require(samples <= max_time_bins, "samples", samples,
          fmt::format("must be <= {} with sensor.readout = \"rows\"", max_time_bins));
  require(!playback || !(playback->inverted || playback->reversed), "playback",
          playback && playback->inverted ? "inverted" : "reversed",
          "cannot be combined with sensor.readout = \"rows\"");
}

namespace {

/// Error if the gains of the taps do not sum to 1 without a drain.
std::optional<BrokenRule> unfilled_taps(const CodeSet& code, const std::string& what) {
  const Eigen::MatrixXd gain = code.demodulation_samples();
  for (int first = 0; first < code.measurements(); first += code.taps()) {
    const double least = gain.middleCols(first, code.taps()).rowwise().sum().minCoeff();
    if (!(least > 1.0 - 1e-6))
      return broken(fmt::format("{} sum over the taps of exposure {}", what, first / code.taps()),
                    least, "must be 1 on a camera with sensor.drain = false");
  }
  return std::nullopt;
}

/// Error unless a list has one value per exposure or per frequency.
std::optional<BrokenRule> list_misfit(const std::string& key, const std::vector<double>& list,
                                      const CodeSet& code) {
  const std::size_t count = list.size(), frequencies = code.frequency_starts().size();
  if (count == 0 || count == frequencies || count == static_cast<std::size_t>(code.exposures()))
    return std::nullopt;
  return broken("number of " + key, count,
                fmt::format("must equal the {} exposures or the {} frequencies of code {}",
                            code.exposures(), frequencies, code.name()));
}

std::vector<double> per_exposure(const std::string& key, const std::vector<double>& list,
                                 const CodeSet& code) {
  require(list_misfit(key, list, code));
  if (list.size() == static_cast<std::size_t>(code.exposures())) return list;
  std::vector<double> values(static_cast<std::size_t>(code.exposures()), 0.0);
  const std::vector<int> starts = code.frequency_starts();
  for (std::size_t f = 0; f < starts.size(); ++f)
    std::fill(values.begin() + starts[f], values.end(), list[f]);
  return values;
}

struct NamedList {
  const char* key;
  const std::vector<double>& values;
};

std::optional<BrokenRule> lists_misfit(const CodeSet& code, const Camera& camera) {
  const Playback playback = camera.playback.value_or(Playback());
  for (const auto& [key, values] :
       {NamedList{"sensor.modulation_contrast", camera.sensor.modulation_contrasts},
        {"playback.offset_m", playback.offsets_m},
        {"playback.offset_rad", playback.offset_rad},
        {"playback.offset_counts", playback.offset_counts}})
    if (auto misfit = list_misfit(key, values, code)) return misfit;
  return std::nullopt;
}

std::optional<BrokenRule> what_does_not_fit(const CodeSet& code, const Camera& camera) {
  const std::string what = "code " + code.name();
  const bool is_of_rows = camera.sensor.readout == Readout::rows;
  if (code.is_rows() && !is_of_rows)
    return broken(what + " receiver", "rows of one exposure",
                  "requires a camera with sensor.readout = \"rows\"");
  if (!code.is_rows() && is_of_rows)
    return broken(
        what + " receiver", "taps of exposures",
        "is not supported with sensor.readout = \"rows\", which requires rows of one exposure");
  if (code.is_signed() && !camera.sensor.is_signed())
    return broken(what + " receiver", "a mixer",
                  "requires a camera with sensor.demodulation = \"signed\"");
  if (!code.is_signed() && camera.sensor.is_signed() && !code.is_rows())
    return broken(what + " receiver", "taps with gains in [0, 1]",
                  "is not supported with sensor.demodulation = \"signed\", which requires weights "
                  "in [-1, 1]: use a family or a file of signed demodulations");
  if (!is_of_rows && code.taps() != camera.sensor.taps)
    return broken(what + " taps", code.taps(),
                  fmt::format("must equal the camera's sensor.taps = {}", camera.sensor.taps));
  if (code.samples() != camera.samples)
    return broken(what + " samples", code.samples(),
                  fmt::format("must equal the camera's samples = {}; set samples={} in the camera",
                              camera.samples, code.samples()));
  if (!(code.peak() <= camera.light.peak_factor * (1 + 1e-9)))
    return broken(
        what + " peak", code.peak(),
        fmt::format("must be <= the camera's light.peak_factor = {}", camera.light.peak_factor));
  if (!camera.sensor.drain)
    if (auto unfilled = unfilled_taps(code, what)) return unfilled;
  if (auto misfit = lists_misfit(code, camera)) return misfit;
  if (auto others = other_exposures_listed(camera, code.exposures(), " of " + what)) return others;
  return pulse_not_generated(code, camera);
}

}  // namespace

std::vector<double> Sensor::contrasts_of(const CodeSet& code) const {
  if (modulation_contrasts.empty())
    return std::vector<double>(static_cast<std::size_t>(code.exposures()), modulation_contrast);
  return per_exposure("sensor.modulation_contrast", modulation_contrasts, code);
}

std::vector<double> Playback::offsets_of(const CodeSet& code, double range_m) const {
  if (!offsets_m.empty()) return per_exposure("playback.offset_m", offsets_m, code);
  const bool in_counts = offset_rad.empty();
  if (in_counts && offset_counts.empty())
    return std::vector<double>(static_cast<std::size_t>(code.exposures()), offset_m);
  const double period = in_counts ? counts_per_period : 2 * std::numbers::pi;
  std::vector<double> offsets = in_counts
                                    ? per_exposure("playback.offset_counts", offset_counts, code)
                                    : per_exposure("playback.offset_rad", offset_rad, code);
  for (int e = 0; e < code.exposures(); ++e)
    offsets[static_cast<std::size_t>(e)] *= range_m / (period * code.modulation(e).repetitions());
  return offsets;
}

std::optional<std::string> why_not_playable(const CodeSet& code, const Camera& camera) {
  return text_of(what_does_not_fit(code, camera));
}

void require_fits(const CodeSet& code, const Camera& camera) {
  require(what_does_not_fit(code, camera));
}

namespace {

FamilyOptions family_options(const Camera& camera) {
  return {.samples = camera.samples,
          .peak_factor = camera.light.peak_factor,
          .taps = camera.sensor.taps > 2 ? camera.sensor.taps : 1};
}

/// Returns a text unless code and camera both use rows, or neither does.
std::optional<std::string> why_other_receiver(const CodeSet& code, const Camera& camera) {
  if (camera.sensor.readout == Readout::rows) return why_no_rows(code);
  if (!code.is_rows()) return std::nullopt;
  return what_does_not_fit(code, camera)->text();
}

}  // namespace

std::optional<std::string> why_no_family(std::string_view name, const Camera& camera) {
  if (auto none = why_no_family(name, family_options(camera))) return none;
  const CodeSet code = make_family(name, family_options(camera));
  if (auto other = why_other_receiver(code, camera)) return other;
  if (camera.sensor.readout == Readout::rows) return why_not_playable(rows_of(code), camera);
  return std::nullopt;
}

CodeSet build_family(std::string_view name, const Camera& camera) {
  CodeSet code = make_family(name, family_options(camera));
  if (camera.sensor.readout == Readout::rows) code = rows_of(code);
  if (code.is_rows()) require_fits(code, camera);
  if (camera.sensor.is_signed()) code = code.with_signed_weights();
  if (camera.sensor.taps == 2) code = code.with_two_buckets();
  code.provenance.camera = camera.name;
  return code;
}

OperatingRange paper_operating_range() {
  OperatingRange range;
  range.signal_e_per_s = {1e3, 3162.2776601683795, 1e4, 31622.776601683792, 1e5};
  range.ambient_e_per_s = {1e2, 1e3, 1e4, 31622.776601683792, 1e5};
  range.error = DepthErrorKind::linear;
  return range;
}

OperatingRange default_operating_range() {
  OperatingRange range = paper_operating_range();
  range.error = DepthErrorKind::circular;
  return range;
}

}  // namespace tofsmith
