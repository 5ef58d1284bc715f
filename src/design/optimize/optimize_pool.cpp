// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/optimize/optimize_pool.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "simulate/shared/error_by_rotation.hpp"
#include "tofsmith/core/parallel.hpp"

namespace tofsmith {

namespace {

constexpr double min_error_bin = 1e-9;  // avoids log(0)

SampledCode on_grid_of(const SampledCamera& judge, const SampledCode& code) {
  const int repeat = judge.samples() / code.samples();
  if (repeat == 1) return code;
  SampledCode fine{Eigen::MatrixXd(judge.samples(), code.modulation.cols()),
                   Eigen::MatrixXd(judge.samples(), code.demodulation.cols()), code.shares};
  for (int n = 0; n < judge.samples(); ++n) {
    fine.modulation.row(n) = code.modulation.row(n / repeat);
    fine.demodulation.row(n) = code.demodulation.row(n / repeat);
  }
  return fine;
}

/// correlation'(z) = correlation(z + rotation_bin)
SampledCode rotated(const SampledCode& code, int rotation_bin) {
  SampledCode result = code;
  const int samples = code.samples();
  for (int n = 0; n < samples; ++n)
    result.modulation.row((n + rotation_bin) % samples) = code.modulation.row(n);
  return result;
}

std::vector<TrialBatch> draw_batches(const DesignProblem& problem, int trials, bool ends_matter,
                                     const DepthPrior& depths, std::uint64_t seed,
                                     std::uint64_t work_item) {
  const CameraVariant* widest = &problem.variants.front();
  for (const CameraVariant& variant : problem.variants)
    if (variant.levels.size() > widest->levels.size()) widest = &variant;
  std::vector<TrialBatch> batches;
  for (std::size_t p = 0; p < widest->levels.size(); ++p) {
    RandomStream random(seed, work_item, static_cast<std::uint32_t>(2 * p + ends_matter));
    const LightLevel& level = widest->levels[p];
    batches.push_back(draw_trials(DesignProblem::trials_of(level, trials), problem.measurements(),
                                  problem.operating, ends_matter, random, nullptr,
                                  problem.multipath_of(level), depths));
  }
  return batches;
}

/// Returns the linear error [bin], averaged over origins of depth within `window` of bin 0. The
/// expected error hardly depends on the origin close to the best one, and the average has a much
/// smaller variance.
double linear_error_bin(double true_bin, double decoded_bin, int samples, double window) {
  const double difference = decoded_bin - true_bin;
  const double error = difference - samples * std::round(difference / samples);
  const double low = std::min(true_bin, true_bin + error), high = low + std::abs(error);
  double separating = 0.0;  // length of origins between the two depths
  for (const int origin : {0, samples})
    separating += std::max(0.0, std::min(high, origin + window) - std::max(low, origin - window));
  const double circular = std::abs(error);
  return circular + separating / (2.0 * window) * (samples - 2.0 * circular);
}

/// Always circular for two-return decoding.
double mean_error_bin(const TrialBatch& batch, const std::vector<double>& decoded_bin, int samples,
                      bool linear) {
  constexpr double window_periods = 1.0 / 120.0;
  linear = linear && !batch.two_returns;
  double sum = 0.0;
  for (std::size_t t = 0; t < decoded_bin.size(); ++t) {
    const double true_bin = batch.trials[t].depth_periods * samples;
    const double error = std::abs(true_bin - decoded_bin[t]);
    sum += batch.trials[t].weight *
           (linear ? linear_error_bin(true_bin, decoded_bin[t], samples, window_periods * samples)
                   : std::min(error, samples - error));
  }
  return sum / static_cast<double>(decoded_bin.size());
}

template <typename Errors>
std::vector<double> errors_by_rotation(Errors errors, const TrialBatch& batch,
                                       const std::vector<double>& decoded_bin) {
  for (std::size_t t = 0; t < decoded_bin.size(); ++t) {  // the end of the last chord is bin 0
    const int samples = errors.samples();
    errors.add(batch.trials[t].depth_periods * samples,
               std::min(decoded_bin[t], std::nextafter(samples, 0.0)));
  }
  return errors.means_over_origins();
}

}  // namespace

CodeJudge::CodeJudge(const DesignProblem& problem, int trials, std::uint64_t seed,
                     std::uint64_t work_item)
    : problem_(&problem),
      judging_(draw_batches(problem, trials, problem.linear(), problem.depths, seed, work_item)) {
  // Too few trials would rotate codes away from their best origin.
  constexpr int enough = 1000;
  const int rotating_trials = std::min(trials, std::max(enough, trials / 4));
  if (problem.linear() || !problem.depths.is_uniform())
    rotating_ = draw_batches(problem, rotating_trials, false, DepthPrior(), seed, work_item);
}

CodeScore CodeJudge::score(const SampledCode& code) const {
  const SampledCode fine = on_grid_of(problem_->variants.front().judge, code);
  const int finer = fine.samples() / code.samples();
  const double in_bins_of_code = std::log(finer);
  if (rotating_.empty()) return {log_error(fine) - in_bins_of_code, 0};
  const int rotation = best_rotation(fine);
  return {log_error(rotated(fine, rotation)) - in_bins_of_code, rotation / finer};
}

double CodeJudge::log_error(const SampledCode& code) const {
  double worst = -1e300;
  std::vector<double> decoded_bin;
  for (const CameraVariant& variant : problem_->variants) {
    const SampledCamera::Measured measured = variant.judge.measure(code);
    DepthErrorLoss loss(variant.judge, measured.table, measured.times, problem_->operating.error);
    double sum = 0.0;
    for (std::size_t p = 0; p < variant.levels.size(); ++p) {
      loss.decode(variant.levels[p].point, judging_[p], decoded_bin);
      sum += variant.levels[p].weight *
             std::log(std::max(min_error_bin, mean_error_bin(judging_[p], decoded_bin,
                                                             code.samples(), problem_->linear())));
    }
    worst = std::max(worst, sum / variant.total_weight());
  }
  return worst;
}

int CodeJudge::best_rotation(const SampledCode& code) const {
  const int samples = code.samples();
  std::vector<double> worst(static_cast<std::size_t>(samples), -1e300), decoded_bin;
  for (const CameraVariant& variant : problem_->variants) {
    const SampledCamera::Measured measured = variant.judge.measure(code);
    DepthErrorLoss loss(variant.judge, measured.table, measured.times, problem_->operating.error);
    std::vector<double> log_error(worst.size(), 0.0);
    for (std::size_t p = 0; p < variant.levels.size(); ++p) {
      const DepthPrior& depths = problem_->depths;
      const bool circular = !problem_->linear() || rotating_[p].two_returns;
      if (circular && depths.is_uniform()) continue;  // independent of the rotation
      loss.decode(variant.levels[p].point, rotating_[p], decoded_bin);
      const auto kind = circular ? DepthErrorKind::circular : DepthErrorKind::linear;
      const std::vector<double> errors =
          depths.is_uniform()
              ? errors_by_rotation(ErrorByRotation(samples), rotating_[p], decoded_bin)
              : errors_by_rotation(WeighedErrorByRotation(depths, kind, samples), rotating_[p],
                                   decoded_bin);
      for (std::size_t r = 0; r < errors.size(); ++r)
        log_error[r] += variant.levels[p].weight * std::log(std::max(min_error_bin, errors[r])) /
                        variant.total_weight();
    }
    for (std::size_t r = 0; r < worst.size(); ++r) worst[r] = std::max(worst[r], log_error[r]);
  }
  return best_of_rotations(smoothed_over_rotations(worst));
}

namespace {

WaveformParameters rotated(const WaveformSpace& space, const WaveformParameters& parameters,
                           int rotation_bin) {
  const int cells = (rotation_bin + space.repeat / 2) / space.repeat % space.cells;
  WaveformParameters result = parameters;
  for (int c = 0; c < space.cells; ++c)
    result.modulation.row((c + cells) % space.cells) = parameters.modulation.row(c);
  return result;
}

constexpr double softness = 1.2;
constexpr double shares_per_rate = 0.5;  // logits of shares change less than waveforms
constexpr double noise = 0.3;

int below(int count, RandomStream& random) {
  return std::min(count - 1, static_cast<int>(random.uniform() * count));
}

void rotate_gates(const WaveformSpace& space, int exposure, int cells,
                  WaveformParameters& parameters) {
  auto gates = parameters.demodulation.middleCols(exposure * space.columns(), space.columns());
  const Eigen::MatrixXd before = gates;
  for (int c = 0; c < space.cells; ++c) gates.row((c + cells) % space.cells) = before.row(c);
}

enum Phase : std::uint64_t { judging = 1, starting, hopping, refining, drawing_starts, splitting };
constexpr std::size_t together = 10;  // descents between sorts of the pool
constexpr std::size_t hops_together = 6;
constexpr std::size_t max_pool = 24;
constexpr double refinement_softness = 1.5;

std::uint64_t work_item(std::uint64_t phase, std::size_t item) {
  return combine_keys(phase, static_cast<std::uint64_t>(item));
}

/// Allows a descent to change saturated parameters.
WaveformParameters softened(WaveformParameters parameters, double limit) {
  for (Eigen::MatrixXd* values : {&parameters.modulation, &parameters.demodulation})
    *values = values->cwiseMax(-limit).cwiseMin(limit);
  return parameters;
}

PoolEntry softened(PoolEntry entry) {
  entry.parameters = softened(std::move(entry.parameters), softness);
  return entry;
}

/// Jumps out of a local minimum: softens the best entry of one of the best three starts, replaces
/// one pair of waveforms (by a random pair or from another entry) or rotates its gates against its
/// light, and adds noise. `pool` is sorted and not empty.
/// @return parameters and name of the start
PoolEntry hop(const DesignProblem& problem, const std::vector<PoolEntry>& pool,
              RandomStream& random) {
  const WaveformSpace& space = problem.space;
  const int columns = space.columns();
  const auto entries = static_cast<int>(pool.size());
  const std::vector<std::size_t> bases = best_of_starts(pool, 3, 1);
  const int base = random.uniform() < 0.5 ? 0 : below(static_cast<int>(bases.size()), random);
  PoolEntry next = softened(pool[bases[static_cast<std::size_t>(base)]]);
  const int e = below(space.exposures, random);
  const double kind = random.uniform();
  if (kind < 0.3) {
    const WaveformParameters pair = softened(random_pair(problem, random), softness);
    next.parameters.modulation.col(e) = pair.modulation;
    next.parameters.demodulation.middleCols(e * columns, columns) = pair.demodulation;
  } else if (kind < 0.6) {
    const WaveformParameters donor =
        softened(pool[static_cast<std::size_t>(below(entries, random))].parameters, softness);
    const int from = below(space.exposures, random);
    next.parameters.modulation.col(e) = donor.modulation.col(from);
    next.parameters.demodulation.middleCols(e * columns, columns) =
        donor.demodulation.middleCols(from * columns, columns);
  }
  if (kind >= 0.3 && kind < 0.8)
    rotate_gates(space, e, below(space.cells, random), next.parameters);
  for (Eigen::MatrixXd* values : {&next.parameters.modulation, &next.parameters.demodulation})
    for (double& value : values->reshaped()) value += noise * random.normal();
  return next;
}

}  // namespace

int trials_per_level(const DesignProblem& problem, const OptimizeOptions& options) {
  constexpr int min_trials = 100;
  const std::size_t levels = problem.variants.front().levels.size();
  return std::max(min_trials, options.pool_trials / static_cast<int>(levels));
}

void Adam::step(Eigen::MatrixXd& values, const Eigen::MatrixXd& gradient, double rate) {
  if (mean_.size() == 0) {
    mean_ = Eigen::ArrayXXd::Zero(values.rows(), values.cols());
    square_ = mean_;
  }
  mean_power_ *= mean_decay_;
  square_power_ *= square_decay_;
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    const double g = std::isfinite(gradient(i)) ? gradient(i) : 0.0;
    mean_(i) = mean_decay_ * mean_(i) + (1.0 - mean_decay_) * g;
    square_(i) = square_decay_ * square_(i) + (1.0 - square_decay_) * g * g;
    const double deviation = std::sqrt(square_(i) / (1.0 - square_power_));
    values(i) -= rate * (mean_(i) / (1.0 - mean_power_)) / (deviation + 1e-12);
  }
}

