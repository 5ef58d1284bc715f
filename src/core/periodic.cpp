// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "core/shared/periodic.hpp"

#include <algorithm>
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

namespace {

/// Next product of 2, 3 and 5, for fast transforms.
int fast_length(int least) {
  for (int length = least;; ++length) {
    int rest = length;
    for (const int factor : {2, 3, 5})
      while (rest % factor == 0) rest /= factor;
    if (rest == 1) return length;
  }
}

int reach(int kernel_size, int image_size) { return std::min(kernel_size / 2, image_size - 1); }

}  // namespace

PaddedConvolution::PaddedConvolution(const Image<float>& kernel, int height, int width)
    : height_(height),
      width_(width),
      along_row_(fast_length(width + reach(kernel.width, width))),
      along_column_(fast_length(height + reach(kernel.height, height))) {
  require(kernel.height % 2 == 1 && kernel.width % 2 == 1, "kernel size", kernel.height,
          "must be odd in rows and columns");
  const int rows = along_column_.samples(), columns = along_row_.samples();
  const int up = reach(kernel.height, height), left = reach(kernel.width, width);
  Eigen::MatrixXd wrapped = Eigen::MatrixXd::Zero(rows, columns);
  for (int v = -up; v <= up; ++v)
    for (int u = -left; u <= left; ++u)
      wrapped((v + rows) % rows, (u + columns) % columns) =
          static_cast<double>(kernel(kernel.height / 2 + v, kernel.width / 2 + u));
  const Halves halves = of_rows(wrapped, rows);
  real_.resize(along_column_.coefficients(), along_row_.coefficients());
  imaginary_.resizeLike(real_);
  Eigen::VectorXcd spectrum;
  for (Eigen::Index c = 0; c < real_.cols(); ++c) {
    along_column_.forward(halves.real.col(c), spectrum);
    real_.col(c) = spectrum;
    along_column_.forward(halves.imaginary.col(c), spectrum);
    imaginary_.col(c) = spectrum;
  }
}

PaddedConvolution::Halves PaddedConvolution::of_rows(const Eigen::MatrixXd& padded,
                                                     int rows) const {
  Halves halves{Eigen::MatrixXd::Zero(along_column_.samples(), along_row_.coefficients()),
                Eigen::MatrixXd::Zero(along_column_.samples(), along_row_.coefficients())};
  Eigen::VectorXcd spectrum;
  for (Eigen::Index v = 0; v < rows; ++v) {
    along_row_.forward(padded.row(v).transpose(), spectrum);
    halves.real.row(v) = spectrum.real().transpose();
    halves.imaginary.row(v) = spectrum.imag().transpose();
  }
  return halves;
}

Image<float> PaddedConvolution::apply(const Image<float>& image) const {
  TOFSMITH_ASSERT_EQ(image.height, height_);
  TOFSMITH_ASSERT_EQ(image.width, width_);
  Eigen::MatrixXd padded = Eigen::MatrixXd::Zero(height_, along_row_.samples());
  for (int v = 0; v < height_; ++v)
    for (int u = 0; u < width_; ++u) padded(v, u) = static_cast<double>(image(v, u));
  Halves halves = of_rows(padded, height_);
  // Column a + i b times kernel c + i d, with transforms a, b, c and d of real signals.
  Eigen::VectorXcd a, b;
  Eigen::VectorXd values;
  for (Eigen::Index c = 0; c < real_.cols(); ++c) {
    along_column_.forward(halves.real.col(c), a);
    along_column_.forward(halves.imaginary.col(c), b);
    const auto real = real_.col(c), imaginary = imaginary_.col(c);
    along_column_.inverse(a.cwiseProduct(real) - b.cwiseProduct(imaginary), values);
    halves.real.col(c) = values;
    along_column_.inverse(a.cwiseProduct(imaginary) + b.cwiseProduct(real), values);
    halves.imaginary.col(c) = values;
  }
  Image<float> result(height_, width_);
  Eigen::VectorXcd spectrum(along_row_.coefficients());
  for (int v = 0; v < height_; ++v) {
    spectrum.real() = halves.real.row(v).transpose();
    spectrum.imag() = halves.imaginary.row(v).transpose();
    along_row_.inverse(spectrum, values);
    for (int u = 0; u < width_; ++u) result(v, u) = static_cast<float>(values[u]);
  }
  return result;
}

double PaddedConvolution::bytes(const Image<float>& kernel, int height, int width) {
  const double rows = fast_length(height + reach(kernel.height, height));
  const double columns = fast_length(width + reach(kernel.width, width));
  return 24.0 * rows * columns;  // kernel, and halves of the image
}

}  // namespace tofsmith
