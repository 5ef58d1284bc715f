// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "simulate/depth_trials.hpp"

#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include "core/shared/whole_vectors.hpp"
#include "simulate/pixel_capture.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

namespace {

/// Pivoting is needed because rows may be linearly dependent.
void add_row_noise(Eigen::MatrixXd& covariance, const double* normals, double* value) {
  const Eigen::Index count = covariance.rows();
  std::array<Eigen::Index, max_measurements> order;
  std::iota(order.begin(), order.end(), Eigen::Index{0});
  for (Eigen::Index k = 0; k < count; ++k) {
    const auto at = [&](Eigen::Index i) { return order[static_cast<std::size_t>(i)]; };
    Eigen::Index largest = k;
    for (Eigen::Index i = k + 1; i < count; ++i)
      if (covariance(at(i), at(i)) > covariance(at(largest), at(largest))) largest = i;
    std::swap(order[static_cast<std::size_t>(k)], order[static_cast<std::size_t>(largest)]);
    const Eigen::Index pivot = at(k);
    const double variance = covariance(pivot, pivot);
    if (!(variance > 0.0)) return;
    const double noise = std::sqrt(variance) * normals[k];
    value[pivot] += noise;
    for (Eigen::Index a = k + 1; a < count; ++a) {
      const Eigen::Index i = at(a);
      const double part = covariance(i, pivot) / variance;
      value[i] += part * noise;
      for (Eigen::Index b = k + 1; b <= a; ++b) {
        const Eigen::Index j = at(b);
        covariance(i, j) -= part * covariance(j, pivot);
        covariance(j, i) = covariance(i, j);
      }
    }
  }
}

}  // namespace

RowTrials::RowTrials(const ForwardModel& model, const Camera& camera)
    : measurements_(model.measurements()),
      samples_(model.samples()),
      points_(points_per_bin * model.samples()),
      is_poisson_(camera.sensor.noise == NoiseModel::poisson),
      read_noise_e_(camera.sensor.read_noise_e) {
  const double exposure_s = model.tap_exposure_s()[0];
  if (is_poisson_) {
    const Eigen::VectorXd bin = exposure_s * model.time_bin_table(points_);
    of_signal_.assign(bin.begin(), bin.end());
    of_signal_.push_back(of_signal_.front());
    of_ambient_ = {exposure_s * model.tap_ambient_gain()[0]};
    of_dark_ = {model.expected_tap_electrons({}, 0.0)[0]};
    for (int n = 0; n < samples_; ++n)
      for (int k = 0; k < measurements_; ++k)
        weights_.push_back(static_cast<float>(model.readout()(k, n)));
    return;
  }
  const Eigen::MatrixXd mean = exposure_s * model.correlation_table(points_);
  const RowCovariance covariance = row_covariance(model, points_);
  for (Eigen::Index point = 0; point < points_; ++point) {
    of_signal_.insert(of_signal_.end(), mean.row(point).begin(), mean.row(point).end());
    of_signal_.insert(of_signal_.end(), covariance.signal.row(point).begin(),
                      covariance.signal.row(point).end());
  }
  const Eigen::VectorXd ambient = model.exposure_s().cwiseProduct(model.ambient_gain());
  of_ambient_.assign(ambient.begin(), ambient.end());
  of_ambient_.insert(of_ambient_.end(), covariance.ambient.begin(), covariance.ambient.end());
  const Eigen::VectorXd dark = model.dark_electrons();
  of_dark_.assign(dark.begin(), dark.end());
  of_dark_.insert(of_dark_.end(), covariance.floor.begin(), covariance.floor.end());
}

std::vector<double> RowTrials::beside_signal(double ambient_e_per_s) const {
  std::vector<double> sums;
  for (std::size_t i = 0; i < of_ambient_.size(); ++i)
    sums.push_back(ambient_e_per_s * of_ambient_[i] + of_dark_[i]);
  return sums;
}

