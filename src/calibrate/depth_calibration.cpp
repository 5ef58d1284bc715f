// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>

#include "calibrate/depth_term_choice.hpp"
#include "calibrate/frequency_calibration.hpp"
#include "calibrate/harmonic_fit.hpp"
#include "tofsmith/camera/forward_model.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/core/parallel.hpp"
#include "tofsmith/core/statistics.hpp"
#include "tofsmith/decode/decoder.hpp"
#include "tofsmith/io/camera_toml.hpp"
#include "tofsmith/simulate/scene_result.hpp"

namespace tofsmith {

namespace {

constexpr int range_parts = 128;

MeasuredTable nominal_table(const ForwardModel& model, const CodeSet& code, const Camera& camera) {
  MeasuredTable table;
  table.differences = camera.sensor.subtracts();
  table.taps = table.differences ? 1 : code.taps();
  table.correlation = model.correlation_table(code.samples());
  table.ambient_gain = model.ambient_gain();
  return table;
}

DepthFit start(std::vector<ReferenceSample> samples, int height, int width, double range_m) {
  DepthFit fit{.samples = std::move(samples), .range_m = range_m, .height = height, .width = width};
  std::complex<double> sum = 0.0;
  for (const ReferenceSample& s : fit.samples)
    sum += std::polar(1.0, turn * (s.depth_m - s.reference_m) / range_m);
  fit.start_m = std::arg(sum) / turn * range_m;
  const auto signal = each(fit.samples, [](const auto& s) { return s.signal_e_per_s; });
  fit.signal_e_per_s = std::max(1e-30, quantile_of(signal, 0.5));
  fit.min_signal_e_per_s = std::max(1e-3 * fit.signal_e_per_s, quantile_of(signal, 0.01));
  fit.max_signal_e_per_s = std::max(fit.min_signal_e_per_s, quantile_of(signal, 0.99));
  const double usual_m = std::max(
      1e-12, quantile_of(each(fit.samples, [](const auto& s) { return s.deviation_m; }), 0.5));
  fit.error_m.resize(fit.size());
  fit.base.resize(fit.size());
  for (Eigen::Index i = 0; i < fit.size(); ++i) {
    const ReferenceSample& s = fit.samples[static_cast<std::size_t>(i)];
    fit.error_m[i] = wrapped_difference_m(s.depth_m - s.reference_m - fit.start_m, range_m);
    fit.base[i] = 2.0 / (1.0 + std::pow(s.deviation_m / usual_m, 2));
  }
  fit.weight = fit.base;
  return fit;
}

/// Terms at the phase predicted from the reference and the current errors.
void fill_terms(const Eigen::VectorXd& predicted_m, DepthFit& fit) {
  fit.terms.resize(error_terms, fit.size());
  const auto place = [](int at, int n) { return n > 1 ? 2.0 * at / (n - 1) - 1.0 : 0.0; };
  parallel_for_blocks(fit.size(), 8192, [&](IndexRange range) {
    for (Eigen::Index i = range.begin; i < range.end; ++i) {
      const ReferenceSample& s = fit.samples[static_cast<std::size_t>(i)];
      const double signal =
          std::clamp(s.signal_e_per_s, fit.min_signal_e_per_s, fit.max_signal_e_per_s);
      fill_error_terms(turn * (s.reference_m + fit.start_m + predicted_m[i]) / fit.range_m,
                       place(s.row, fit.height), place(s.column, fit.width),
                       std::log(signal / fit.signal_e_per_s), fit.terms.col(i).data());
    }
  });
}

Eigen::VectorXd predicted(const DepthFit& fit, const std::vector<int>& columns,
                          const Eigen::VectorXd& coefficient) {
  Eigen::VectorXd all = Eigen::VectorXd::Zero(error_terms);
  all(columns) = coefficient;
  return fit.terms.transpose() * all;
}

constexpr double biweight_reach = 4.685;  // standard deviations; 95 % efficiency for normal errors

/// Tukey's biweight.
void weigh(const Eigen::VectorXd& residual_m, DepthFit& fit) {
  std::vector<double> size_m(static_cast<std::size_t>(residual_m.size()));
  for (Eigen::Index i = 0; i < residual_m.size(); ++i)
    size_m[static_cast<std::size_t>(i)] = std::abs(residual_m[i]) * std::sqrt(fit.base[i]);
  fit.scale_m = std::max(1e-9 * fit.range_m, 1.4826 * quantile_of(std::move(size_m), 0.5));
  for (Eigen::Index i = 0; i < residual_m.size(); ++i) {
    const double u = residual_m[i] * std::sqrt(fit.base[i]) / (biweight_reach * fit.scale_m);
    fit.weight[i] = std::abs(u) < 1.0 ? fit.base[i] * std::pow(1.0 - u * u, 2) : 0.0;
  }
}

/// Iteratively reweighted least squares, which updates the predicted phase.
Eigen::VectorXd solve_robustly(const std::vector<int>& columns, int rounds, DepthFit& fit) {
  const std::vector<int> one_cell(fit.samples.size(), 0);
  Eigen::VectorXd coefficient, fitted_m;
  for (int round = 0; round < rounds; ++round) {
    coefficient = sums_of(fit.terms, fit.error_m, fit.weight, one_cell, 1).front().solve(columns);
    fitted_m = predicted(fit, columns, coefficient);
    weigh(fit.error_m - fitted_m, fit);
    // Coefficients of the last round belong to its terms.
    if (round + 1 < rounds && round % 2 == 1) fill_terms(fitted_m, fit);
  }
  return coefficient;
}

int part_of(double depth_m, double range_m) {
  const double share = depth_m / range_m - std::floor(depth_m / range_m);
  return std::min(range_parts - 1, static_cast<int>(share * range_parts));
}

/// Mean of the nominal depth error and rms deviation from it, without outliers [m].
struct DepthError {
  double mean_m = 0.0, rms_m = 0.0;
};

DepthError error_of(DepthFit& fit) {
  weigh(fit.error_m, fit);
  const double weights = fit.weight.sum();
  return {wrapped_difference_m(fit.start_m + fit.weight.dot(fit.error_m) / weights, fit.range_m),
          std::sqrt(fit.weight.dot(fit.error_m.cwiseAbs2()) / weights)};
}

std::vector<bool> parts_with_depths(const DepthFit& fit) {
  std::array<int, range_parts> count{};
  int all = 0;
  for (Eigen::Index i = 0; i < fit.size(); ++i)
    if (fit.weight[i] > 0.0)
      ++count[static_cast<std::size_t>(
          part_of(fit.samples[static_cast<std::size_t>(i)].depth_m, fit.range_m))],
          ++all;
  const int needed = std::max(3, static_cast<int>(0.02 * all / range_parts));
  std::vector<bool> has;
  for (const int c : count) has.push_back(c >= needed);
  return has;
}

/// 1 for known parts of the range, including gaps shorter than the highest harmonic resolves; else
/// 0.
Eigen::VectorXd known_share_of(std::vector<bool> has, int highest_harmonic) {
  const int reach = range_parts / (2 * std::max(1, highest_harmonic) + 1);
  Eigen::VectorXd share(range_parts);
  for (int p = 0; p < range_parts; ++p) {
    int back = 0, ahead = 0;
    const auto at = [&](int q) {
      return static_cast<bool>(has[static_cast<std::size_t>((q + range_parts) % range_parts)]);
    };
    while (back < reach && !at(p - back)) ++back;
    while (ahead < reach && !at(p + ahead)) ++ahead;
    share[p] = at(p) || back + ahead <= reach ? 1.0 : 0.0;
  }
  return share;
}

/// Assigns samples to square tiles of at most 16 pixels, narrower if there would be fewer than 200.
std::vector<int> tiles_of(const DepthFit& fit, int& tiles) {
  constexpr int enough = 200;
  int side = 16;
  const auto along = [&](int length) { return (length + side - 1) / side; };
  while (side > 1 && along(fit.height) * along(fit.width) < enough) side /= 2;
  tiles = along(fit.height) * along(fit.width);
  std::vector<int> tile;
  for (const ReferenceSample& s : fit.samples)
    tile.push_back(s.row / side * along(fit.width) + s.column / side);
  return tile;
}

/// Degree of the field that the positions of the samples determine.
int degree_within(const DepthFit& fit, std::vector<std::string>& notes) {
  const auto [top, bottom] =
      std::ranges::minmax(each(fit.samples, [](const auto& s) { return double(s.row); }));
  const auto [left, right] =
      std::ranges::minmax(each(fit.samples, [](const auto& s) { return double(s.column); }));
  const double share =
      std::min((bottom - top + 1.0) / fit.height, (right - left + 1.0) / fit.width);
  if (share > 0.7) return max_error_degree;
  notes.push_back(
      fmt::format("the reference spans {:.0f} % of the image's rows or columns, so the error field "
                  "over rows and columns is extrapolated as {}",
                  100.0 * share, share > 0.3 ? "a plane" : "constant"));
  return share > 0.3 ? 1 : 0;
}

Eigen::VectorXd standard_errors(const DepthFit& fit, const std::vector<int>& columns,
                                const Eigen::VectorXd& residual_m) {
  Eigen::VectorXd slope(fit.size()), influence(fit.size());
  for (Eigen::Index i = 0; i < fit.size(); ++i) {
    const double u = residual_m[i] * std::sqrt(fit.base[i]) / (biweight_reach * fit.scale_m);
    const bool counts = std::abs(u) < 1.0;
    slope[i] = counts ? fit.base[i] * (1.0 - u * u) * (1.0 - 5.0 * u * u) : 0.0;
    influence[i] = fit.weight[i] * residual_m[i];
  }
  int tiles = 0;
  const std::vector<int> tile = tiles_of(fit, tiles);
  return tile_errors(fit.terms, columns, slope, influence, tile, tiles);
}

/// Smallest model error [%] with which at most 1 % of the pixels with correct depth are
/// inconsistent. None if the code has no degrees of freedom.
std::optional<double> model_error_percent(const RawFrames& frames, const DepthFit& fit,
                                          const DecodingTable& table, const Progress& progress) {
  RawFrames raw{.frames = 1, .height = 1, .measurements = frames.measurements};
  for (Eigen::Index i = 0; i < fit.size(); ++i) {
    const ReferenceSample& s = fit.samples[static_cast<std::size_t>(i)];
    if (!(fit.weight[i] > 0.0)) continue;
    const float* const pixel =
        frames.frame(s.frame) +
        (std::ptrdiff_t{s.row} * frames.width + s.column) * frames.measurements;
    raw.values.insert(raw.values.end(), pixel, pixel + frames.measurements);
    ++raw.width;
  }
  std::vector<PixelStatus> status(static_cast<std::size_t>(raw.width));
  std::vector<float> residual(status.size());
  double steps_done = 0.0;
  const auto is_enough = [&](double percent) {
    constexpr double allowed_share = 0.01, steps = 8.0;
    report(progress, steps_done++ / steps, "estimating the model error");
    Decoder(table, {.model_error_percent = percent})
        .decode(view_of_frame(raw, 0), {.status = status.data(), .residual = residual.data()});
    const auto inconsistent = std::ranges::count(status, PixelStatus::inconsistent);
    const auto weak = std::ranges::count(status, PixelStatus::low_signal);
    return static_cast<double>(inconsistent) <=
           allowed_share * static_cast<double>(raw.width - weak);
  };
  const bool no_error_is_enough = is_enough(0.0);
  if (std::ranges::none_of(residual, [](float r) { return std::isfinite(r); })) return {};
  if (no_error_is_enough) return 0.0;
  // Bisection in steps of 20 %, from 0.05 % to 100 %.
  int too_small = -1, enough = 42;
  const auto percent_of = [](int step) { return std::min(100.0, 0.05 * std::pow(1.2, step)); };
  while (enough - too_small > 1) {
    const int middle = (enough + too_small) / 2;
    (is_enough(percent_of(middle)) ? enough : too_small) = middle;
  }
  return percent_of(enough);
}

void turn_backwards(MeasuredTable& table, std::vector<ReferenceSample>& samples, double range_m) {
  const Eigen::Index n = table.correlation.rows();
  table.correlation.bottomRows(n - 1) =
      table.correlation.bottomRows(n - 1).colwise().reverse().eval();
  for (ReferenceSample& s : samples) s.depth_m = range_m - s.depth_m;
}

void add_notes(const DepthFit& fit, const ReferenceDepth& reference,
               const Eigen::VectorXd& fitted_m, double covered, const Chosen& chosen,
               CalibratedDepth& result) {
  if (result.reversed) result.notes.push_back("delay is reversed, also in the table");
  const auto [nearest, farthest] =
      std::ranges::minmax(each(fit.samples, [](const auto& s) { return s.reference_m; }));
  if (covered > 0.1 && farthest - nearest < 1e-3 * fit.range_m)
    result.notes.push_back(
        fmt::format("the reference is {:.4g} m everywhere, but depths spread over {:.0f} % of the "
                    "range; check that it shows this scene. One number per frame is interpreted as "
                    "the distance of a flat target",
                    nearest, 100.0 * covered));
  constexpr double usual_share = 0.03;
  if (result.rms_before_m > usual_share * fit.range_m)
    result.notes.push_back(
        fmt::format("depth is off by {:.2g} % of the range (rms, around its mean), more than usual "
                    "wiggling; check frequency, code and order of exposures",
                    100.0 * result.rms_before_m / fit.range_m));
  const auto reference_m = each(fit.samples, [](const auto& s) { return s.reference_m; });
  if (covered < 0.05 &&
      quantile_of(reference_m, 0.95) - quantile_of(reference_m, 0.05) > 0.05 * fit.range_m)
    result.notes.push_back(
        "the decoded depth hardly changes with the reference; check code and order of exposures. "
        "Only an offset and a field over the image were fitted");
  else if (covered < 0.05)
    result.notes.push_back(
        "the reference hardly changes; only an offset and a field over the image were fitted, at "
        "this distance");
  else if (result.known_share < 0.999)
    result.notes.push_back(
        fmt::format("the reference covers {:.0f} % of the range; elsewhere the correction is "
                    "extrapolated by a model of {} terms",
                    100.0 * result.known_share, result.far_terms.size()));
  if (!result.rms_m)
    result.notes.push_back(
        "too few pixels have weight for cross-validation; only the smallest set of terms was used, "
        "and the remaining error is unknown");
  if (result.far_rms_m && result.known_share < 0.999 && chosen.skipped_parts > 0)
    result.notes.push_back(
        fmt::format("{} of the 4 quarters of the reference's range contain no depths to hold out; "
                    "terms for extrapolation were selected with the other quarters",
                    chosen.skipped_parts));
  if (result.outlier_share > 0.3)
    result.notes.push_back(
        fmt::format("{:.0f} % of the pixels do not fit the model and were excluded",
                    100.0 * result.outlier_share));
  std::vector<double> expected_m;
  for (Eigen::Index i = 0; i < fit.size(); ++i)
    expected_m.push_back(fit.samples[static_cast<std::size_t>(i)].depth_m - fit.start_m -
                         fitted_m[i]);
  constexpr double usual_percent = 10.0;
  if (!result.model_error_percent)
    result.notes.push_back(
        "the model error is unknown, because the code has no degrees of freedom beyond depth, "
        "signal and ambient light");
  else if (*result.model_error_percent > usual_percent)
    result.notes.push_back(
        fmt::format("no depth explains the measurements to better than {:.0f} % of the signal; "
                    "check code, order of exposures and the camera's noise",
                    *result.model_error_percent));
  if (auto note = shift_note(fit.samples, reference, expected_m, fit.range_m, fit.scale_m))
    result.notes.push_back(*note);
}

/// z-depth to depth along the camera's rays. Other image sizes are rejected later.
ReferenceDepth along_rays(ReferenceDepth z, const Camera& camera, int height, int width) {
  require(camera.lens.has_value(), "lens", "none",
          "is required to convert a reference along the axis to distances along the rays");
  const PixelRays rays = rays_of(camera.lens, view_of(camera.lens, width, height));
  for (Image<float>& depth_m : z.depth_m) {
    if (depth_m.size() == 1) depth_m = Image<float>(height, width, depth_m.pixels.front());
    if (depth_m.height == height && depth_m.width == width) depth_m = radial_from_z(depth_m, rays);
  }
  z.is_z = false;
  return z;
}

struct CellMeans {
  explicit CellMeans(std::size_t cells) : sum(cells), weight(cells) {}

