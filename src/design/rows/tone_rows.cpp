// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/rows/tone_rows.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <chrono>
#include <climits>
#include <cmath>
#include <iterator>
#include <numbers>
#include <numeric>
#include <set>
#include <utility>

#include "camera/shared/listed_exposures.hpp"
#include "core/shared/decompositions.hpp"
#include "core/shared/periodic.hpp"
#include "core/shared/random.hpp"
#include "core/shared/shared_progress.hpp"
#include "design/judge.hpp"
#include "design/rows/dim_light.hpp"
#include "tofsmith/core/parallel.hpp"
#include "tofsmith/core/units.hpp"
#include "tofsmith/simulate/depth_error.hpp"

namespace tofsmith {

namespace {

using std::numbers::pi;

/// Minimum, because depth is interpolated linearly between bins.
constexpr int min_bins_per_period = 6;
constexpr int rounds_of_light = 12, drawn_sets = 400, judged_sets = 4;  // judged: per search

/// Simulated annealing from the best sets: first of those drawn, then of those found. A step is
/// accepted if it increases the logarithm of the score by less than an exponentially distributed
/// number, whose mean decreases linearly from `temperature` to 0 within `cold_after` of the steps.
struct AnnealingStage {
  std::int64_t chains, steps;
  double temperature;
};
constexpr std::array stages = {AnnealingStage{12, 100, 0.0}, AnnealingStage{8, 1500, 0.1}};
constexpr double cold_after = 0.8, same_tones = 0.3;  // shares of the steps

/// Exponents in the score e d^dim r^rms of the error e, the error d at a tenth of the light, and
/// the root mean square error r.
struct Weights {
  double dim = 0.0, rms = 0.0;
};
double score_of(double error_m, double dim_error_m, double rms_m, Weights weights) {
  return error_m * std::pow(dim_error_m, weights.dim) * std::pow(rms_m, weights.rms);
}
/// Side lobes matter more in dimmer light and for the root mean square error: 1 % more error is
/// accepted for 40 % less at a tenth of the light or for 10 % less root mean square error (unless
/// it is minimized itself), up to 5 % in total.
Weights preferred_on(const Camera& camera) {
  return {.dim = 0.02, .rms = camera.operating.statistic == ErrorStatistic::rmse ? 0.0 : 0.1};
}
constexpr double max_loss = 1.05;

/// Monte Carlo trials in units of DesignOptions::search_trials, for all operating points together.
constexpr int first_trials = 5, dim_trials = 2;
constexpr std::int64_t most_trials = 4'000'000'000;  // limit of evaluate()
/// Numbers of sets and of trials in the final rounds.
constexpr std::array<std::pair<std::size_t, int>, 2> final_rounds = {{{4, 20}, {3, 80}}};

using Tones = std::vector<int>;

/// Returns the number of cosines and sines. The plain decoder removes the mean over rows, so that
/// all information must be in rows whose sum is 0.
int rows_of_tones(const Camera& camera, int rows) {
  return camera.sensor.decoder == RowDecoder::plain ? rows - 1 : rows;
}

struct ToneCode {
  Tones tones;
  Eigen::VectorXd light;  // (N)
  double foreseen_m = infinity, rms_foreseen_m = infinity;
  double dim_foreseen_m = infinity;  // at dim_share of the light

  double score(Weights weights) const {
    return score_of(foreseen_m, dim_foreseen_m, rms_foreseen_m, weights);
  }
};

class ToneSearch {
 public:
  ToneSearch(const Camera& camera, int rows)
      : camera_(camera),
        dim_(in_share_of_light(camera, dim_share)),
        read_rows_(rows),
        rows_(rows_of_tones(camera, rows)),
        samples_(camera.samples),
        highest_(std::max(1, samples_ / min_bins_per_period)),
        transform_(samples_),
        response_(camera.band_limited()
                      ? camera.transfer(transform_.coefficients() - 1).conjugate().eval()
                      : Eigen::VectorXcd::Ones(transform_.coefficients()).eval()),
        cosine_(2 * samples_),
        sine_(2 * samples_) {
    for (int n = 0; n < 2 * samples_; ++n) {
      cosine_[n] = std::cos(pi * n / samples_);
      sine_[n] = std::sin(pi * n / samples_);
    }
    for (Eigen::Index n = 1; n < response_.size(); ++n) {
      const double x = pi * static_cast<double>(n) / samples_;
      response_[n] *= std::pow(std::sin(x) / x, 2);  // cell averages of light and of counts
    }
    transfer_ = response_.head(highest_ + 1).cwiseAbs();
    for (int n = 1; n <= highest_; ++n)
      if (n * transfer_[n] > best_ * transfer_[best_]) best_ = n;
    const double duty = std::max(1.0 / camera.light.peak_factor, 1.0 / samples_);
    on_bins_ = std::clamp(static_cast<int>(std::ceil(duty * samples_ - 1e-9)), 1, samples_ - 1);
  }

