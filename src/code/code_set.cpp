// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/code/code_set.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "code/shared/exposure_groups.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

namespace {
// For rounding in files and refinements; far below any effect on depth.
constexpr double tolerance = 1e-9;

void check_modulation(const Waveform& waveform, int exposure) {
  const std::string name = fmt::format("modulation {}", exposure);
  require(waveform.minimum() >= -tolerance, name + " minimum", waveform.minimum(), "must be >= 0");
  require(waveform.mean() <= 1.0 + tolerance, name + " mean", waveform.mean(),
          "must be <= 1: modulation is power over average power");
}

void check_demodulation(const Waveform& waveform, int measurement) {
  const std::string name = fmt::format("demodulation {}", measurement);
  require(waveform.minimum() >= -tolerance, name + " minimum", waveform.minimum(),
          "must be >= 0: demodulation is a gain in [0, 1]");
  require(waveform.peak() <= 1.0 + tolerance, name + " peak", waveform.peak(),
          "must be <= 1: demodulation is a gain in [0, 1]");
}
}  // namespace

CodeSet CodeSet::create(std::string name, int samples, int taps, std::vector<Waveform> modulation,
                        std::vector<Waveform> demodulation) {
  require(samples >= 2, "samples", samples, "must be >= 2");
  require(taps >= 1, "taps", taps, "must be >= 1");
  require(!modulation.empty(), "number of modulation functions", modulation.size(), "must be >= 1");
  require(demodulation.size() == modulation.size() * static_cast<std::size_t>(taps),
          "number of demodulation functions", demodulation.size(),
          fmt::format("must be exposures x taps = {} x {}", modulation.size(), taps));
  const auto check_length = [&](const Waveform& w, const char* kind, std::size_t i) {
    require(!w.is_sampled() || w.samples().size() == samples, fmt::format("{} {} length", kind, i),
            w.samples().size(), fmt::format("must equal samples = {}", samples));
  };
  for (std::size_t e = 0; e < modulation.size(); ++e) {
    check_length(modulation[e], "modulation", e);
    check_modulation(modulation[e], static_cast<int>(e));
  }
  for (std::size_t i = 0; i < demodulation.size(); ++i) {
    check_length(demodulation[i], "demodulation", i);
    check_demodulation(demodulation[i], static_cast<int>(i));
  }
  for (std::size_t e = 0; taps > 1 && e < modulation.size(); ++e) {
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(samples);
    for (int t = 0; t < taps; ++t)
      sum += demodulation[e * static_cast<std::size_t>(taps) + static_cast<std::size_t>(t)]
                 .cell_averages(samples);
    require(sum.maxCoeff() <= 1.0 + 1e-6, fmt::format("sum over taps of exposure {}", e),
            sum.maxCoeff(), "must be <= 1: each electron is collected by one tap");
  }
  CodeSet code;
  code.name_ = std::move(name);
  code.samples_ = samples;
  code.taps_ = taps;
  code.modulation_ = std::move(modulation);
  code.demodulation_ = std::move(demodulation);
  return code;
}

CodeSet CodeSet::create_rows(std::string name, Waveform light, const Eigen::MatrixXd& rows) {
  const Eigen::Index samples = rows.rows();
  require(samples >= 2, "time bins of the rows", samples, "must be >= 2");
  require(rows.cols() >= 2 && rows.cols() <= max_exposure_rows, "number of rows", rows.cols(),
          fmt::format("must be in [2, {}]", max_exposure_rows));
  require(!light.is_sampled() || light.samples().size() == samples, "light length",
          light.samples().size(), fmt::format("must equal the time bins of the rows, {}", samples));
  check_modulation(light, 0);
  require(light.mean() > 0.0, "light mean", light.mean(), "must be > 0");
  CodeSet code;
  for (Eigen::Index k = 0; k < rows.cols(); ++k) {
    require(!rows.col(k).isZero(0.0), fmt::format("row {}", k), "all zero",
            "must have a nonzero weight");
    code.demodulation_.push_back(Waveform::sampled(rows.col(k)));
  }
  code.name_ = std::move(name);
  code.samples_ = static_cast<int>(samples);
  code.taps_ = static_cast<int>(rows.cols());
  code.is_rows_ = true;
  code.modulation_ = {std::move(light)};
  return code;
}

