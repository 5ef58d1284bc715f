// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace tofsmith {

/// Posterior mass of places on chords between bins, in closed form, inside and outside a main lobe.
/// On a chord the signal in units of its standard deviation is c = rho cos(theta - theta_0), and
/// the density exp(c^2 / 2) sqrt(2 pi) / c falls like a Gaussian of deviation 1 / rho around
/// theta_0. For signals of many deviations.
class ChordMass {
 public:
  /// Adds a chord of one bin, unless it holds less than exp(-40) of the present mass.
  /// @param from, to  c at its ends
  /// @param cosine    of the angle between its ends
  void add_chord(double from, double to, double cosine, bool is_inside);
  /// Adds two bins with nothing between them, half a bin each.
  void add_ends(double from, double to, bool is_inside);

  double share_inside() const;

 private:
  /// Adds factor exp(c^2 / 2).
  void add(double c, double factor, bool is_inside);

  double peak_ = 0.0;  // c^2 / 2 that masses are relative to
  double inside_ = 0.0;
  double outside_ = 0.0;
};

}  // namespace tofsmith
