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

/// A waveform as a table of integer codes.
struct QuantizedWaveform {
  std::string name;  ///< letters, digits and _, beginning with a letter
  Arm arm = Arm::light;
  int index = 0;                    ///< exposure (light) or tap value (sensor)
  std::int32_t levels = 2;          ///< codes are in [0, levels - 1]; 2 to 2^24
  std::vector<std::int32_t> codes;  ///< all periods
  int periods = 1;                  ///< >= 1; divides the number of codes
  double sample_rate_hz = 0.0;      ///< > 0
  double full_scale = 1.0;          ///< power over average power, or gain, at the largest code
  double low_v = 0.0;               ///< at code 0
  double high_v = 1.0;              ///< at the largest code, > low_v

  int points() const { return static_cast<int>(codes.size()); }
  int points_per_period() const { return points() / periods; }
  double repetition_hz() const { return sample_rate_hz / points(); }
  /// Difference between adjacent codes.
  double step() const { return full_scale / (levels - 1); }
  /// In units of the waveform.
  double value_of(std::int32_t code) const { return step() * code; }
  double volts_of(std::int32_t code) const {
    return low_v + (high_v - low_v) * code / (levels - 1);
  }
  double amplitude_vpp() const { return high_v - low_v; }
  double offset_v() const { return 0.5 * (low_v + high_v); }

  /// On in the first half of every period.
  bool trigger_at(int point) const {
    return point % points_per_period() < (points_per_period() + 1) / 2;
  }

  /// @throws std::invalid_argument
  void validate() const;

  friend bool operator==(const QuantizedWaveform&, const QuantizedWaveform&) = default;
};

/// Rounds a waveform, which is constant within each point, to integer codes. The caller sets name,
/// voltages and sample rate.
/// @param table  from generator_table(), with `points` points
/// @param scale  the full scale is the waveform's peak times this factor
QuantizedWaveform quantized(const Waveform& table, int points, std::int32_t levels,
                            double scale = 1.0);

/// Content of the files of a format.
enum class FormatContent {
  one_waveform,  ///< one file per waveform
  all_columns,   ///< one file with a column per waveform
  words,         ///< memory words that contain all outputs, exposures one after another
};

/// A variant where sources disagree; the first one is the default.
struct FormatVariant {
  std::string name;
  std::string description;
};

/// A file format and the limits of its hardware, see docs/formats.md.
struct WaveformFormat {
  std::string name;
  std::string extension;
  std::string description;
  FormatContent content = FormatContent::one_waveform;
  int min_points = 2;  ///< of a table
  int max_points = 1 << 20;
  int multiple_of = 1;      ///< of the points of a table
  std::int32_t levels = 0;  ///< of a point; 0: 2^bits
  int default_bits = 14;
  int max_bits = 16;
  bool skips_points = false;  ///< if the sample rate is too high
  std::string trigger;        ///< where it is stored; empty: nowhere
  std::vector<FormatVariant> variants;
};

const std::vector<WaveformFormat>& waveform_formats();
/// @throws std::invalid_argument that lists the formats
const WaveformFormat& waveform_format(std::string_view name);
/// Returns the index of a variant; 0 for "". @throws std::invalid_argument that lists the variants
int variant_index(const WaveformFormat& format, std::string_view variant);

/// Families of generators with the same commands.
enum class GeneratorFamily {
  siglent_x,          ///< SDG1000X, SDG2000X, SDG6000X
  keysight_trueform,  ///< 33500 and 33600
  tektronix_afg3000,  ///< AFG3000, AFG3000B and AFG3000C
};