CodeSet CodeSet::create_rows(std::string name, const Eigen::VectorXd& light, Eigen::MatrixXd rows) {
  require(light.size() > 0 && light.allFinite(), "light", "empty, NaN or infinite",
          "must be finite and not empty");
  require(light.minCoeff() >= 0.0, "light minimum", light.minCoeff(), "must not be negative");
  require(light.mean() > 0.0, "light mean", light.mean(), "must be > 0");
  if (rows.rows() != light.size() && rows.cols() == light.size()) rows.transposeInPlace();
  return create_rows(std::move(name), Waveform::sampled(light / light.mean()), rows);
}

CodeSet CodeSet::create_signed(std::string name, std::vector<Waveform> modulation,
                               const Eigen::MatrixXd& weights) {
  std::vector<Waveform> drive;
  for (Eigen::Index i = 0; i < weights.cols(); ++i) {
    const Eigen::ArrayXd w = weights.col(i);
    for (Eigen::Index n = 0; n < w.size(); ++n)
      require(std::abs(w[n]) <= 1.0 + tolerance, fmt::format("demodulation {}[{}]", i, n), w[n],
              "must be a weight in [-1, 1]");
    const bool switches = ((w.abs() - 1.0).abs() <= tolerance).all();
    const Eigen::VectorXd x = (0.5 * (w + 1.0)).max(0.0).min(1.0);
    drive.push_back(!switches            ? Waveform::sampled(x)
                    : x.maxCoeff() > 0.5 ? Waveform::binary_from_samples(x, 1.0)
                                         : Waveform::constant(0.0));
  }
  return create(std::move(name), static_cast<int>(weights.rows()), 1, std::move(modulation),
                std::move(drive))
      .with_signed_weights();
}

bool CodeSet::is_binary() const {
  const auto binary = [](const Waveform& waveform) { return waveform.is_binary(); };
  return std::all_of(modulation_.begin(), modulation_.end(), binary) &&
         std::all_of(demodulation_.begin(), demodulation_.end(), binary);
}

double CodeSet::peak() const {
  double peak = 0.0;
  for (const Waveform& m : modulation_) peak = std::max(peak, m.peak());
  return peak;
}

Eigen::MatrixXd CodeSet::modulation_samples() const {
  Eigen::MatrixXd columns(samples_, exposures());
  for (int e = 0; e < exposures(); ++e) columns.col(e) = modulation(e).cell_averages(samples_);
  return columns;
}

Eigen::MatrixXd CodeSet::demodulation_samples() const {
  Eigen::MatrixXd columns(samples_, measurements());
  for (int i = 0; i < measurements(); ++i) columns.col(i) = demodulation(i).cell_averages(samples_);
  if (is_signed_) columns = (2.0 * columns.array() - 1.0).matrix().eval();
  return columns;
}

std::vector<int> CodeSet::frequency_starts() const {
  std::vector<int> starts;
  for (int e = 0; e < exposures(); ++e)
    if (e == 0 || !(modulation(e) == modulation(e - 1))) starts.push_back(e);
  return starts;
}

CodeSet CodeSet::renamed(std::string name) const {
  CodeSet copy = *this;
  copy.name_ = std::move(name);
  return copy;
}

CodeSet CodeSet::resampled(int samples) const {
  CodeSet copy = *this;
  copy.samples_ = samples;
  for (auto* waveforms : {&copy.modulation_, &copy.demodulation_})
    for (Waveform& w : *waveforms)
      if (w.is_sampled()) w = Waveform::sampled(w.cell_averages(samples));
  return copy;
}

CodeSet CodeSet::rotated(int rotation_bin) const {
  CodeSet copy = *this;
  for (Waveform& m : copy.modulation_)
    m = m.delayed(static_cast<double>(rotation_bin) / static_cast<double>(samples_));
  return copy;
}

