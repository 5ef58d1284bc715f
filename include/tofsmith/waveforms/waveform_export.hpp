// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tofsmith/camera/camera.hpp"
#include "tofsmith/camera/generator_report.hpp"
#include "tofsmith/code/code_set.hpp"
#include "tofsmith/core/fields.hpp"

namespace tofsmith {

/// One waveform as the table of a generator, or the memory of an FPGA, holds it: whole numbers, one
/// for each point. This is what every writer of a waveform format takes.
struct QuantizedWaveform {
  std::string name;         ///< of letters, digits and _, begins with a letter: "modulation_1"
  Arm arm = Arm::light;     ///< that plays it
  int index = 0;            ///< exposure (light) or tap value (sensor), from 0
  std::int32_t levels = 2;  ///< codes run from 0 to levels - 1; 2 .. 2^24
  std::vector<std::int32_t> codes;  ///< of `periods` periods, one after another
  int periods = 1;                  ///< >= 1; divides the number of codes
  double sample_rate_hz = 0.0;      ///< points of the table per second, > 0
  double full_scale = 1.0;          ///< value of the waveform at the largest code: power over
                                    ///< average power, or gain; code 0 is a value of 0
  double low_v = 0.0;               ///< what code 0 shall come out as [V]
  double high_v = 1.0;              ///< what the largest code shall come out as [V], > low_v

  int points() const { return static_cast<int>(codes.size()); }
  int points_per_period() const { return points() / periods; }
  /// How often per second the whole table is played.
  double repetition_hz() const { return sample_rate_hz / points(); }
  /// How far it is from one code to the next, in units of the waveform.
  double step() const { return full_scale / (levels - 1); }
  /// Value of a code, in units of the waveform.
  double value_of(std::int32_t code) const { return step() * code; }
  double volts_of(std::int32_t code) const {
    return low_v + (high_v - low_v) * code / (levels - 1);
  }
  double amplitude_vpp() const { return high_v - low_v; }
  double offset_v() const { return 0.5 * (low_v + high_v); }

  /// The first half of every period, in which the trigger is on.
  bool trigger_at(int point) const {
    return point % points_per_period() < (points_per_period() + 1) / 2;
  }

  /// @throws std::invalid_argument naming field, value and rule
  void validate() const;

  friend bool operator==(const QuantizedWaveform&, const QuantizedWaveform&) = default;
};

/// The nearest of `levels` codes for the value at each point of a waveform that is constant over
/// points: differs by at most half a step. Name, volts and rate are left to the caller.
/// @param table   what generator_table() gives, of `points` points
/// @param scale   multiplies the waveform; the full scale is its peak times this
QuantizedWaveform quantized(const Waveform& table, int points, std::int32_t levels,
                            double scale = 1.0);

/// What the files of a format hold.
enum class FormatContent {
  one_waveform,  ///< a file per waveform
  all_columns,   ///< all waveforms side by side
  words,         ///< a memory whose words hold all outputs, exposures one after another
};

/// A way in which sources disagree about a format; the first of a format is the default.
struct FormatVariant {
  std::string name;
  std::string description;
};

/// A file format of waveforms and what its hardware holds. docs/formats.md has layouts and sources.
struct WaveformFormat {
  std::string name;         ///< "siglent-csv", ..
  std::string extension;    ///< ".csv", ..
  std::string description;  ///< one line
  FormatContent content = FormatContent::one_waveform;
  int min_points = 2;  ///< of a table
  int max_points = 1 << 20;
  int multiple_of = 1;      ///< points of a table
  std::int32_t levels = 0;  ///< of a point; 0: 2^bits, whatever bits are asked for
  int default_bits = 14;
  int max_bits = 16;          ///< of amplitude
  bool skips_points = false;  ///< a table of more points than the sample rate allows is played
  std::string trigger;        ///< where the trigger stands; empty: nowhere
  std::vector<FormatVariant> variants;
};

/// All formats.
const std::vector<WaveformFormat>& waveform_formats();
/// @throws std::invalid_argument that lists the formats, with the nearest one
const WaveformFormat& waveform_format(std::string_view name);
/// Index of a variant of the format; 0 for "". @throws std::invalid_argument that lists them
int variant_index(const WaveformFormat& format, std::string_view variant);

/// Families of generators that take the same commands.
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
  double sample_rate_hz = 0.0;          ///< most points played per second
  double max_repetition_hz = 0.0;       ///< of a whole table; 0: as the sample rate allows
  double true_arb_rate_hz = 0.0;        ///< most points per second that are all played, where a
                                        ///< generator otherwise skips (Siglent); 0: it cannot
  int min_points = 2, max_points = 0;   ///< of a table
  int memories = 0;                     ///< tables at a time; 0: as many as fit
  double min_vpp = 0.0, max_vpp = 0.0;  ///< into 50 ohm