WaveformParameters descend(const DesignProblem& problem, WaveformParameters parameters,
                           const DescentSchedule& schedule, std::uint64_t seed,
                           std::uint64_t work_item, SharedProgress* progress) {
  constexpr double soft_share = 0.4;                // of the steps, before waveforms sharpen
  constexpr double final_decision_sharpness = 3.0;  // per log likelihood; 1 at first
  // Limits; sharpened waveforms are nearly binary well inside.
  const double largest_modulation = schedule.final_sharpness.modulation > 1.0 ? 4.0 : 8.0;
  const double largest_demodulation = schedule.final_sharpness.demodulation > 1.0 ? 3.0 : 6.0;
  StochasticGradient objective(problem, schedule.trials_per_step, seed, work_item);
  Adam modulation, demodulation, shares;
  for (int step = 0; step < schedule.steps; ++step) {
    if (progress) progress->add();
    const double done = static_cast<double>(step) / schedule.steps;
    const double along = std::max(0.0, (done - soft_share) / (1.0 - soft_share));
    const Sharpness sharpness{std::pow(schedule.final_sharpness.modulation, along),
                              std::pow(schedule.final_sharpness.demodulation, along)};
    const double decision_sharpness = std::pow(final_decision_sharpness, done);
    RandomStream random(seed, work_item, static_cast<std::uint32_t>(step));
    const SampledCode code = render(problem.space, parameters, sharpness);
    const WaveformParameters gradient =
        pull_back(problem.space, code, sharpness, objective.at(code, decision_sharpness, random));
    // Sharper waveforms change more per parameter.
    const double rate = schedule.rate * (done < 0.7 ? 1.0 : std::max(0.05, (1.0 - done) / 0.3));
    modulation.step(parameters.modulation, gradient.modulation,
                    rate / std::sqrt(sharpness.modulation));
    demodulation.step(parameters.demodulation, gradient.demodulation,
                      rate / std::sqrt(sharpness.demodulation));
    if (parameters.shares.size() > 0)
      shares.step(parameters.shares, gradient.shares, shares_per_rate * rate);
    parameters.modulation =
        parameters.modulation.cwiseMax(-largest_modulation).cwiseMin(largest_modulation);
    parameters.demodulation =
        parameters.demodulation.cwiseMax(-largest_demodulation).cwiseMin(largest_demodulation);
  }
  return parameters;
}

