// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Format of atlas.txt: version; per code a line `code` with camera and errors; per exposure a line
// `light` and lines `gate` with switching times (rise, fall, ...) in 1/100000 of the period.
#include "tofsmith/design/design.hpp"

#include <fmt/format.h>

#include <Eigen/QR>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

#include "core/shared/text_numbers.hpp"
#include "design/atlas/atlas_data.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

Camera AtlasCamera::camera() const {
  Camera camera = built_in_camera("paper-30x");
  camera.name = "atlas";
  camera.light.peak_factor = peak_factor;
  camera.sensor.taps = taps;
  camera.operating.error = error;
  if (shortest_pulse_periods > 0.0)
    camera.sensor.shortest_pulse_s = shortest_pulse_periods / camera.fundamental_frequency_hz;
  if (bandwidth_f0 > 0.0) {
    ImpulseResponse response;
    response.kind = ImpulseResponse::Kind::hann;
    response.f_max_hz = bandwidth_f0 * camera.fundamental_frequency_hz;
    camera.light.impulse_response = camera.sensor.impulse_response = response;
  }
  return camera;
}

std::vector<AtlasEntry> best_by_exposures(const std::vector<AtlasEntry>& entries) {
  std::vector<AtlasEntry> best;
  for (const AtlasEntry& entry : entries) {
    const auto same = std::find_if(best.begin(), best.end(), [&](const AtlasEntry& other) {
      AtlasCamera its = other.of;
      its.exposures = entry.of.exposures;
      return its == entry.of;
    });
    if (same == best.end())
      best.push_back(entry);
    else if (entry.error_m().value < same->error_m().value)
      *same = entry;
  }
  return best;
}

std::optional<AtlasLaw> fit_atlas_law(const std::vector<AtlasEntry>& entries) {
  constexpr Eigen::Index unknowns = 3, min_entries = 2 * unknowns;
  std::vector<const AtlasEntry*> fitted;
  for (const AtlasEntry& entry : entries)
    if (entry.of.bandwidth_f0 > 0.0) fitted.push_back(&entry);
  if (std::ssize(fitted) < min_entries) return std::nullopt;
  Eigen::MatrixXd powers(std::ssize(fitted), unknowns);
  Eigen::VectorXd logs(std::ssize(fitted));
  for (Eigen::Index i = 0; i < logs.size(); ++i) {
    const AtlasEntry& entry = *fitted[static_cast<std::size_t>(i)];
    powers.row(i) << 1.0, -std::log(entry.of.bandwidth_f0), -std::log(entry.of.peak_factor);
    logs[i] = std::log(entry.error_m().value);
  }
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> least_squares(powers);
  if (least_squares.rank() < unknowns) return std::nullopt;
  const Eigen::VectorXd law = least_squares.solve(logs);
  const Eigen::ArrayXd residuals = (powers * law - logs).array();
  return AtlasLaw{.at_ones_m = std::exp(law[0]),
                  .bandwidth_power = law[1],
                  .peak_power = law[2],
                  .rms_residual = std::sqrt(residuals.square().mean()),
                  .max_residual = residuals.abs().maxCoeff(),
                  .entries = static_cast<int>(fitted.size())};
}

namespace {

constexpr double parts_per_period = 100'000.0;
constexpr std::string_view atlas_head = "tofsmith atlas ";

std::string short_number(double value) { return fmt::format("{:.6g}", value); }

std::string name_from(const AtlasCamera& of, std::string name, std::string_view bandwidth,
                      std::string_view pulse) {
  if (of.bandwidth_f0 > 0.0) name += fmt::format("-{}{}", bandwidth, short_number(of.bandwidth_f0));
  if (of.shortest_pulse_periods > 0.0)
    name += fmt::format("-{}{}", pulse, short_number(of.shortest_pulse_periods));
  return fmt::format("{}-{}", name, name_of(of.error));
}

std::string entry_name(const AtlasCamera& of) {
  return name_from(
      of, fmt::format("atlas-{}x{}-peak{}", of.exposures, of.taps, short_number(of.peak_factor)),
      "hann", "pulse");
}

/// Returns the name in tofsmith 0.1 before its release, which files of users may contain.
std::string former_name(const AtlasCamera& of) {
  return name_from(
      of, fmt::format("atlas-t{}-k{}-p{}", of.taps, of.exposures, short_number(of.peak_factor)),
      "b", "s");
}

class AtlasLines {
 public:
  AtlasLines(std::string_view text, std::string_view file) : rest_(text), file_(file) {}

  bool next() {
    do {
      ++number_;
      const std::size_t end = std::min(rest_.find('\n'), rest_.size());
      words_ = rest_.substr(0, end);
      if (rest_.empty()) return false;
      rest_.remove_prefix(std::min(end + 1, rest_.size()));
    } while (words_.empty() || words_.front() == '#');
    return true;
  }
  std::string_view rest_of_line() const { return words_; }
  bool at_end_of_line() const { return words_.empty(); }

  std::string_view word() {
    const std::size_t end = std::min(words_.find(' '), words_.size());
    const std::string_view word = words_.substr(0, end);
    words_.remove_prefix(std::min(end + 1, words_.size()));
    return word;
  }
  void expect(std::string_view expected) {
    const std::string_view found = word();
    if (found != expected) refuse(fmt::format("found \"{}\"; expected \"{}\"", found, expected));
  }
  double number(double min, double max) {
    const std::string_view found = word();
    const std::optional<double> value = number_in(found);
    if (!value || !(*value >= min && *value <= max))
      refuse(fmt::format("found \"{}\"; expected a number in [{}, {}]", found, min, max));
    return *value;
  }
  int whole(int min, int max) {
    const std::string_view found = word();
    const char* const end = found.data() + found.size();
    int value = 0;
    const auto [rest, error] = std::from_chars(found.data(), end, value);
    if (error != std::errc() || rest != end || value < min || value > max)
      refuse(fmt::format("found \"{}\"; expected a whole number in [{}, {}]", found, min, max));
    return value;
  }
  [[noreturn]] void refuse(std::string_view problem) const {
    throw IoError(fmt::format("{}:{}", file_, number_), problem);
  }

