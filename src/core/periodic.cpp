// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "core/shared/periodic.hpp"

#include <cmath>
#include <unsupported/Eigen/FFT>

#include "tofsmith/core/error.hpp"

namespace tofsmith {

namespace {
/// Eigen's transform caches plans with scratch space, so it must not be shared between threads.
Eigen::FFT<double>& plans_of_this_thread() {
#ifdef EIGEN_FFTW_DEFAULT
  // All threads share FFTW's planner.
  static const bool planner_is_safe = (fftw_make_planner_thread_safe(), true);
  static_cast<void>(planner_is_safe);
#endif
  thread_local Eigen::FFT<double> fft{Eigen::default_fft_impl<double>(),
                                      Eigen::FFT<double>::HalfSpectrum};
  return fft;
}
}  // namespace

PeriodicTransform::PeriodicTransform(int samples) : samples_(samples) {
  require(samples >= 1, "samples", samples, "must be >= 1");
}

void PeriodicTransform::forward(const Eigen::VectorXd& signal, Eigen::VectorXcd& spectrum) const {
  TOFSMITH_ASSERT_EQ(signal.size(), samples_);
  spectrum.resize(coefficients());
  if (samples_ == 1) {
    spectrum[0] = signal[0];
    return;
  }
  plans_of_this_thread().fwd(spectrum.data(), signal.data(), samples_);
}

void PeriodicTransform::inverse(const Eigen::VectorXcd& spectrum, Eigen::VectorXd& signal) const {
  TOFSMITH_ASSERT_EQ(spectrum.size(), coefficients());
  signal.resize(samples_);
  if (samples_ == 1) {
    signal[0] = spectrum[0].real();
    return;
  }
  plans_of_this_thread().inv(signal.data(), spectrum.data(), samples_);
}

namespace {
template <typename Combine>
Eigen::VectorXd through_spectrum(const Eigen::VectorXd& a, const Eigen::VectorXd& b,
                                 Combine&& combine) {
  require(a.size() == b.size(), "length of the second signal", b.size(),
          "must equal the first signal's, " + std::to_string(a.size()));
  const PeriodicTransform transform(static_cast<int>(a.size()));
  Eigen::VectorXcd spectrum_a, spectrum_b;
  transform.forward(a, spectrum_a);
  transform.forward(b, spectrum_b);
  const Eigen::VectorXcd product = combine(spectrum_a, spectrum_b);
  Eigen::VectorXd result;
  transform.inverse(product, result);
  return result;
}
}  // namespace

Eigen::VectorXd circular_convolution(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  return through_spectrum(a, b, [](const Eigen::VectorXcd& A, const Eigen::VectorXcd& B) {
    return Eigen::VectorXcd(A.cwiseProduct(B));
  });
}

Eigen::VectorXd circular_correlation(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  return through_spectrum(a, b, [](const Eigen::VectorXcd& A, const Eigen::VectorXcd& B) {
    return Eigen::VectorXcd(A.cwiseProduct(B.conjugate()));
  });
}

double circular_total_variation(const Eigen::VectorXd& x) {
  if (x.size() == 0) return 0.0;
  double sum = std::abs(x[0] - x[x.size() - 1]);
  for (Eigen::Index n = 1; n < x.size(); ++n) sum += std::abs(x[n] - x[n - 1]);
  return sum;
}

Eigen::VectorXd circular_shift(const Eigen::VectorXd& x, int shift) {
  const Eigen::Index size = x.size();
  Eigen::VectorXd shifted(size);
  for (Eigen::Index n = 0; n < size; ++n) shifted[(((n + shift) % size) + size) % size] = x[n];
  return shifted;
}

}  // namespace tofsmith
