// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <limits>

#include "calibrate/depth_error_fit.hpp"
#include "calibrate/harmonic_basis.hpp"
#include "calibrate/reference_samples.hpp"
#include "tofsmith/camera/forward_model.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/core/parallel.hpp"

namespace tofsmith {

namespace {

constexpr int range_parts = 128, slabs = 4, checkers = 2;

/// The functions that the camera's model says, in the table's own form.
MeasuredTable nominal_table(const ForwardModel& model, const CodeSet& code, const Camera& camera) {
  MeasuredTable table;
  table.differences = camera.sensor.readout == Readout::difference;
  table.taps = table.differences ? 1 : code.taps();
  table.correlation = model.correlation_table(code.samples());
  table.ambient_gain = model.ambient_gain();
  return table;
}

/// What is fitted: samples with the terms of each.
struct DepthFit {
  std::vector<ReferenceSample> samples;
  double range_m = 0.0;
  int height = 0, width = 0;
  double start_m = 0.0;  // offset ahead of the fit
  double signal_e_per_s = 1.0, min_signal_e_per_s = 0.0, max_signal_e_per_s = 0.0;
  Eigen::MatrixXd terms;    // (error_terms, samples)
  Eigen::VectorXd error_m;  // depth - reference - start
  Eigen::VectorXd base;     // weight by predicted noise
  Eigen::VectorXd weight;   // and by the residual
  double scale_m = 0.0;     // robust standard deviation of residuals