  int tones() const { return (rows_ + 1) / 2; }

  Tones draw(RandomStream& random) const {
    const double centre = -1.0 + 1.1 * random.uniform(), spread = 0.1 + 0.7 * random.uniform();
    std::set<int> drawn;
    while (static_cast<int>(drawn.size()) < std::min(tones(), highest_)) {
      const double tone = best_ * std::exp(centre + spread * random.normal());
      drawn.insert(std::clamp(static_cast<int>(std::lround(tone)), 1, highest_));
      if (random.uniform() < 0.1) drawn.insert(any_tone(random));
    }
    return Tones(drawn.begin(), std::next(drawn.begin(), tones()));
  }

  /// Moves one tone, or returns the same tones, for which code_of() draws other light.
  Tones stepped(const Tones& from, RandomStream& random) const {
    if (random.uniform() < same_tones) return from;
    Tones tones = from;
    const auto at = static_cast<std::size_t>(random.uniform() * static_cast<double>(tones.size()));
    int& tone = tones[std::min(at, tones.size() - 1)];
    if (random.uniform() < 0.5) {
      tone = any_tone(random);
    } else {
      const int step = 1 + static_cast<int>(random.uniform() * std::max(3, best_ / 12));
      tone = std::clamp(tone + (random.uniform() < 0.5 ? -step : step), 1, highest_);
    }
    std::sort(tones.begin(), tones.end());
    return std::adjacent_find(tones.begin(), tones.end()) == tones.end() ? tones : from;
  }

  ToneCode code_of(Tones tones, RandomStream& random) const {
    ToneCode code{std::move(tones), {}, infinity};
    find_light(code, random);
    foresee(code);
    return code;
  }

  CodeSet code_set(const ToneCode& code) const {
    const Waveform light = Waveform::binary_from_samples(code.light, code.light.maxCoeff());
    Eigen::MatrixXd weights = weights_of(code.tones).rightCols(rows_);
    if (rows_ < read_rows_) weights *= complement_of(Eigen::VectorXd::Ones(read_rows_)).transpose();
    return CodeSet::create_rows(rows_name(read_rows_), light, weights);
  }

 private:
  int any_tone(RandomStream& random) const {
    const double highest = std::log(std::min(highest_, 2 * best_));
    return std::clamp(static_cast<int>(std::lround(std::exp(random.uniform() * highest))), 1,
                      highest_);
  }

  /// Cosine and sine of each tone. An odd number of rows lacks the first cosine.
  Eigen::MatrixXd weights_of(const Tones& tones) const {
    Eigen::MatrixXd weights(samples_, 2 * static_cast<Eigen::Index>(tones.size()));
    for (int k = 0; k < weights.cols(); ++k) {
      const std::int64_t tone = tones[static_cast<std::size_t>(k / 2)];
      for (int n = 0; n < samples_; ++n) {
        // Centre of the bin, in half samples.
        const int at = static_cast<int>(tone * (2 * n + 1) % (2 * samples_));
        weights(n, k) = (k % 2 == 0 ? cosine_ : sine_)[at];
      }
    }
    return weights;
  }