CodeSet CodeSet::with_exposure_shares(std::vector<double> shares) const {
  require(shares.empty() || shares.size() == static_cast<std::size_t>(exposures()),
          "number of exposure_shares", shares.size(),
          fmt::format("must equal the {} exposures", exposures()));
  double sum = 0.0;
  for (const double share : shares) {
    require(std::isfinite(share) && share > 0.0, "exposure_shares", share, "must be > 0");
    sum += share;
  }
  require(shares.empty() || std::abs(sum - 1.0) <= tolerance, "sum of exposure_shares", sum,
          "must be 1");
  const bool are_alike = std::all_of(shares.begin(), shares.end(), [&](double share) {
    return std::abs(share - shares.front()) <= tolerance;
  });
  CodeSet copy = *this;
  copy.exposure_shares_ = are_alike ? std::vector<double>() : std::move(shares);
  return copy;
}

CodeSet CodeSet::with_exposure_order(const std::vector<int>& order) const {
  std::vector<int> sorted = order, all(static_cast<std::size_t>(exposures()));
  std::sort(sorted.begin(), sorted.end());
  std::iota(all.begin(), all.end(), 0);
  require(sorted == all, "exposure order", fmt::format("{}", fmt::join(order, ", ")),
          fmt::format("must list each of the {} exposures once, from 0", exposures()));
  CodeSet copy = *this;
  copy.modulation_ = in_exposure_order(modulation_, order);
  copy.demodulation_ = in_exposure_order(demodulation_, order);
  copy.exposure_shares_ = in_exposure_order(exposure_shares_, order);
  copy.provenance.residuals = in_exposure_order(provenance.residuals, order);
  return copy;
}

CodeSet CodeSet::with_two_buckets() const {
  require(taps_ == 1 && !is_signed_, "taps", is_signed_ ? "of a mixer" : fmt::format("{}", taps_),
          "must be 1: a second bucket can only be added to codes for one tap");
  std::vector<Waveform> demodulation;
  for (const Waveform& d : demodulation_) {
    demodulation.push_back(d);
    demodulation.push_back(d.complement());
  }
  CodeSet code = create(name_, samples_, 2, modulation_, std::move(demodulation));
  code.exposure_shares_ = exposure_shares_;
  code.provenance = provenance;
  return code;
}

CodeSet CodeSet::with_signed_weights() const {
  require(taps_ == 1 && !is_rows_, "taps", taps_,
          "must be 1: only codes for one tap can be converted to a mixer");
  for (int i = 0; i < measurements(); ++i)
    require(!demodulation(i).is_binary() || demodulation(i).on_intervals().empty() ||
                std::abs(demodulation(i).level() - 1.0) <= tolerance,
            fmt::format("demodulation {} level", i), demodulation(i).level(),
            "must be 1 for a mixer, which switches between -1 and 1");
  CodeSet code = *this;
  code.is_signed_ = true;
  return code;
}

CodeSet CodeSet::signed_of_buckets() const {
  require(taps_ == 2, "taps", taps_,
          "must be 2: only codes for two buckets can be converted to a mixer");
  std::vector<Waveform> drive;
  for (int i = 0; i < measurements(); i += 2) {
    const Eigen::VectorXd sum =
        demodulation(i).cell_averages(samples_) + demodulation(i + 1).cell_averages(samples_);
    const double farthest = (sum.array() - 1.0).abs().maxCoeff();
    require(farthest <= 1e-6, fmt::format("sum over taps of exposure {}", i / 2), 1.0 - farthest,
            "must be 1 for a mixer");
    drive.push_back(demodulation(i));
  }
  CodeSet code = create(name_, samples_, 1, modulation_, std::move(drive)).with_signed_weights();
  code.exposure_shares_ = exposure_shares_;
  code.provenance = provenance;
  return code;
}

CodeSet CodeSet::buckets_of_signed() const {
  require(is_signed_, "code", name_, "must be a code for a mixer");
  CodeSet code = *this;
  code.is_signed_ = false;
  return code.with_two_buckets();
}

}  // namespace tofsmith