  void add(std::size_t cell, double value, double w) {
    sum[cell] += w * value;
    weight[cell] += w;
  }
  double of(std::size_t cell) const { return sum[cell] / weight[cell]; }  // NaN for empty cells

  std::vector<double> sum, weight;
};

/// Returns the errors and residuals of a fit.
/// @param offset_m  mean error, subtracted as well
/// @param fitted_m  fitted error of every sample
DepthErrorPicture picture_of(const DepthFit& fit, const Eigen::VectorXd& fitted_m,
                             double offset_m) {
  constexpr std::size_t parts = 128;
  constexpr int cells_along = 160;
  const int side = std::max(1, (std::max(fit.height, fit.width) + cells_along - 1) / cells_along);
  const int rows = (fit.height + side - 1) / side, columns = (fit.width + side - 1) / side;
  CellMeans part_before(parts), part_after(parts);
  CellMeans cell_before(static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns)),
      cell_after = cell_before;
  for (Eigen::Index i = 0; i < fit.size(); ++i) {
    const ReferenceSample& s = fit.samples[static_cast<std::size_t>(i)];
    const double before_m = fit.error_m[i] - offset_m, after_m = fit.error_m[i] - fitted_m[i];
    const double share = s.depth_m / fit.range_m - std::floor(s.depth_m / fit.range_m);
    const auto part = std::min(parts - 1, static_cast<std::size_t>(share * parts));
    const auto cell = static_cast<std::size_t>(s.row / side) * static_cast<std::size_t>(columns) +
                      static_cast<std::size_t>(s.column / side);
    part_before.add(part, before_m, fit.weight[i]);
    part_after.add(part, after_m, fit.weight[i]);
    cell_before.add(cell, before_m, fit.weight[i]);
    cell_after.add(cell, after_m, fit.weight[i]);
  }
  DepthErrorPicture picture{.before_image_m = Image<float>(rows, columns),
                            .after_image_m = Image<float>(rows, columns)};
  for (std::size_t p = 0; p < parts; ++p) {
    picture.depth_m.push_back(fit.range_m * (static_cast<double>(p) + 0.5) / parts);
    picture.before_m.push_back(part_before.of(p));
    picture.after_m.push_back(part_after.of(p));
  }
  for (std::size_t c = 0; c < picture.before_image_m.size(); ++c) {
    picture.before_image_m.pixels[c] = static_cast<float>(cell_before.of(c));
    picture.after_image_m.pixels[c] = static_cast<float>(cell_after.of(c));
  }
  return picture;
}

}  // namespace