  void find_light(ToneCode& code, RandomStream& random) const {
    const auto count = static_cast<Eigen::Index>(code.tones.size());
    Eigen::VectorXd phase(count), amplitude = Eigen::VectorXd::Ones(count), weight(count);
    for (Eigen::Index i = 0; i < count; ++i) {
      const int tone = code.tones[static_cast<std::size_t>(i)];
      weight[i] = std::pow(tone * transfer_[tone], 2);
      phase[i] = 2 * pi * random.uniform();
    }
    std::vector<int> order(static_cast<std::size_t>(samples_));
    Eigen::VectorXd sum(samples_), is_on, was_on = Eigen::VectorXd::Zero(samples_);
    for (int round = 0; round < rounds_of_light; ++round) {
      sum.setZero();
      for (Eigen::Index i = 0; i < count; ++i) {
        const int tone = code.tones[static_cast<std::size_t>(i)];
        const double c = weight[i] * amplitude[i] * std::cos(phase[i]);
        const double s = weight[i] * amplitude[i] * std::sin(phase[i]);
        for (int n = 0, at = 0; n < samples_; ++n, at += 2 * tone) {
          if (at >= 2 * samples_) at -= 2 * samples_;
          sum[n] += c * cosine_[at] - s * sine_[at];
        }
      }
      std::iota(order.begin(), order.end(), 0);
      std::nth_element(order.begin(), order.begin() + on_bins_ - 1, order.end(),
                       [&](int a, int b) { return sum[a] != sum[b] ? sum[a] > sum[b] : a < b; });
      is_on.setZero(samples_);
      for (int i = 0; i < on_bins_; ++i) is_on[order[static_cast<std::size_t>(i)]] = 1.0;
      for (Eigen::Index i = 0; i < count; ++i) {
        const int tone = code.tones[static_cast<std::size_t>(i)];
        double c = 0.0, s = 0.0;
        for (int j = 0; j < on_bins_; ++j) {
          const std::int64_t n = order[static_cast<std::size_t>(j)];
          const auto at = static_cast<Eigen::Index>(2 * (tone * n % samples_));
          c += cosine_[at], s -= sine_[at];
        }
        amplitude[i] = std::hypot(c, s) / on_bins_;
        phase[i] = std::atan2(s, c);
      }
      if (is_on == was_on) break;
      was_on = is_on;
    }
    code.light = is_on * (static_cast<double>(samples_) / on_bins_);
  }

  void foresee(ToneCode& code) const {
    const double exposure_s = camera_.exposure_s.of(0, 1), range_m = camera_.range_m();
    const Sensor& sensor = camera_.sensor;
    Eigen::VectorXcd spectrum(transform_.coefficients());
    transform_.forward(code.light / code.light.sum(), spectrum);
    spectrum.array() *= response_.array();
    Eigen::VectorXd share;
    transform_.inverse(spectrum, share);
    share = share.cwiseMax(0.0);
    const Eigen::MatrixXd weights = weights_of(code.tones);
    const Eigen::MatrixXd weighed = weights.transpose() * share.asDiagonal() * weights;
    const Eigen::MatrixXd constant = weights.transpose() * weights / samples_;
    Eigen::VectorXd mean = weights.transpose() * share;
    Eigen::VectorXd slope = slope_of(code.tones, mean);
    if (rows_ % 2 == 1) {  // one row of a tone has half the information of two, averaged over depth
      mean.head(2) *= std::sqrt(0.5);
      slope.head(2) *= std::sqrt(0.5);
    }

    // Logarithms of the mean absolute and the root mean square error.
    const auto logarithms_of = [&](const OperatingPoint& point) {
      const double signal_e = exposure_s * camera_.operating.albedo * point.signal_e_per_s;
      const double other_e = exposure_s * (point.ambient_e_per_s + sensor.dark_current_e_per_s);
      const double read_e2 = sensor.read_noise_e * sensor.read_noise_e;
      Eigen::MatrixXd covariance = signal_e * weighed + other_e * constant;
      covariance.diagonal().array() += read_e2 + 1e-9 * (signal_e + other_e);
      const Eigen::LLT<Eigen::MatrixXd> factor(covariance);
      Eigen::VectorXd by_depth = signal_e * slope, by_signal = mean;
      factor.matrixL().solveInPlace(by_depth);
      factor.matrixL().solveInPlace(by_signal);
      by_signal.normalize();
      by_depth -= by_depth.dot(by_signal) * by_signal;
      const double local_rms_m = range_m / by_depth.norm();
      const double variance_e2 = 0.5 * (signal_e + other_e) + read_e2;
      Eigen::VectorXd power(static_cast<Eigen::Index>(code.tones.size()));
      for (Eigen::Index i = 0; i < power.size(); ++i)
        power[i] = mean.segment(2 * i, 2).squaredNorm() * signal_e * signal_e / variance_e2;
      const auto [lobes_m, lobes_m2] = lobes(code.tones, power);
      const double mean_m = std::min(0.25 * range_m, std::sqrt(2 / pi) * local_rms_m + lobes_m);
      const double rms_m =
          std::min(range_m / std::sqrt(12.0), std::sqrt(local_rms_m * local_rms_m + lobes_m2));
      return Eigen::Array2d(std::log(mean_m), std::log(rms_m));
    };
    const auto errors_m = [&](const Camera& camera) {
      Eigen::Array2d logarithms = Eigen::Array2d::Zero();
      const std::vector<OperatingPoint> points = camera.operating.points();
      for (const OperatingPoint& point : points) logarithms += logarithms_of(point);
      return Eigen::Array2d((logarithms / static_cast<double>(points.size())).exp());
    };
    const int statistic = camera_.operating.statistic == ErrorStatistic::rmse ? 1 : 0;
    const Eigen::Array2d errors = errors_m(camera_);
    code.foreseen_m = errors[statistic];
    code.rms_foreseen_m = errors[1];
    code.dim_foreseen_m = errors_m(dim_)[statistic];
  }

