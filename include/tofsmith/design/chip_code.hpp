// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tofsmith/camera/camera.hpp"
#include "tofsmith/code/code_set.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

/// One binary waveform on a chip clock: bit k is set if it is on during chip k.
using ChipWord = std::uint32_t;

/// Most chips of a period that a word holds here.
inline constexpr int most_chips = 24;

/// The word, `shift` chips later on a circle of `chips`. Any shift.
ChipWord delayed_chips(ChipWord word, int shift, int chips);
/// The word played backwards: chip k becomes chip -k.
ChipWord reversed_chips(ChipWord word, int chips);
/// Every chip.
constexpr ChipWord all_chips(int chips) { return (ChipWord{1} << chips) - 1; }
/// "110" for a word of three chips that is on during the first two.
std::string chip_text(ChipWord word, int chips);
/// The word of such a text. @throws std::invalid_argument for other characters or lengths
ChipWord chip_word(std::string_view text);

/// A code of a camera with a chip clock: every waveform is on or off for whole chips, and at most
/// one tap of an exposure is open at a time.
struct ChipCode {
  int chips = 0;                       ///< n, per period
  int taps = 0;                        ///< t, per exposure
  std::vector<ChipWord> modulation;    ///< (E)
  std::vector<ChipWord> demodulation;  ///< (E x t), exposure by exposure

  int exposures() const { return static_cast<int>(modulation.size()); }
  int measurements() const { return static_cast<int>(demodulation.size()); }
  /// The words of one exposure's taps begin here.
  const ChipWord* taps_of(int exposure) const;
  /// chi of a measurement at a depth of `shift` chips: chips in which light falls on the open tap.
  int correlation(int measurement, int shift) const;
  /// "M 110000 D 110000/001100/000011", exposures parted by ", ".
  std::string text() const;

  /// @throws std::invalid_argument naming the word and the rule it breaks
  void validate() const;

  friend bool operator==(const ChipCode&, const ChipCode&) = default;
};

/// Why a camera has no chip clock: no shortest pulse, or a period that is not a whole number of
/// them, 3 .. most_chips. None: it has one.
std::optional<BrokenRule> why_no_chip_clock(const Camera& camera);

/// Chips per period of a camera's clock: period / sensor.shortest_pulse_s.
/// @throws std::invalid_argument as why_no_chip_clock()
int chips_of(const Camera& camera);

/// Level at which a modulation that is on for `on_chips` plays, over average power: the camera's
/// peak, or what the average allows. With light.peak_factor = 1 it is 1, *peak* power is what is
/// fixed, and S is the rate at peak light; with more, mean power is fixed as soon as peak allows.
double chip_level(int on_chips, int chips, double peak_factor);

/// The code as waveforms, at the camera's levels and samples.
CodeSet to_code_set(const ChipCode& code, const Camera& camera, const std::string& name);

/// The camera with a clock and taps as the code has them and samples that hold whole chips (the
/// next multiple at or above the camera's own): what the code is judged on.
Camera camera_for(const ChipCode& code, Camera camera);

/// The camera, judged at one operating point.
Camera at_point(Camera camera, const OperatingPoint& point);

}  // namespace tofsmith