std::vector<std::size_t> best_of_starts(const std::vector<PoolEntry>& pool, std::size_t count,
                                        std::ptrdiff_t of_each) {
  std::vector<std::size_t> best;
  for (std::size_t i = 0; i < pool.size() && best.size() < count; ++i) {
    const auto from_same = std::count_if(best.begin(), best.end(), [&](std::size_t other) {
      return pool[other].start_index == pool[i].start_index;
    });
    if (from_same < of_each) best.push_back(i);
  }
  return best;
}

Sharpness final_sharpness(const DesignProblem& problem) {
  Sharpness sharpness = DescentSchedule().final_sharpness;
  if (!problem.binary_modulation) sharpness.modulation = 1.0;
  if (!problem.binary_demodulation) sharpness.demodulation = 1.0;
  return sharpness;
}

std::vector<OptimizeStart> best_mixtures(const DesignProblem& problem, std::ptrdiff_t count,
                                         std::uint64_t seed, const Progress& progress) {
  constexpr int trials = 200;  // per light level
  if (count <= 0) return {};
  std::vector<OptimizeStart> all = frequency_mixtures(problem);
  const CodeJudge judge(problem, trials, seed, work_item(Phase::judging, 2));
  std::vector<std::pair<double, std::size_t>> ranked(all.size());
  SharedProgress shared(progress, static_cast<double>(all.size()), "mixtures of frequencies");
  parallel_for_indices(all.size(), [&](std::size_t at) {
    shared.add();
    const SampledCode code = render(problem.space, all[at].parameters, final_sharpness(problem));
    ranked[at] = {judge.score(code).log_error_bin, at};
  });
  std::sort(ranked.begin(), ranked.end());
  std::vector<OptimizeStart> best;
  std::set<std::string> names;
  for (const auto& log_error_and_index : ranked) {
    OptimizeStart& next = all[log_error_and_index.second];
    if (std::ssize(best) < count && names.insert(next.name).second) best.push_back(std::move(next));
  }
  return best;
}