  /// Derivative per period of depth, from the mean at depth 0.
  Eigen::VectorXd slope_of(const Tones& tones, const Eigen::VectorXd& mean) const {
    Eigen::VectorXd slope(mean.size());
    for (int k = 0; k < slope.size(); ++k) {
      const int other = k % 2 == 0 ? k + 1 : k - 1;
      slope[k] = (k % 2 == 0 ? -2 : 2) * pi * tones[static_cast<std::size_t>(k / 2)] * mean[other];
    }
    return slope;
  }

  /// Sums over lobes of row_candidates() with |u| R [m] and with (u R)^2 [m^2].
  std::array<double, 2> lobes(const Tones& tones, const Eigen::VectorXd& power) const {
    // At u = j / points, 8 per period of the highest tone; minima by parabolas.
    const int points = std::min(samples_, 8 * tones.back());
    const int half = points / 2;
    std::vector<double> apart(static_cast<std::size_t>(half) + 2, 0.0);
    for (Eigen::Index i = 0; i < power.size(); ++i)
      for (int j = 0; j <= half + 1; ++j)
        apart[static_cast<std::size_t>(j)] +=
            power[i] *
            (1.0 - cosine_of(static_cast<double>(tones[static_cast<std::size_t>(i)]) * j / points));
    std::array<double, 2> sums = {};
    for (int j = 1; j <= half; ++j) {
      const double here = apart[static_cast<std::size_t>(j)];
      const double before = apart[static_cast<std::size_t>(j) - 1];
      const double after = apart[static_cast<std::size_t>(j) + 1];
      if (here > before || here > after) continue;
      const double bend = before + after - 2 * here, tilt = after - before;
      const double least = bend > 0.0 ? std::max(0.0, here - tilt * tilt / (8 * bend)) : here;
      const double apart_m = camera_.range_m() * j / points;
      const double probability = std::erfc(0.5 * std::sqrt(least));
      sums[0] += apart_m * probability;
      sums[1] += apart_m * apart_m * probability;
    }
    return sums;
  }

  double cosine_of(double turns) const {
    const double part = turns - std::floor(turns);
    return cosine_[2 * std::min(static_cast<int>(part * samples_ + 0.5), samples_ - 1)];
  }