 private:
  std::string_view rest_, words_, file_;
  std::int64_t number_ = 0;
};

std::vector<OnInterval> read_intervals(AtlasLines& lines, std::string_view kind) {
  constexpr int period = static_cast<int>(parts_per_period);
  if (!lines.next()) lines.refuse(fmt::format("found the end; expected a line \"{}\"", kind));
  lines.expect(kind);
  std::vector<OnInterval> on;
  while (!lines.at_end_of_line()) {
    const int rise = lines.whole(0, period - 1);
    const int fall = lines.whole(rise + 1, rise + period);
    on.push_back({rise / parts_per_period, fall / parts_per_period});
  }
  return on;
}

/// The level is the smaller of 1 / duty and the peak.
Waveform read_light(AtlasLines& lines, double peak_factor) {
  std::vector<OnInterval> on = read_intervals(lines, "light");
  if (on.empty()) lines.refuse("found light that is never on; expected a pulse");
  const double duty = Waveform::binary(on).mean();
  return Waveform::binary(std::move(on), std::min(peak_factor, 1.0 / duty));
}

Waveform read_gate(AtlasLines& lines) {
  std::vector<OnInterval> on = read_intervals(lines, "gate");
  return on.empty() ? Waveform::constant(0.0) : Waveform::binary(std::move(on));
}

AtlasCamera read_camera(AtlasLines& lines) {
  AtlasCamera of;
  lines.expect("code");
  lines.expect("taps");
  of.taps = lines.whole(1, 16);
  lines.expect("exposures");
  of.exposures = lines.whole(1, 16);
  lines.expect("peak");
  of.peak_factor = lines.number(1.0, 1e6);
  lines.expect("bandwidth");
  of.bandwidth_f0 = lines.number(0.0, 1e6);
  lines.expect("shortest");
  of.shortest_pulse_periods = lines.number(0.0, 0.25);
  if (of.bandwidth_f0 == 0.0 && of.shortest_pulse_periods == 0.0)
    lines.refuse("found bandwidth 0 and shortest 0; expected one of them > 0");
  lines.expect("error");
  const std::string_view kind = lines.word();
  if (kind != "linear" && kind != "circular")
    lines.refuse(fmt::format("found \"{}\"; expected \"linear\" or \"circular\"", kind));
  of.error = kind == "linear" ? DepthErrorKind::linear : DepthErrorKind::circular;
  return of;
}

Estimate read_estimate(AtlasLines& lines, std::string_view kind) {
  lines.expect(kind);
  const double value = lines.number(0.0, 1e6), standard_error = lines.number(0.0, 1e6);
  return {value, standard_error};
}

AtlasEntry read_entry(AtlasLines& lines) {
  const AtlasCamera of = read_camera(lines);
  const Estimate linear_m = read_estimate(lines, "linear_m");
  const Estimate circular_m = read_estimate(lines, "circular_m");
  if (!lines.at_end_of_line())
    lines.refuse(fmt::format("found \"{}\"; expected the end of the line", lines.rest_of_line()));
  try {
    std::vector<Waveform> modulation, demodulation;
    for (int e = 0; e < of.exposures; ++e) {
      modulation.push_back(read_light(lines, of.peak_factor));
      for (int t = 0; t < of.taps; ++t) demodulation.push_back(read_gate(lines));
    }
    CodeSet code = CodeSet::create(entry_name(of), of.camera().samples, of.taps,
                                   std::move(modulation), std::move(demodulation));
    code.provenance = {.method = "atlas", .depth_error_m = 0.0};
    AtlasEntry entry{of, std::move(code), linear_m, circular_m};
    entry.code.provenance.depth_error_m = entry.error_m().value;
    return entry;
  } catch (const std::invalid_argument& error) {  // invalid intervals or overlapping taps
    lines.refuse(error.what());
  }
}

}  // namespace

std::vector<AtlasEntry> parse_atlas(std::string_view text, std::string_view file) {
  AtlasLines lines(text, file);
  if (!lines.next() || !lines.rest_of_line().starts_with(atlas_head))
    lines.refuse(fmt::format("found \"{}\"; expected \"{}{}\"", lines.rest_of_line().substr(0, 40),
                             atlas_head, atlas_version));
  if (const std::string_view version = lines.rest_of_line().substr(atlas_head.size());
      version != fmt::format("{}", atlas_version))
    lines.refuse(fmt::format(
        "found an atlas of version {}; expected version {}, as written by scripts/atlas.sh",
        version, atlas_version));
  std::vector<AtlasEntry> entries;
  while (lines.next()) {
    AtlasEntry entry = read_entry(lines);
    if (std::any_of(entries.begin(), entries.end(),
                    [&](const AtlasEntry& other) { return other.of == entry.of; }))
      lines.refuse(
          fmt::format("found {} a second time; expected each code once", entry.code.name()));
    entries.push_back(std::move(entry));
  }
  return entries;
}

const std::vector<AtlasEntry>& code_atlas() {
  static const std::vector<AtlasEntry> entries = parse_atlas(atlas_data, "the built-in atlas");
  return entries;
}

const AtlasEntry* find_atlas_entry(std::string_view code) {
  for (const AtlasEntry& entry : code_atlas())
    if (entry.code.name() == code || former_name(entry.of) == code) return &entry;
  return nullptr;
}

}  // namespace tofsmith