OptimizePool::OptimizePool(const DesignProblem& problem, const OptimizeOptions& options,
                           std::span<const CodeSet> also, double bin_m)
    : problem_(&problem),
      options_(options),
      bin_m_(bin_m),
      judge_(problem, trials_per_level(problem, options), options.seed,
             work_item(Phase::judging, 0)),
      codes_(fitting_codes(problem.space, also)) {}

double OptimizePool::error_m(double log_error_bin) const {
  return std::exp(log_error_bin) * bin_m_;
}

void OptimizePool::record(double log_error_bin) {
  const double next_m = error_m(log_error_bin);
  const double best_m = history_.empty() ? next_m : history_.back().error_m;
  history_.push_back({static_cast<double>(history_.size() + 1), std::min(best_m, next_m)});
}

/// Results are at the best rotation.
void OptimizePool::descend_all(std::vector<PoolEntry>& entries, int steps, double rate,
                               std::uint64_t phase, std::size_t first_item,
                               SharedProgress& progress) {
  steps_ += std::ssize(entries) * steps;
  const DescentSchedule schedule{.steps = steps,
                                 .trials_per_step = options_.trials_per_step,
                                 .rate = rate,
                                 .final_sharpness = final_sharpness(*problem_)};
  parallel_for_indices(entries.size(), [&](std::size_t at) {
    PoolEntry& entry = entries[at];
    entry.parameters = descend(*problem_, std::move(entry.parameters), schedule, options_.seed,
                               work_item(phase, first_item + at), &progress);
    const SampledCode code = render(problem_->space, entry.parameters, schedule.final_sharpness);
    entry.score = judge_.score(code);
    entry.parameters = rotated(problem_->space, entry.parameters, entry.score.rotation_bin);
    entry.score.rotation_bin = 0;
  });
}