  Eigen::Index size() const { return static_cast<Eigen::Index>(samples.size()); }
};

double median_of(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double quantile_of(std::vector<double> values, double share) {
  const auto at =
      values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

template <typename Get>
std::vector<double> each(const std::vector<ReferenceSample>& samples, const Get& get) {
  std::vector<double> values;
  values.reserve(samples.size());
  for (const ReferenceSample& s : samples) values.push_back(get(s));
  return values;
}

DepthFit start(std::vector<ReferenceSample> samples, int height, int width, double range_m) {
  DepthFit fit{.samples = std::move(samples), .range_m = range_m, .height = height, .width = width};
  std::complex<double> sum = 0.0;
  for (const ReferenceSample& s : fit.samples)
    sum += std::polar(1.0, turn * (s.depth_m - s.reference_m) / range_m);
  fit.start_m = std::arg(sum) / turn * range_m;
  const auto signal = each(fit.samples, [](const auto& s) { return s.signal_e_per_s; });
  fit.signal_e_per_s = std::max(1e-30, median_of(signal));
  fit.min_signal_e_per_s = std::max(1e-3 * fit.signal_e_per_s, quantile_of(signal, 0.01));
  fit.max_signal_e_per_s = std::max(fit.min_signal_e_per_s, quantile_of(signal, 0.99));
  const double usual_m =
      std::max(1e-12, median_of(each(fit.samples, [](const auto& s) { return s.deviation_m; })));
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

/// Terms at the phase that the reference and the errors found so far predict.
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

constexpr double biweight_reach = 4.685;  // of standard deviations: 95 % as efficient as the mean

/// Weights by the residuals that coefficients leave: Tukey's biweight.
void weigh(const Eigen::VectorXd& residual_m, DepthFit& fit) {
  std::vector<double> size_m(static_cast<std::size_t>(residual_m.size()));
  for (Eigen::Index i = 0; i < residual_m.size(); ++i)
    size_m[static_cast<std::size_t>(i)] = std::abs(residual_m[i]) * std::sqrt(fit.base[i]);
  fit.scale_m = std::max(1e-9 * fit.range_m, 1.4826 * median_of(std::move(size_m)));
  for (Eigen::Index i = 0; i < residual_m.size(); ++i) {
    const double u = residual_m[i] * std::sqrt(fit.base[i]) / (biweight_reach * fit.scale_m);
    fit.weight[i] = std::abs(u) < 1.0 ? fit.base[i] * std::pow(1.0 - u * u, 2) : 0.0;
  }
}

/// Reweighted least squares over some columns, with the phase predicted anew.
Eigen::VectorXd solve_robustly(const std::vector<int>& columns, int rounds, DepthFit& fit) {
  const std::vector<int> one_cell(fit.samples.size(), 0);
  Eigen::VectorXd coefficient, fitted_m;
  for (int round = 0; round < rounds; ++round) {
    coefficient = sums_of(fit.terms, fit.error_m, fit.weight, one_cell, 1).front().solve(columns);
    fitted_m = predicted(fit, columns, coefficient);
    weigh(fit.error_m - fitted_m, fit);
    // Terms of the last round stay those that its coefficients belong to.
    if (round + 1 < rounds && round % 2 == 1) fill_terms(fitted_m, fit);
  }
  return coefficient;
}

int part_of(double depth_m, double range_m) {
  const double share = depth_m / range_m - std::floor(depth_m / range_m);
  return std::min(range_parts - 1, static_cast<int>(share * range_parts));
}

/// In which parts of the nominal range enough samples count.
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

/// Gaps that the highest harmonic spans belong to what is known.
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

struct Chosen {
  TermChoice known, beyond;
  double known_rms_m = 0.0, beyond_rms_m = 0.0;
};

/// Cells of held-out samples: the colour of a checkerboard of blocks, and a quarter of the range.
std::vector<int> cells_of(const DepthFit& fit) {
  const auto at_m = each(fit.samples, [](const auto& s) { return s.reference_m; });
  std::array<double, slabs - 1> border_m{};
  for (int q = 1; q < slabs; ++q)
    border_m[static_cast<std::size_t>(q - 1)] = quantile_of(at_m, static_cast<double>(q) / slabs);
  const int block_rows = std::max(1, fit.height / 8), block_columns = std::max(1, fit.width / 8);
  std::vector<int> cell;
  for (const ReferenceSample& s : fit.samples) {
    const int slab = static_cast<int>(
        std::ranges::count_if(border_m, [&](double border) { return s.reference_m > border; }));
    const int colour = (s.row / block_rows + s.column / block_columns + s.frame) % checkers;
    cell.push_back(slab * checkers + colour);
  }
  return cell;
}

/// rms that a choice leaves on folds of cells held out in turn.
double held_out_rms_m(const std::vector<NormalSums>& sums, const TermChoice& choice,
                      bool by_range) {
  const std::vector<int> columns = choice.columns();
  double left = 0.0, weight = 0.0;
  for (int fold = 0; fold < (by_range ? slabs : checkers); ++fold) {
    NormalSums kept, out;
    for (std::size_t c = 0; c < sums.size(); ++c) {
      const int its = static_cast<int>(c);
      (((by_range ? its / checkers : its % checkers) == fold) ? out : kept).add(sums[c]);
    }
    if (!(out.weight > 0.0) || !(kept.weight > 0.0)) continue;
    left += out.left(columns, kept.solve(columns));
    weight += out.weight;
  }
  return std::sqrt(left / std::max(1e-300, weight));
}

/// Sets of harmonics that errors of usual cameras have; of k equally spaced phases, k and 2 k.
std::vector<unsigned> harmonic_sets(int highest) {
  const auto set = [](std::initializer_list<int> list) {
    unsigned bits = 0;
    for (const int h : list) bits |= 1u << (h - 1);
    return bits;
  };
  std::vector<unsigned> sets;
  for (const unsigned bits :
       {0u, set({1}), set({2}), set({3}), set({4}), set({1, 2}), set({2, 4}), set({3, 6}),
        set({4, 8}), set({1, 2, 3}), set({1, 2, 4}), set({1, 2, 3, 4}), set({2, 4, 6, 8}),
        set({1, 2, 3, 4, 8}), set({1, 2, 3, 4, 5, 6}), set({1, 2, 3, 4, 5, 6, 7, 8})})
    if (bits < (1u << highest)) sets.push_back(bits);
  return sets;
}

Chosen choose(const DepthFit& fit, int highest_harmonic, int max_degree) {
  const std::vector<NormalSums> sums =
      sums_of(fit.terms, fit.error_m, fit.weight, cells_of(fit), slabs * checkers);
  struct Candidate {
    TermChoice choice;
    double near_m, far_m;
  };
  std::vector<Candidate> candidates;
  for (const unsigned harmonics : harmonic_sets(highest_harmonic))
    for (int degree = 0; degree <= max_degree; ++degree)
      for (int signal = 0; signal <= max_error_signal; ++signal) {
        const TermChoice choice{harmonics, degree, signal};
        candidates.push_back(
            {choice, held_out_rms_m(sums, choice, false), held_out_rms_m(sums, choice, true)});
      }
  const auto& near = *std::ranges::min_element(candidates, {}, &Candidate::near_m);
  const auto& far = *std::ranges::min_element(candidates, {}, &Candidate::far_m);
  // Terms in the signal only where they show; of the others the most that predict as well, since a
  // term left out shifts those beside it.
  constexpr double shows = 1.01, as_well = 1.005;
  int signal = near.choice.signal;
  for (const Candidate& c : candidates)
    if (c.near_m <= shows * near.near_m) signal = std::min(signal, c.choice.signal);
  double least_m = std::numeric_limits<double>::infinity();
  for (const Candidate& c : candidates)
    if (c.choice.signal == signal) least_m = std::min(least_m, c.near_m);
  const Candidate* best = nullptr;
  for (const Candidate& c : candidates)
    if (c.choice.signal == signal && c.near_m <= as_well * least_m &&
        (!best || c.choice.size() > best->choice.size()))
      best = &c;
  return {best->choice, far.choice, best->near_m, far.far_m};
}

/// Tiles of pixels, the same in every frame, at least some hundred.
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

/// Degree of a field that the places of the samples can carry.
int degree_within(const DepthFit& fit, std::vector<std::string>& notes) {
  const auto [top, bottom] =
      std::ranges::minmax(each(fit.samples, [](const auto& s) { return double(s.row); }));
  const auto [left, right] =
      std::ranges::minmax(each(fit.samples, [](const auto& s) { return double(s.column); }));
  const double share =
      std::min((bottom - top + 1.0) / fit.height, (right - left + 1.0) / fit.width);
  if (share > 0.7) return max_error_degree;
  notes.push_back(fmt::format(
      "the reference spans {:.0f} % of the image's rows or columns: beyond them the field over "
      "rows and columns is {}",
      100.0 * share, share > 0.3 ? "a plane" : "constant"));
  return share > 0.3 ? 1 : 0;
}

/// Influence and its slope of every sample, for the errors.
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

void turn_backwards(MeasuredTable& table, std::vector<ReferenceSample>& samples, double range_m) {
  const Eigen::Index n = table.correlation.rows();
  table.correlation.bottomRows(n - 1) =
      table.correlation.bottomRows(n - 1).colwise().reverse().eval();
  for (ReferenceSample& s : samples) s.depth_m = range_m - s.depth_m;
}

void add_notes(const DepthFit& fit, const ReferenceDepth& reference,
               const Eigen::VectorXd& fitted_m, double covered, CalibratedDepth& result) {
  if (result.reversed) result.notes.push_back("delay runs backwards: the table written does, too");
  if (covered < 0.05)
    result.notes.push_back(
        "the reference hardly changes: only an offset and a field over the image were looked for, "
        "at this distance");
  else if (result.known_share < 0.999)
    result.notes.push_back(fmt::format(
        "known from the reference: {:.0f} % of the range; in the rest the correction is the "
        "model's word, of {} terms",
        100.0 * result.known_share, result.far_terms.size()));
  if (result.outlier_share > 0.3)
    result.notes.push_back(fmt::format("{:.0f} % of the pixels fit nothing and were left out",
                                       100.0 * result.outlier_share));
  std::vector<double> expected_m;
  for (Eigen::Index i = 0; i < fit.size(); ++i)
    expected_m.push_back(fit.samples[static_cast<std::size_t>(i)].depth_m - fit.start_m -
                         fitted_m[i]);
  if (auto note = shift_note(fit.samples, reference, expected_m, fit.range_m, fit.scale_m))
    result.notes.push_back(*note);
}

}  // namespace

CalibratedDepth calibrate_depth(const RawFrames& frames, const ReferenceDepth& reference,
                                const CodeSet& code, const Camera& camera,
                                const Progress& progress) {
  CalibratedDepth result;
  const ForwardModel model(code, camera);
  result.table = nominal_table(model, code, camera);
  const DecodingTable table = make_decoding_table(result.table, camera);
  const double range_m = table.range_m;
  const ProgressParts parts(progress, {3.0, 1.0});

  // Pixels that can be compared, and the direction of delay.
  std::vector<ReferenceSample> samples = reference_samples(frames, reference, table, parts[0]);
  result.pixels = static_cast<std::int64_t>(samples.size());
  result.reversed = runs_backwards(samples, reference, frames.height, frames.width, range_m);
  if (result.reversed) turn_backwards(result.table, samples, range_m);

  // All terms, robustly: which pixels count.
  DepthFit fit = start(std::move(samples), frames.height, frames.width, range_m);
  weigh(fit.error_m, fit);
  result.rms_before_m = std::sqrt((fit.weight.dot(fit.error_m.cwiseAbs2())) / fit.weight.sum());
  std::vector<bool> has = parts_with_depths(fit);
  const auto covered_parts = static_cast<int>(std::ranges::count(has, true));
  const double covered = static_cast<double>(covered_parts) / range_parts;
  const int highest =
      covered < 0.05 ? 0 : std::clamp((covered_parts - 2) / 2, 1, max_error_harmonic);
  const TermChoice all{(1u << highest) - 1u, degree_within(fit, result.notes), max_error_signal};
  report(parts[1], 0.1, "fitting");
  fill_terms(Eigen::VectorXd::Zero(fit.size()), fit);
  solve_robustly(all.columns(), 10, fit);

  // Which terms, by what is held out; then those alone.
  report(parts[1], 0.5, "choosing terms");
  const Chosen chosen = choose(fit, highest, all.degree);
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
  result.outlier_share =
      static_cast<double>((fit.weight.array() == 0.0).count()) / static_cast<double>(fit.size());
  result.table.correction = correction;
  add_notes(fit, reference, fitted_m, covered, result);
  return result;
}

}  // namespace tofsmith
