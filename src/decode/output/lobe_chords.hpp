// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace tofsmith {

/// Posterior probability of positions on the chords between bins, inside and outside a main lobe.
/// On a chord the signal in standard deviations is c = rho cos(theta - theta_0); for strong signals
/// the density exp(c^2 / 2) sqrt(2 pi) / c is nearly a Gaussian of standard deviation 1 / rho.
class ChordMass {
 public:
  /// Adds a chord of one bin, unless its probability is below exp(-40) of the total.
  /// @param from, to  c at both ends
  /// @param cosine    of the angle between both ends
  void add_chord(double from, double to, double cosine, bool is_inside);
  /// Adds half a bin at each of two unconnected bins.
  void add_ends(double from, double to, bool is_inside);

  double share_inside() const;

 private:
  /// Adds factor exp(c^2 / 2).
  void add(double c, double factor, bool is_inside);

  double peak_ = 0.0;  // reference c^2 / 2 of all sums
  double inside_ = 0.0;
  double outside_ = 0.0;
};

}  // namespace tofsmith