/// Capabilities of the smallest version of a generator, see docs/instruments.md.
struct GeneratorModel {
  std::string name;
  std::string vendor;  ///< as in the answer to *IDN?
  GeneratorFamily family = GeneratorFamily::siglent_x;
  int channels = 2;
  double sample_rate_hz = 0.0;
  double max_repetition_hz = 0.0;       ///< of a table; 0: limited only by the sample rate
  double true_arb_rate_hz = 0.0;        ///< without skipped points; 0: never skips points
  int min_points = 2, max_points = 0;   ///< of a table
  int memories = 0;                     ///< maximum number of tables; 0: limited by size
  double min_vpp = 0.0, max_vpp = 0.0;  ///< into 50 ohm

  /// Name of its WaveformFormat.
  std::string format() const;
  /// Returns true if errors can be queried.
  bool has_error_queue() const { return family != GeneratorFamily::siglent_x; }
};

const std::vector<GeneratorModel>& generator_models();
/// Finds a model by name, case-insensitive, with or without the letter of its generation, or null.
const GeneratorModel* find_generator_model(std::string_view name);
/// @throws std::invalid_argument that suggests the most similar model
const GeneratorModel& generator_model(std::string_view name);
inline constexpr std::string_view known_generators =
    "Siglent SDG1000X, SDG2000X, SDG6000X; Keysight 33500, 33600; Tektronix AFG3000";

/// Highest sample rate of the models that accept a format, or of all models if none does.
double fastest_sample_rate_hz(std::string_view format);

/// Hardware of an export. Defaults come from the camera's generator, else from code and format.
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
      Field("variant", o.variant,
            Help{"variant of the format, if published descriptions of it differ"},
            IfAbsent{"the first"}),
      Field("samples", o.samples, Help{"number of points per period"}),
      Field("bits", o.bits,
            Help{"amplitude bits of the hardware, at most the bits of the format; 1: on and off"}),
      Field("sample_rate_hz", o.sample_rate_hz, above(0),
            Help{"maximum number of points per second of the hardware"}),
      Field("edge_grid_s", o.edge_grid_s, above(0),
            Help{"time grid of the edges of binary waveforms"}),
      Field("periods", o.periods, Help{"number of periods in a file or table"},
            IfAbsent{"as few as the format allows"}),
      Field("low_v", o.low_v, Help{"output for zero light and zero gain"}),
      Field("high_v", o.high_v, Help{"output for peak light and a gain of 1"}));
}

/// Waveforms of a code, ready to be written.
struct WaveformExport {
  WaveformFormat format;
  int variant = 0;  ///< index in format.variants
  std::string code, camera;
  double fundamental_frequency_hz = 0.0;
  int exposures = 0;
  int taps = 1;
  bool shared_taps = false;  ///< one generator drives both taps; the second is 1 - the first
  /// Modulation of every exposure, then demodulation of every tap value (with shared taps, the
  /// first).
  std::vector<QuantizedWaveform> waveforms;
  Generator light, sensor;  ///< of the tables
};

/// Returns the camera with the generators of the tables.
/// @throws std::invalid_argument naming the option that breaks a rule of the format or the hardware
Camera exporting_camera(const CodeSet& code, const Camera& camera, const ExportOptions& options);

/// Converts the code to tables for the camera from exporting_camera(), with an error of at most
/// half a step.
/// @throws std::invalid_argument as exporting_camera(), or if no number of periods fits the format
WaveformExport export_waveforms(const CodeSet& code, const Camera& actual,
                                const ExportOptions& options);

struct ExportedFile {
  std::string name;
  std::vector<std::byte> bytes;
  std::vector<int> waveforms;  ///< contained
};

/// Returns the files. @throws std::invalid_argument if the format cannot contain the waveforms
std::vector<ExportedFile> export_files(const WaveformExport& exported);

/// Returns manifest.json: format, clock, limits, and the contents and SHA-256 of each file.
std::string export_manifest(const WaveformExport& exported, const std::vector<ExportedFile>& files);

/// Returns a table: time_s, trigger, then the value of every waveform.
std::string quantized_csv(const std::vector<QuantizedWaveform>& waveforms);

}  // namespace tofsmith