void RowTrials::draw(const TrialStreams& streams, double ambient_e_per_s, int trials,
                     TrialTile& tile) const {
  if (is_poisson_)
    draw_poisson_rows(streams, ambient_e_per_s, trials, tile);
  else
    draw_normal_rows(ambient_e_per_s, trials, tile);
}

void RowTrials::draw_poisson_rows(const TrialStreams& streams, double ambient_e_per_s, int trials,
                                  TrialTile& tile) const {
  const double floor_e = beside_signal(ambient_e_per_s).front();
  const auto read_noise_e = static_cast<float>(read_noise_e_);
  for (int k = 0; k < measurements_; ++k)
    for (int i = 0; i < trials; ++i)
      tile.taps[k * trials_per_tile + i] = read_noise_e * tile.normals[k * trials_per_tile + i];
  std::array<double, trials_per_tile> mean, count;
  for (int n = 0; n < samples_; ++n) {
    for (int i = 0; i < trials; ++i) {
      int at = tile.row[i] - n * points_per_bin;
      if (at < 0) at += points_;
      const double* const below = &of_signal_[static_cast<std::size_t>(at)];
      const auto trial = static_cast<std::size_t>(i);
      mean[trial] = tile.signal[i] * (below[0] + tile.share[i] * (below[1] - below[0])) + floor_e;
    }
    draw_poisson(streams, n, trials, mean.data(), count.data());
    const float* const weight = weights_.data() + n * measurements_;
    for (int k = 0; k < measurements_; ++k) {
      if (weight[k] == 0.0f) continue;
      float* const sum = tile.taps + k * trials_per_tile;
      for (int i = 0; i < trials; ++i)
        sum[i] += weight[k] * static_cast<float>(count[static_cast<std::size_t>(i)]);
    }
  }
}

void RowTrials::draw_normal_rows(double ambient_e_per_s, int trials, TrialTile& tile) const {
  const std::vector<double> beside = beside_signal(ambient_e_per_s);
  std::vector<double> value(beside.size()), normals(static_cast<std::size_t>(measurements_));
  Eigen::MatrixXd covariance(measurements_, measurements_);
  for (int i = 0; i < trials; ++i) {
    const int row = tile.row[i], next = row + 1 < points_ ? row + 1 : 0;
    const double* const below = &of_signal_[static_cast<std::size_t>(row) * value.size()];
    const double* const above = &of_signal_[static_cast<std::size_t>(next) * value.size()];
    const double share = tile.share[i], signal = tile.signal[i];
    for (std::size_t n = 0; n < value.size(); ++n)
      value[n] = signal * ((1.0 - share) * below[n] + share * above[n]) + beside[n];
    const double* packed = value.data() + measurements_;
    for (int k = 0; k < measurements_; ++k) {
      normals[static_cast<std::size_t>(k)] = tile.normals[k * trials_per_tile + i];
      for (int l = 0; l <= k; ++l) covariance(k, l) = covariance(l, k) = *packed++;
    }
    add_row_noise(covariance, normals.data(), value.data());
    for (int k = 0; k < measurements_; ++k)
      tile.taps[k * trials_per_tile + i] = static_cast<float>(value[static_cast<std::size_t>(k)]);
  }
}

namespace {

/// Separate from the blocks of normals (from 0) and Poisson counts (from 2^30).
constexpr std::uint32_t albedo_block = 1u << 29;

EvaluateOptions with_even_trials(EvaluateOptions options) {
  options.validate();
  options.trials += options.trials % 2;
  options.max_trials += options.max_trials % 2;
  return options;
}

/// Maps uniform depths to the quantiles of a prior.
void move_depths(const TrialModel& model, const DepthPrior& prior, bool on_bins, int trials,
                 TrialTile& tile) {
  const double samples = model.samples();
  for (int i = 0; i < trials; ++i) {
    double bin = prior.quantile(tile.true_bin[i] / samples) * samples;
    bin = std::min(on_bins ? std::floor(bin) : bin, std::nextafter(samples, 0.0));
    const double at = bin * model.rows_per_bin(), row = std::floor(at);
    tile.true_bin[i] = bin;
    tile.row[i] = static_cast<std::int32_t>(row);
    tile.share[i] = static_cast<float>(at - row);
  }
}

/// An estimate if trials continue until a target is met.
std::int64_t all_trials(const EvaluateOptions& options, std::size_t points) {
  return static_cast<std::int64_t>(points) *
         (options.target_standard_error > 0.0 ? options.max_trials : options.trials);
}

}  // namespace