void OptimizePool::keep(std::vector<PoolEntry> entries) {
  for (PoolEntry& entry : entries) {
    record(entry.score.log_error_bin);
    entries_.push_back(std::move(entry));
  }
  std::stable_sort(entries_.begin(), entries_.end(), [](const PoolEntry& a, const PoolEntry& b) {
    return a.score.log_error_bin < b.score.log_error_bin;
  });
  if (entries_.size() > max_pool) entries_.resize(max_pool);
}

void OptimizePool::run_starts(const PoolStage& stage, double rival_m, const Progress& progress) {
  constexpr std::ptrdiff_t max_mixtures = 16;
  // The first starts are known codes. Later steps rarely reduce their error by a quarter.
  constexpr double hopeless = 1.35;
  const auto count = static_cast<std::size_t>(stage.starts);
  const ProgressParts parts(progress, {starts_done_ == 0 ? 10.0 : 0.0, 90});
  if (starts_done_ == 0)
    mixtures_ = best_mixtures(*problem_, std::min(max_mixtures, stage.starts - std::ssize(codes_)),
                              options_.seed, parts[0]);
  SharedProgress shared(
      parts[1], static_cast<double>(count - starts_done_) * options_.steps_per_start, "starts");
  for (std::size_t first = starts_done_; first < count; first += together) {
    lost_to_rival_ = first > 0 && best_error_m() > hopeless * rival_m;
    if (lost_to_rival_) break;
    std::vector<PoolEntry> entries;
    for (std::size_t i = first; i < std::min(count, first + together); ++i) {
      RandomStream random(options_.seed, work_item(Phase::drawing_starts, i));
      OptimizeStart start =
          optimize_start(*problem_, codes_, mixtures_, static_cast<int>(i), random);
      entries.push_back({std::move(start.parameters), {}, std::move(start.name), i});
    }
    descend_all(entries, options_.steps_per_start, 0.08, Phase::starting, first, shared);
    keep(std::move(entries));
  }
  starts_done_ = count;
  continued_.assign(entries_.begin(), entries_.begin() + std::min<std::ptrdiff_t>(
                                                             stage.refined, std::ssize(entries_)));
}