  /// Name of the WaveformFormat whose points it takes.
  std::string format() const;
  /// Whether the list of errors can be asked for.
  bool has_error_queue() const { return family != GeneratorFamily::siglent_x; }
};

/// All models.
const std::vector<GeneratorModel>& generator_models();
/// The model of that name, in any case and with or without the letter of its generation; null:
/// none.
const GeneratorModel* find_generator_model(std::string_view name);
/// @throws std::invalid_argument that names the nearest, or the families
const GeneratorModel& generator_model(std::string_view name);
/// The families, to tell users of them.
inline constexpr std::string_view known_generators =
    "Siglent SDG1000X, SDG2000X, SDG6000X; Keysight 33500, 33600; Tektronix AFG3000";

/// The most points per second that any model plays which takes this WaveformFormat, or any model at
/// all where none of them does.
double fastest_sample_rate_hz(std::string_view format);

/// What hardware a code is exported for. What is not given is the camera's generator's, or else as
/// much as the code has and the format holds.
struct ExportOptions {
  std::string format;
  std::string variant;
  std::optional<int> samples;
  std::optional<int> bits;
  std::optional<double> sample_rate_hz;
  std::optional<double> edge_grid_s;
  std::optional<int> periods;
  double low_v = 0.0;
  double high_v = 1.0;
};
auto fields_of(ConstOrNot<ExportOptions> auto& o) {
  return std::tuple(
      Field("format", o.format, Help{"format of the files"}),
      Field("variant", o.variant, Help{"variant of the format, where sources disagree about it"},
            IfAbsent{"its first"}),
      Field("samples", o.samples, Help{"points of the table that holds one period"}),
      Field("bits", o.bits,
            Help{"amplitude bits of the hardware, at most the format's (1 = on and off)"}),
      Field("sample_rate_hz", o.sample_rate_hz, above(0),
            Help{"most points per second of the hardware"}),
      Field("edge_grid_s", o.edge_grid_s, above(0),
            Help{"grid of the switching times of binary waveforms"}),
      Field("periods", o.periods, Help{"periods in a table"},
            IfAbsent{"as few as the format takes"}),
      Field("low_v", o.low_v, Help{"output at no light and at no gain"}),
      Field("high_v", o.high_v,
            Help{"output at the highest peak of the light, and at a gain of 1"}));
}

/// All waveforms of a code, ready for a format's writer.
struct WaveformExport {
  WaveformFormat format;
  int variant = 0;  ///< index
  std::string code, camera;
  double fundamental_frequency_hz = 0.0;
  int exposures = 0;
  int taps = 1;              ///< tap values of an exposure
  bool shared_taps = false;  ///< two taps of one generator: the second is 1 - the first
  /// Modulation of every exposure, then demodulation of every tap value, or of shared taps of every
  /// exposure.
  std::vector<QuantizedWaveform> waveforms;
  Generator light, sensor;  ///< that play them
};

/// The camera with the generators that play the exported tables: what to evaluate a code on to see
/// what the hardware's limits cost.
/// @throws std::invalid_argument naming the option that breaks a rule of the format or of the
///         hardware
Camera exporting_camera(const CodeSet& code, const Camera& camera, const ExportOptions& options);

/// The code as tables of the generators of `actual`, which exporting_camera() made. A value read
/// back from a table differs from the one that evaluation sees by at most half a step of the
/// format.
/// @throws std::invalid_argument as exporting_camera(), or if no number of periods fits the format
WaveformExport export_waveforms(const CodeSet& code, const Camera& actual,
                                const ExportOptions& options);

/// One file of an export.
struct ExportedFile {
  std::string name;  ///< without directory
  std::vector<std::byte> bytes;
  std::vector<int> waveforms;  ///< indices of those it holds
};

/// The files of all waveforms. @throws std::invalid_argument if the format cannot hold them
std::vector<ExportedFile> export_files(const WaveformExport& exported);

/// manifest.json: format, clock, limits, and for each file what it holds, its scale, size and
/// SHA-256.
std::string export_manifest(const WaveformExport& exported, const std::vector<ExportedFile>& files);

/// A table with a header: time_s, trigger, then the value of every waveform.
std::string quantized_csv(const std::vector<QuantizedWaveform>& waveforms);

}  // namespace tofsmith