DepthTrials::DepthTrials(const ForwardModel& model, const Camera& camera,
                         const EvaluateOptions& options)
    : DepthTrials(model, camera, options, make_decoding_table(model, camera)) {}

DepthTrials::DepthTrials(const ForwardModel& model, const Camera& camera,
                         const EvaluateOptions& options, DecodingTable believed)
    : options_(with_even_trials(options)),
      uniform_albedo_(camera.operating.uniform_albedo),
      albedo_(camera.operating.albedo),
      depths_(camera),
      points_(camera.operating.points()),
      model_(model.has_rows() ? TrialModel(model) : TrialModel(model, camera)),
      believed_(std::move(believed)),
      decoder_(options.method, believed_, options.unwrap_weights,
               all_trials(options_, points_.size())) {
  if (model.has_rows()) {
    require(!options_.clip_to_open_sensor, "clip_to_open_sensor", "true",
            "cannot be combined with sensor.readout = \"rows\"");
    rows_.emplace(model, camera);
    return;
  }
  require(!camera.sensor.is_signed() || 2 * model_.taps() <= max_measurements, "measurements",
          model_.taps(), "must be at most 32 with sensor.demodulation = \"signed\"");
  const PlaneMap* map = decoder_.plane_map();
  const bool in_plane = map != nullptr && model_.is_linear() && !options_.clip_to_open_sensor &&
                        !options_.draw_every_measurement;
  for (const OperatingPoint& point : points_) {
    if (in_plane) plane_noise_.emplace_back(model_, *map, point.ambient_e_per_s);
    mean_floor_e_.push_back(in_floats(model_.mean_floor_e(point.ambient_e_per_s)));
    shot_floor_e2_.push_back(in_floats(model_.shot_floor_e2(point.ambient_e_per_s)));
    max_e_.emplace_back();
    if (options_.clip_to_open_sensor)
      max_e_.back() =
          in_floats((point.signal_e_per_s + point.ambient_e_per_s) * model_.exposure_s());
  }
}

DepthTrials::DepthTrials(const DecodingTable& table, const OperatingPoint& light,
                         const EvaluateOptions& options)
    : options_(with_even_trials(options)),
      points_{light},
      model_(table),
      believed_(table),
      decoder_(DecodeMethod::zncc, table, options.unwrap_weights, options_.trials) {
  plane_noise_.emplace_back(model_, *decoder_.plane_map(), light.ambient_e_per_s);
}

std::vector<TrialRound> DepthTrials::first_rounds() const {
  std::vector<TrialRound> rounds;
  for (std::size_t p = 0; p < points_.size(); ++p) rounds.push_back({p, 0, options_.trials});
  return rounds;
}

TrialBlock DepthTrials::run(const TrialRound& round, IndexRange trials, TrialTile& tile) const {
  const auto count = static_cast<int>(trials.end - trials.begin);
  const int drawn = whole_vectors(count);
  const TrialStreams streams{options_.seed, round.point,
                             static_cast<std::uint32_t>(round.first + trials.begin)};
  tile.pixels.pixels = count;

  const bool on_bins = options_.depth == DepthSampling::bins;
  // Depth in the trial's slice, and light.
  draw_words(streams, 0, drawn, tile.words);
  place_depths(model_,
               {.first = trials.begin,
                .rows_per_trial = model_.rows() / static_cast<double>(round.trials),
                .on_bins = on_bins && depths_.is_uniform()},
               drawn, tile);
  if (!depths_.is_uniform()) move_depths(model_, depths_, on_bins, drawn, tile);
  // Noise in the decoder's plane or of every measurement.
  if (draws_in_plane()) {
    const PlaneNoise& noise = plane_noise_[round.point];
    draw_normals(streams, noise.rank, drawn, tile);
    draw_signal(streams, round.point, drawn, tile);
    draw_plane(model_, noise, drawn, tile);
    decoder_.decode_plane(options_.sub_bin, tile.pixels, tile.decoded_bin);
  } else {
    draw_normals(streams, rows_ ? rows_->measurements() : model_.taps(), drawn, tile);
    draw_signal(streams, round.point, drawn, tile);
    draw_measurements(streams, round.point, drawn, tile);
    decoder_.decode_raw(tile.taps, options_.sub_bin, tile.pixels, tile.decoded_bin);
  }
  const auto size = static_cast<std::size_t>(count);
  return {{tile.true_bin, size}, {tile.decoded_bin, size}};
}

