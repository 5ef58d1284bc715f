// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "tofsmith/camera/camera.hpp"
#include "tofsmith/core/fields.hpp"
#include "tofsmith/io/quantized_waveform.hpp"
#include "tofsmith/io/waveform_format.hpp"

namespace tofsmith {

/// What hardware a code is exported for. What is not given is the camera's generator's, or else as
/// much as the code has and the format holds.
struct ExportOptions {
  std::string format;                    ///< name of a WaveformFormat
  std::string variant;                   ///< of the format; empty: its first
  std::optional<int> samples;            ///< points of the table per period
  std::optional<int> bits;               ///< amplitude bits of the hardware, <= the format's
  std::optional<double> sample_rate_hz;  ///< most points per second
  std::optional<double> edge_grid_s;     ///< binary waveforms switch at multiples of this only
  std::optional<int> periods;            ///< that a table holds; none: as few as fit the format
  double low_v = 0.0;                    ///< output at no light and at no gain [V]
  double high_v = 1.0;  ///< output at the highest peak of the light, and at a gain of 1 [V]
};
/// Its fields (core/fields.hpp).
auto fields_of(ConstOrNot<ExportOptions> auto& o) {
  return std::tuple(Field("format", o.format), Field("variant", o.variant),
                    Field("samples", o.samples), Field("bits", o.bits),
                    Field("sample_rate_hz", o.sample_rate_hz), Field("edge_grid_s", o.edge_grid_s),
                    Field("periods", o.periods), Field("low_v", o.low_v),
                    Field("high_v", o.high_v));
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

/// The code as tables of the generators of `played`, which exporting_camera() made. A value read
/// back from a table differs from the one that evaluation sees by at most half a step of the
/// format.
/// @throws std::invalid_argument as exporting_camera(), or if no number of periods fits the format
WaveformExport export_waveforms(const CodeSet& code, const Camera& played,
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