  const Camera& camera_;
  Camera dim_;
  int read_rows_, rows_, samples_, highest_;
  PeriodicTransform transform_;
  Eigen::VectorXcd response_;      // of both arms, all harmonics of the bins
  Eigen::VectorXd transfer_;       // |H_n| of arms and bins
  Eigen::VectorXd cosine_, sine_;  // of half bins
  int best_ = 1, on_bins_ = 1;
};

void keep_best(std::vector<ToneCode>& codes, std::int64_t count, Weights weights) {
  std::stable_sort(codes.begin(), codes.end(), [weights](const ToneCode& a, const ToneCode& b) {
    return a.score(weights) < b.score(weights);
  });
  std::vector<ToneCode> kept;
  for (ToneCode& code : codes) {
    if (std::ssize(kept) == count) break;
    if (std::none_of(kept.begin(), kept.end(),
                     [&](const ToneCode& other) { return other.tones == code.tones; }))
      kept.push_back(std::move(code));
  }
  codes = std::move(kept);
}

std::int64_t by_effort(double count, const DesignOptions& options) {
  const double effort =
      static_cast<double>(options.optimize.starts) / static_cast<double>(OptimizeOptions().starts);
  return std::max<std::int64_t>(1, std::llround(count * effort));
}

/// Returns the best code of all steps.
ToneCode annealed(const ToneSearch& search, ToneCode code, Weights weights,
                  const AnnealingStage& stage, RandomStream& random, SharedProgress& progress) {
  ToneCode best = code;
  for (std::int64_t step = 0; step < stage.steps; ++step) {
    progress.add();
    ToneCode tried = search.code_of(search.stepped(code.tones, random), random);
    const double part = static_cast<double>(step) / static_cast<double>(stage.steps);
    const double temperature = stage.temperature * std::max(0.0, 1.0 - part / cold_after);
    const double accepted = code.score(weights) * std::pow(1.0 - random.uniform(), -temperature);
    if (tried.score(weights) < best.score(weights)) best = tried;
    if (tried.score(weights) < accepted) code = std::move(tried);
  }
  return best;
}

/// Selects by rounds with fewer sets and more trials.
std::size_t chosen_of(const ToneSearch& search, const std::vector<ToneCode>& codes,
                      const Camera& camera, const DesignOptions& options,
                      const Progress& progress) {
  struct Judged {
    std::size_t index = 0;
    double error_m = infinity, dim_error_m = infinity, rms_m = infinity;
  };
  const auto score = [weights = preferred_on(camera)](const Judged& code) {
    return score_of(code.error_m, code.dim_error_m, code.rms_m, weights);
  };
  const auto by_score = [&](const Judged& a, const Judged& b) { return score(a) < score(b); };
  const auto by_error = [](const Judged& a, const Judged& b) { return a.error_m < b.error_m; };
  const auto points = static_cast<int>(camera.operating.points().size());
  const auto evaluated = [&](std::size_t index, const Camera& on, int times) {
    const double trials = static_cast<double>(times) * options.search_trials / points;
    const EvaluateOptions judging{
        .trials = std::clamp<std::int64_t>(by_effort(trials, options), options.search_trials,
                                           most_trials),
        .seed = search_seed(options),
        .bounds = false};
    return evaluate(search.code_set(codes[index]), on, judging);
  };
  const DepthErrorMeasure measure = camera.operating.measure();
  // Circular: depths that wrap at the ends of the range are not wrong lobes.
  const DepthErrorMeasure rms = {DepthErrorKind::circular, ErrorStatistic::rmse};
  const Camera dim = in_share_of_light(camera, dim_share);
  const ProgressParts parts(progress, {20, 30, 50});
  // Geometric means of Monte Carlo and predicted errors: few trials may contain no wrong lobe.
  const auto judge_in_full_light = [&](Judged& code, int times) {
    const DepthErrorReport error = evaluated(code.index, camera, times);
    const ToneCode& foreseen = codes[code.index];
    code.error_m = std::sqrt(foreseen.foreseen_m * geometric_mean_error_m(error, measure));
    code.rms_m = std::sqrt(foreseen.rms_foreseen_m * geometric_mean_error_m(error, rms));
  };
  std::vector<Judged> judged(codes.size());
  for (std::size_t i = 0; i < codes.size(); ++i) {
    judged[i].index = i;
    judge_in_full_light(judged[i], first_trials);
    judged[i].dim_error_m = geometric_mean_error_m(evaluated(i, dim, dim_trials), measure);
    report(parts[0], static_cast<double>(i + 1) / static_cast<double>(codes.size()), "rows");
  }
  for (std::size_t round = 0; round < final_rounds.size(); ++round) {
    const auto [most_sets, trials] = final_rounds[round];
    const std::size_t sets = std::min(most_sets, judged.size());
    std::stable_sort(judged.begin(), judged.end(), by_score);
    const auto least = std::min_element(judged.begin(), judged.end(), by_error);
    if (static_cast<std::size_t>(least - judged.begin()) >= sets) judged[sets - 1] = *least;
    judged.resize(sets);
    for (std::size_t i = 0; i < sets; ++i) {
      judge_in_full_light(judged[i], trials);
      report(parts[1 + round], static_cast<double>(i + 1) / static_cast<double>(sets), "rows");
    }
  }
  const double least_m = std::min_element(judged.begin(), judged.end(), by_error)->error_m;
  std::erase_if(judged, [&](const Judged& code) { return code.error_m > max_loss * least_m; });
  return std::min_element(judged.begin(), judged.end(), by_score)->index;
}

}  // namespace

std::optional<BrokenRule> why_no_row_design(const Camera& camera, int rows) {
  if (camera.light.peak_factor <= 1.0)
    return broken("light.peak_factor", camera.light.peak_factor,
                  "must be > 1 to design rows: constant light cannot measure depth");
  if (auto others = other_exposures_listed(camera, 1)) return others;
  const int tones = (rows_of_tones(camera, rows) + 1) / 2;
  if (camera.samples / min_bins_per_period < tones)
    return broken(
        "samples", camera.samples,
        fmt::format("must be >= {} to design {} rows", min_bins_per_period * tones, rows));
  return std::nullopt;
}

std::vector<Candidate> row_candidates(const Camera& on, int rows, const DesignOptions& options,
                                      const Progress& progress) {
  const auto begin = std::chrono::steady_clock::now();
  const Camera camera = judged_camera(on);
  require(why_no_row_design(camera, rows));
  const ToneSearch search(camera, rows);
  const ProgressParts parts(progress, {40, 60});
  const std::uint64_t seed = search_seed(options);

  const std::array searched = {Weights{}, preferred_on(camera)};
  const std::int64_t drawn = by_effort(drawn_sets, options);
  std::int64_t all = drawn;
  std::array annealing = stages;
  for (AnnealingStage& stage : annealing) {
    stage.steps = by_effort(static_cast<double>(stage.steps), options);
    all += std::ssize(searched) * stage.chains * stage.steps;
  }
  SharedProgress shared(parts[0], static_cast<double>(all), "rows");
  std::vector<ToneCode> at_random(static_cast<std::size_t>(drawn)), codes;
  parallel_for_indices(at_random.size(), [&](std::size_t i) {
    shared.add();
    RandomStream random(seed, i, 0);
    at_random[i] = search.code_of(search.draw(random), random);
  });
  std::uint32_t turn = 0;
  for (const Weights weights : searched) {
    std::vector<ToneCode> better = at_random;
    for (const AnnealingStage& stage : annealing) {
      keep_best(better, stage.chains, weights);
      const std::vector<ToneCode> starts =
          std::exchange(better, std::vector<ToneCode>(static_cast<std::size_t>(stage.chains)));
      ++turn;
      parallel_for_indices(better.size(), [&](std::size_t i) {
        RandomStream random(seed, i, turn);
        better[i] = annealed(search, starts[i % starts.size()], weights, stage, random, shared);
      });
    }
    keep_best(better, judged_sets, weights);
    std::move(better.begin(), better.end(), std::back_inserter(codes));
  }
  keep_best(codes, std::ssize(searched) * judged_sets, preferred_on(camera));

  const ToneCode& tones = codes[chosen_of(search, codes, camera, options, parts[1])];
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
  Candidate candidate{.code = signed_by(search.code_set(tones), "optimize", on, options.seed),
                      .method = "optimize"};
  candidate.seconds = taken.count();
  candidate.iterations = static_cast<int>(std::min<std::int64_t>(all, INT_MAX));
  candidate.message = fmt::format("tones {}", fmt::join(tones.tones, ", "));
  candidate.per_measurement.resize(static_cast<std::size_t>(rows));
  return {std::move(candidate)};
}

}  // namespace tofsmith
