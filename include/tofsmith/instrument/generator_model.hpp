// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace tofsmith {

/// Generators that are told in the same words.
enum class GeneratorFamily {
  siglent_x,          ///< SDG1000X, SDG2000X, SDG6000X
  keysight_trueform,  ///< 33500 and 33600
  tektronix_afg3000,  ///< AFG3000, with B and C
};

/// What a generator can do; docs/instruments.md has the sources. Limits are those of the smallest
/// version; what the instrument answers decides.
struct GeneratorModel {
  std::string name;    ///< "SDG2042X"
  std::string vendor;  ///< as in its answer to *IDN?
  GeneratorFamily family = GeneratorFamily::siglent_x;
  int channels = 2;
  double sample_rate_hz = 0.0;             ///< most points played per second
  double most_repetition_hz = 0.0;         ///< of a whole table; 0: as the sample rate allows
  double true_arb_rate_hz = 0.0;           ///< most points per second that are all played, where a
                                           ///< generator otherwise skips (Siglent); 0: it cannot
  int least_points = 2, most_points = 0;   ///< of a table
  int memories = 0;                        ///< tables at a time; 0: as many as fit
  double least_vpp = 0.0, most_vpp = 0.0;  ///< into 50 ohm

  /// Name of the WaveformFormat whose points it takes.
  std::string format() const;
  /// Whether the list of errors can be asked for.
  bool has_error_queue() const { return family != GeneratorFamily::siglent_x; }
};

/// All models.
const std::vector<GeneratorModel>& generator_models();
/// @throws std::invalid_argument that names the nearest, or the families
const GeneratorModel& generator_model(std::string_view name);

/// The most points per second that any model plays which takes this WaveformFormat, or any model at
/// all where none of them does.
double fastest_sample_rate_hz(std::string_view format);

/// What an instrument says of itself.
struct InstrumentIdentity {
  std::string vendor, model, serial, firmware;
};

/// Reads an answer to *IDN?. @throws IoError "place: .." if it is none
InstrumentIdentity parse_identity(std::string_view answer, std::string_view place);
/// @throws IoError "place: .." for an instrument that is none of the models
const GeneratorModel& identified_model(const InstrumentIdentity& identity, std::string_view place);

}  // namespace tofsmith
