// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "decode/unwrap/phase_model.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <numeric>
#include <set>

#include "core/shared/decompositions.hpp"
#include "core/shared/periodic.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

namespace {

// Relative limits below which a residual is a rounding error.
constexpr double no_variation = 1e-10;
constexpr double no_offset = 1e-9;
constexpr double no_second_phase = 1e-6;
/// Relative distance of c from a multiple of kappa due to small asymmetries.
constexpr double same_offset = 1e-3;

struct Harmonic {
  int frequency = 0;  ///< 0: constant
  double mean = 0.0;
  std::complex<double> coefficient;
};

Harmonic harmonic_of(const Eigen::VectorXd& correlation, int measurement,
                     double largest_other_energy) {
  Eigen::VectorXcd spectrum;
  PeriodicTransform(static_cast<int>(correlation.size())).forward(correlation, spectrum);
  spectrum /= static_cast<double>(correlation.size());
  Harmonic found{.mean = spectrum[0].real()};
  if (spectrum.size() < 2) return found;
  Eigen::VectorXd energy = spectrum.tail(spectrum.size() - 1).cwiseAbs2();
  if (correlation.size() % 2 == 0) energy[energy.size() - 1] /= 2;  // Nyquist
  const double whole = energy.sum();
  if (whole <= no_variation * no_variation * correlation.squaredNorm()) return found;
  Eigen::Index strongest = 0;
  const double other = 1.0 - energy.maxCoeff(&strongest) / whole;
  found.frequency = static_cast<int>(strongest) + 1;
  found.coefficient = spectrum[found.frequency];
  require(other <= largest_other_energy, fmt::format("correlation of measurement {}", measurement),
          fmt::format("{:.3g} % of its energy outside harmonic {}", 100 * other, found.frequency),
          fmt::format("must be at most {:.3g} %: phase unwrapping requires sinusoids",
                      100 * largest_other_energy));
  return found;
}

/// Returns true if the measurements differ in more than amplitude and sign.
bool sees_two_phases(const std::vector<Harmonic>& harmonics, int frequency) {
  std::vector<std::complex<double>> seen;
  for (const Harmonic& h : harmonics)
    if (h.frequency == frequency) seen.push_back(h.coefficient);
  Eigen::MatrixXd parts(static_cast<Eigen::Index>(seen.size()), 2);
  for (std::size_t i = 0; i < seen.size(); ++i)
    parts.row(static_cast<Eigen::Index>(i)) << seen[i].real(), seen[i].imag();
  const Eigen::VectorXd values = thin_svd(parts).values;
  return values.size() == 2 && values[1] > no_second_phase * values[0];
}

/// Possible offsets as columns: none if ambient light cancels, one for most codes.
Eigen::MatrixXd offset_columns(const DecodingTable& table, const Eigen::VectorXd& means) {
  const Eigen::VectorXd of_ambient = table.exposure_s.cwiseProduct(table.ambient_gain);
  const Eigen::VectorXd of_signal = table.exposure_s.cwiseProduct(means);
  const double nothing = no_offset * table.exposure_s.norm();
  Eigen::MatrixXd columns(table.measurements(), 2);
  Eigen::Index count = 0;
  if (of_ambient.norm() > nothing) columns.col(count++) = of_ambient.normalized();
  Eigen::VectorXd rest = of_signal;
  if (count == 1) rest -= columns.col(0) * columns.col(0).dot(of_signal);
  if (rest.norm() > std::max(nothing, same_offset * of_signal.norm()))
    columns.col(count++) = rest.normalized();
  return columns.leftCols(count);
}

}  // namespace

PhaseModel::PhaseModel(const DecodingTable& table, double largest_other_energy) {
  std::vector<Harmonic> harmonics;
  Eigen::VectorXd means(table.measurements());
  std::set<int> found;
  for (int k = 0; k < table.measurements(); ++k) {
    harmonics.push_back(harmonic_of(table.correlation.col(k), k, largest_other_energy));
    means[k] = harmonics.back().mean;
    if (harmonics.back().frequency > 0) found.insert(harmonics.back().frequency);
  }
  frequencies_.assign(found.begin(), found.end());
  for (const int frequency : frequencies_)
    require(sees_two_phases(harmonics, frequency), fmt::format("phases of harmonic {}", frequency),
            "one", "must be two or more that are not half a period apart");

  int common = 0;
  for (const int frequency : frequencies_) common = std::gcd(common, frequency);
  require(common == 1, "frequencies", fmt::format("{}", fmt::join(frequencies_, ", ")),
          fmt::format("must have no common divisor: depth repeats after {:.4g} of {:.4g} m",
                      table.range_m / std::max(common, 1), table.range_m));

  // Columns: the offset, then 2 T Re C and -2 T Im C for each frequency, normalized because the
  // camera may attenuate high frequencies.
  const Eigen::MatrixXd offsets = offset_columns(table, means);
  Eigen::MatrixXd system =
      Eigen::MatrixXd::Zero(table.measurements(), offsets.cols() + 2 * count());
  system.leftCols(offsets.cols()) = offsets;
  for (int j = 0; j < count(); ++j)
    for (int k = 0; k < table.measurements(); ++k) {
      const Harmonic& h = harmonics[static_cast<std::size_t>(k)];
      if (h.frequency != frequencies_[static_cast<std::size_t>(j)]) continue;
      const std::complex<double> c = 2 * table.exposure_s[k] * h.coefficient;
      system(k, offsets.cols() + 2 * j) = c.real();
      system(k, offsets.cols() + 2 * j + 1) = -c.imag();
    }
  const Eigen::RowVectorXd lengths = system.colwise().norm();
  system.array().rowwise() /= lengths.array();
  const auto [rank, inverse] = pseudo_inverse(system, no_offset);
  require(rank == system.cols(), "measurements", table.measurements(),
          fmt::format("must determine {} unknowns (two per frequency and {} for the offset of "
                      "signal and ambient light); use 3 phases for one frequency",
                      system.cols(), offsets.cols()));
  gain_.resize(count(), table.measurements());
  for (int j = 0; j < count(); ++j) {
    const Eigen::Index row = offsets.cols() + 2 * j;
    gain_.row(j).real() = inverse.row(row) / lengths[row];
    gain_.row(j).imag() = inverse.row(row + 1) / lengths[row + 1];
  }
}

void PhaseModel::phasors(const double* electrons, std::complex<double>* phasor) const {
  for (int j = 0; j < count(); ++j) {
    std::complex<double> sum = 0.0;
    for (Eigen::Index k = 0; k < gain_.cols(); ++k) sum += gain_(j, k) * electrons[k];
    phasor[j] = sum;
  }
}

}  // namespace tofsmith
