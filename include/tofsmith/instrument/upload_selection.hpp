// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "tofsmith/instrument/upload_script.hpp"
#include "tofsmith/io/waveform_export.hpp"

namespace tofsmith {

/// What of a code a generator is given.
struct UploadSelection {
  int light_channel = 1;   ///< that plays the light; 0: none
  int sensor_channel = 2;  ///< that plays the sensor's gain; 0: none
  int exposure = 1;        ///< which of the pairs is played, from 1
  int tap = 1;             ///< that the sensor's channel plays, from 1
  bool all = false;        ///< load all pairs

  /// @throws std::invalid_argument naming field, value and rule
  void validate() const;
};

/// A code as tables for a model: of its format and, unless the options say another, its highest
/// rate (with `true_arb`: that at which every point is played).
/// @throws std::invalid_argument naming the option that breaks a rule of the format or the model
WaveformExport export_for_model(const CodeSet& code, const Camera& camera,
                                const GeneratorModel& model, ExportOptions options, bool true_arb);

/// The channels of that selection, each with the tables that it holds and the one that it plays.
/// @throws std::invalid_argument if the code has no such exposure or tap
std::vector<UploadChannel> selected_channels(const WaveformExport& exported,
                                             const UploadSelection& selection);

/// "step", "normal" or "off" as a Keysight is told it. @throws std::invalid_argument
std::string parse_output_filter(std::string_view word);
/// "length", "plain" or "minimal". @throws std::invalid_argument for any other word
WaveHeader parse_wave_header(std::string_view word);

}  // namespace tofsmith
