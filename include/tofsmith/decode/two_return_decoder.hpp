// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tofsmith/decode/multipath_decoder.hpp"

namespace tofsmith {

/// Direct depth of pixels into which light may come back twice:
///   y' = electrons - dark = T o (S1 chi(z) + S2 chi(z + delta) + A kappa) + noise,  S1 >= S2 >= 0.
///
/// The fast Decoder fits one return. Its chi^2, weighted by the noise of the measurements and
/// counted in the dimensions the code spans (what ambient light explains left out), is all that a
/// second return could explain: up to the threshold the pixel is single and keeps what Decoder
/// says. Else two returns are fitted by weighted least squares, the likelihood of normal noise: all
/// pairs of coarse places are tried in closed form, the best three followed by Levenberg-Marquardt
/// on (z, delta). Two returns are accepted if chi^2 falls by more than the threshold below the best
/// single return's anywhere. S2 <= S1 is needed: without it a phantom early return explains pixels
/// of one return.
///
/// The noise of a measurement is taken from itself: max(y', 0) + dark + constant variance. Curves
/// between bins are drawn by cubics where that foretells the table better than chords do.
///
/// @see docs/multipath.md
class TwoReturnDecoder : public MultipathDecoder {
 public:
  /// @throws std::invalid_argument if table or options are invalid, or the code holds too few
  ///         independent means: fewer than 6 (5 where ambient light cancels), as codes of two
  ///         frequencies do
  explicit TwoReturnDecoder(DecodingTable table, const MultipathOptions& options = {});

  /// Why two returns cannot be told apart with a table whose numbers are in order: no depth can be
  /// told at all, or there are too few independent means. None: they can, well or badly.
  static std::optional<std::string> why_not_decodable(const DecodingTable& table);
};

}  // namespace tofsmith