CalibratedDepth calibrate_depth(const RawFrames& frames, const ReferenceDepth& reference,
                                const CodeSet& code, const Camera& camera,
                                const Progress& progress) {
  if (reference.is_z)
    return calibrate_depth(frames, along_rays(reference, camera, frames.height, frames.width), code,
                           camera, progress);
  require_same_size(frames, reference);
  CalibratedDepth result;
  const ForwardModel model(code, camera);
  result.table = nominal_table(model, code, camera);
  const double range_m = camera.range_m();
  const ProgressParts parts(progress, {3.0, 1.0, 1.0}), decoding(parts[0], 2);

  // Calibrate each frequency, after computing the uncalibrated error.
  std::optional<DepthError> nominal;
  if (auto by_frequency = calibrate_frequencies(frames, reference, code, camera)) {
    auto samples =
        decoded_samples(frames, reference, make_decoding_table(result.table, camera), decoding[0]);
    if (!samples.empty()) {
      DepthFit fit = start(std::move(samples), frames.height, frames.width, range_m);
      nominal = error_of(fit);
    }
    result.table.correlation = by_frequency->correlation;
    result.frequencies = std::move(by_frequency->frequencies);
    result.offsets_m = std::move(by_frequency->offsets_m);
    result.contrasts = std::move(by_frequency->contrasts);
    result.notes = std::move(by_frequency->notes);
    result.reversed = by_frequency->reversed;
  } else if (camera.playback && camera.playback->has_list()) {
    const std::vector<double> offsets_m = camera.playback->offsets_of(code, range_m);
    for (const int start : code.frequency_starts())
      result.offsets_m.push_back(offsets_m[static_cast<std::size_t>(start)]);
  }
  const DecodingTable table = make_decoding_table(result.table, camera);

  // Decode pixels that can be compared, and determine the direction of delay.
  std::vector<ReferenceSample> samples = reference_samples(
      frames, reference, table, result.frequencies.empty() ? parts[0] : decoding[1]);
  result.pixels = static_cast<std::int64_t>(samples.size());
  const bool turned = runs_backwards(samples, reference, frames.height, frames.width, range_m);
  if (turned) turn_backwards(result.table, samples, range_m);
  result.reversed = result.reversed != turned;

  // Fit all terms to identify outliers.
  DepthFit fit = start(std::move(samples), frames.height, frames.width, range_m);
  const DepthError error = error_of(fit);
  result.mean_error_m = nominal.value_or(error).mean_m;
  result.rms_before_m = nominal.value_or(error).rms_m;
  for (double& offset_m : result.offsets_m)
    offset_m = error.mean_m + (turned ? -offset_m : offset_m);
  std::vector<bool> has = parts_with_depths(fit);
  const auto covered_parts = static_cast<int>(std::ranges::count(has, true));
  const double covered = static_cast<double>(covered_parts) / range_parts;
  const int highest =
      covered < 0.05 ? 0 : std::clamp((covered_parts - 2) / 2, 1, max_error_harmonic);
  const TermChoice all{(1u << highest) - 1u, degree_within(fit, result.notes), max_error_signal};
  report(parts[1], 0.1, "fitting");
  fill_terms(Eigen::VectorXd::Zero(fit.size()), fit);
  solve_robustly(all.columns(), 10, fit);

  report(parts[1], 0.5, "selecting terms");
  const Chosen chosen = choose(fit, highest, all.degree, !result.frequencies.empty());
  const std::vector<int> far_columns = chosen.beyond.columns(), columns = chosen.known.columns();
  const Eigen::VectorXd far = solve_robustly(far_columns, 4, fit);
  const Eigen::VectorXd near = solve_robustly(columns, 6, fit);
  const Eigen::VectorXd fitted_m = predicted(fit, columns, near);
  const Eigen::VectorXd error_m = standard_errors(fit, columns, fit.error_m - fitted_m);

  DepthCorrection correction{.height = frames.height,
                             .width = frames.width,
                             .known = terms_of(chosen.known, near),
                             .beyond = terms_of(chosen.beyond, far),
                             .known_share = known_share_of(has, highest),
                             .signal_e_per_s = fit.signal_e_per_s,
                             .min_signal_e_per_s = fit.min_signal_e_per_s,
                             .max_signal_e_per_s = fit.max_signal_e_per_s};
  correction.known.offset_m += fit.start_m;
  correction.beyond.offset_m += fit.start_m;
  for (std::size_t k = 0; k < columns.size(); ++k)
    result.terms.push_back({error_term_name(columns[k]),
                            {near[static_cast<Eigen::Index>(k)] + (k == 0 ? fit.start_m : 0.0),
                             error_m[static_cast<Eigen::Index>(k)]}});
  for (const int column : far_columns) result.far_terms.push_back(error_term_name(column));
  result.known_share = correction.known_share.mean();
  result.rms_m = chosen.known_rms_m;
  result.far_rms_m = chosen.beyond_rms_m;
  result.skipped_folds = chosen.skipped_blocks + chosen.skipped_parts;
  result.outlier_share =
      static_cast<double>((fit.weight.array() == 0.0).count()) / static_cast<double>(fit.size());
  result.table.correction = correction;
  result.model_error_percent =
      model_error_percent(frames, fit, make_decoding_table(result.table, camera), parts[2]);
  result.table.model_error_percent = result.model_error_percent.value_or(0.0);
  result.picture =
      picture_of(fit, fitted_m, wrapped_difference_m(error.mean_m - fit.start_m, range_m));
  add_notes(fit, reference, fitted_m, covered, chosen, result);
  return result;
}

Camera with_depth(Camera camera, const CalibratedDepth& found) {
  Playback playback = camera.playback.value_or(Playback());
  const double known_m = found.reversed ? -playback.offset_m : playback.offset_m;
  playback.reversed = playback.reversed != found.reversed;
  playback.set_offsets_m(found.offsets_m);
  // The offset term is correlated with harmonics if only part of the range is known.
  if (found.offsets_m.empty()) playback.offset_m = found.mean_error_m + known_m;
  if (!found.contrasts.empty() && camera.sensor.mixes_taps())
    camera.sensor.modulation_contrasts = found.contrasts;
  camera.playback = playback;
  camera.validate();
  return camera;
}

}  // namespace tofsmith
