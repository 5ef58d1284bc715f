// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace tofsmith {

/// Posterior probability of positions on the chords between bins, in closed form, inside and
/// outside a main lobe. On a chord the signal in units of its standard deviation is c = rho
/// cos(theta - theta_0). The density exp(c^2 / 2) sqrt(2 pi) / c is approximately a Gaussian of
/// standard deviation 1 / rho around theta_0, for signals of many standard deviations.
class ChordMass {
 public:
  /// Adds a chord of one bin, unless its probability is below exp(-40) of the current total.
  /// @param from, to  c at both ends
  /// @param cosine    cosine of the angle between both ends
  void add_chord(double from, double to, double cosine, bool is_inside);
  /// Adds half a bin at each of two bins that are not connected by a chord.
  void add_ends(double from, double to, bool is_inside);

  double share_inside() const;

 private:
  /// Adds factor exp(c^2 / 2).
  void add(double c, double factor, bool is_inside);

  double peak_ = 0.0;  // c^2 / 2 of the reference for all sums
  double inside_ = 0.0;
  double outside_ = 0.0;
};

}  // namespace tofsmith