void DepthTrials::draw_normals(const TrialStreams& streams, int count, int trials,
                               TrialTile& tile) const {
  for (int pair = 0; 2 * pair < count; ++pair) {
    if (pair > 0 && pair % 2 == 0)
      draw_words(streams, static_cast<std::uint32_t>(pair / 2), trials, tile.words);
    const std::uint32_t* words = tile.words + pair % 2 * 2 * trials_per_tile;
    float* const rows = tile.normals + 2 * pair * trials_per_tile;
    normals_of(words, words + trials_per_tile, trials, rows, rows + trials_per_tile);
  }
}

void DepthTrials::draw_signal(const TrialStreams& streams, std::size_t point, int trials,
                              TrialTile& tile) const {
  const double signal_e_per_s = points_[point].signal_e_per_s;
  if (!uniform_albedo_) {
    std::fill_n(tile.signal, trials, static_cast<float>(albedo_ * signal_e_per_s));
    return;
  }
  draw_words(streams, albedo_block, trials, tile.words);
  for (int i = 0; i < trials; ++i)
    tile.signal[i] = static_cast<float>((tile.words[i] + 0.5) * 0x1p-32 * signal_e_per_s);
}

void DepthTrials::draw_signed(const TrialStreams& streams, int trials, TrialTile& tile) const {
  const int numbers = model_.taps();
  for (int k = 0; k < numbers; ++k) {
    float* const row = tile.taps + k * trials_per_tile;
    const float* const shot = row + numbers * trials_per_tile;
    std::array<double, trials_per_tile> plus, minus, size, drawn_plus, drawn_minus;
    for (std::size_t i = 0; i < static_cast<std::size_t>(trials); ++i) {
      const SignedElectrons e = SignedElectrons::of(double{row[i]}, double{shot[i]});
      plus[i] = e.plus, minus[i] = e.minus, size[i] = e.size;
    }
    draw_poisson(streams, 2 * k, trials, plus.data(), drawn_plus.data());
    draw_poisson(streams, 2 * k + 1, trials, minus.data(), drawn_minus.data());
    for (std::size_t i = 0; i < static_cast<std::size_t>(trials); ++i)
      row[i] = static_cast<float>(size[i] * (drawn_plus[i] - drawn_minus[i]));
  }
}

void DepthTrials::draw_measurements(const TrialStreams& streams, std::size_t point, int trials,
                                    TrialTile& tile) const {
  if (rows_) return rows_->draw(streams, points_[point].ambient_e_per_s, trials, tile);
  expect_electrons(model_, mean_floor_e_[point], shot_floor_e2_[point], trials, tile);
  if (model_.conversion().is_poisson && model_.conversion().is_signed)
    draw_signed(streams, trials, tile);
  else if (model_.conversion().is_poisson)
    for (int k = 0; k < model_.taps(); ++k) {
      std::array<double, trials_per_tile> mean, count;
      float* const row = tile.taps + k * trials_per_tile;
      std::copy_n(row, trials, mean.begin());
      draw_poisson(streams, k, trials, mean.data(), count.data());
      for (std::size_t i = 0; i < static_cast<std::size_t>(trials); ++i)
        row[i] = static_cast<float>(count[i]);
    }
  read_out_taps(model_, max_e_[point], trials, tile);
}

}  // namespace tofsmith