void OptimizePool::run_hops(const PoolStage& stage, double rival_m, const Progress& progress) {
  // Hops, refinement and polish together reduce errors by up to 15 %; the part after the continued
  // starts by up to 10 %.
  constexpr double start_margin = 0.2, first_margin = 0.12, last_margin = 0.02;
  const auto count = static_cast<std::size_t>(stage.hops);
  int without_gain = 0;
  ended_early_ = false;
  if (lost_to_rival_) return;
  SharedProgress shared(progress, static_cast<double>(count - hops_done_) * options_.steps_per_hop,
                        "hops");
  for (std::size_t first = hops_done_; first < count; first += hops_together) {
    const double remaining =
        static_cast<double>(count - first) / static_cast<double>(count - hops_done_);
    const double margin = first - hops_done_ < continued_.size()
                              ? start_margin
                              : last_margin + remaining * (first_margin - last_margin);
    lost_to_rival_ = best_error_m() > (1.0 + margin) * rival_m;
    if (lost_to_rival_) break;
    std::vector<PoolEntry> entries;
    for (std::size_t i = first; i < std::min(count, first + hops_together); ++i) {
      RandomStream random(options_.seed, work_item(Phase::hopping, i), 1u << 30);
      const std::size_t of_stage = i - hops_done_;
      entries.push_back(of_stage < continued_.size() ? softened(continued_[of_stage])
                                                     : hop(*problem_, entries_, random));
    }
    descend_all(entries, options_.steps_per_hop, 0.08, Phase::hopping, first, shared);
    without_gain += static_cast<int>(entries.size());
    const double best_before = entries_.front().score.log_error_bin;
    keep(std::move(entries));
    if (entries_.front().score.log_error_bin < best_before) without_gain = 0;
    if (options_.patience > 0 && without_gain >= options_.patience &&
        first + hops_together < count) {
      ended_early_ = true;
      break;
    }
  }
  hops_done_ = count;
}

std::vector<PoolEntry> OptimizePool::with_free_shares(const PoolStage& stage,
                                                      const Progress& progress) {
  std::vector<PoolEntry> entries;
  for (const std::size_t i : best_of_starts(entries_, static_cast<std::size_t>(stage.refined), 2)) {
    entries.push_back(softened(entries_[i]));
    entries.back().parameters.shares = Eigen::MatrixXd::Zero(problem_->space.exposures, 1);
  }
  SharedProgress shared(progress, static_cast<double>(entries.size()) * options_.steps_per_hop,
                        "exposure times");
  descend_all(entries, options_.steps_per_hop, 0.08, Phase::splitting, splits_done_, shared);
  splits_done_ += entries.size();
  return entries;
}

void OptimizePool::refine(const PoolStage& stage, const Progress& progress) {
  if (stage.refinement_steps == 0) return;
  std::vector<PoolEntry> entries;
  for (const std::size_t i : best_of_starts(entries_, static_cast<std::size_t>(stage.refined), 2)) {
    entries.push_back(entries_[i]);
    entries.back().parameters = softened(entries_[i].parameters, refinement_softness);
  }
  SharedProgress shared(progress, static_cast<double>(entries.size()) * stage.refinement_steps,
                        "refinement");
  descend_all(entries, stage.refinement_steps, 0.03, Phase::refining, refinements_done_, shared);
  refinements_done_ += entries.size();
  keep(std::move(entries));
}

}  // namespace tofsmith
