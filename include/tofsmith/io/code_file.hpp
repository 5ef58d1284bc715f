// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tofsmith/camera/camera.hpp"
#include "tofsmith/code/code_set.hpp"
#include "tofsmith/core/fields.hpp"
#include "tofsmith/design/design.hpp"
#include "tofsmith/io/atomic_file.hpp"

namespace tofsmith {

/// Returns the code as JSON: binary waveforms by their switching times on the unit period, others
/// by their samples. Numbers are read back exactly.
/// @throws std::invalid_argument for texts that are not UTF-8 and numbers that are not finite
std::string code_to_json(const CodeSet& code);

/// Reads a code from JSON.
/// @param file  name for error messages
/// @throws IoError "file:line:column: ..." for invalid JSON; "file: /json/pointer: ..." for missing
///         or unknown members and invalid values
CodeSet parse_code_json(std::string_view text, std::string_view file = "code.json");

/// Order of the K columns of an array for E exposures with several taps.
enum class TapOrder {
  blocked,      ///< tap 0 of all exposures, then tap 1 of all exposures, ...
  interleaved,  ///< all taps of exposure 0, then all taps of exposure 1, ...
};
constexpr auto words_of(TapOrder /*any*/) { return word_list("blocked", "interleaved"); }

/// Interpretation of the columns of an NPZ file.
struct TapLayout {
  int taps = 1;
  std::optional<TapOrder> order;  ///< required for several taps and several exposures
  bool is_signed = false;         ///< demodulations are weights of a mixer, in [-1, 1]
};

/// Reads the arrays `modfs` and `demodfs`, each (N, K), the layout of other time-of-flight
/// projects. Columns with two levels, the lower of which is 0, become binary waveforms. The scale
/// of the modulation is kept.
/// @param file  for error messages; its stem becomes the code's name
/// @throws IoError naming file, array, row and column for inconsistent shapes, invalid values, taps
///         of one exposure with different modulations, or a missing order
CodeSet parse_code_npz(std::span<const std::byte> content, std::string_view file,
                       const TapLayout& layout = {});

/// Writes the same layout, as cell averages, and the correlation without impulse responses,
///   corrfs[z, i] = (1/N) sum_n modfs[n, i] demodfs[n + z, i].
/// @throws std::invalid_argument if `order` is required and missing
std::vector<std::byte> serialize_code_npz(const CodeSet& code,
                                          std::optional<TapOrder> order = std::nullopt);

struct CodeFileOptions {
  std::optional<int> taps;
  std::optional<TapOrder> tap_order;
};
auto fields_of(ConstOrNot<CodeFileOptions> auto& o) {
  return std::tuple(
      Field("taps", o.taps, at_least(1), Help{"number of taps of an NPZ code"},
            IfAbsent{"the camera's"}),
      Field("tap_order", o.tap_order,
            Help{"column order of an NPZ code: all exposures of the first tap first (blocked), or "
                 "all taps of the first exposure first (interleaved); required for several taps "
                 "and several exposures"}));
}

/// Reads a code by extension: .json, .npz (with `layout`) or .csv (with layout.is_signed).
/// @throws IoError as parse_code_json() and parse_code_npz()
CodeSet read_code(const std::filesystem::path& path, const TapLayout& layout = {});

/// Returns the waveforms as CSV that read_code() can read, as cell averages, with the columns
///   time_s, modulation_1 ... modulation_E (power over average), demodulation_1 ... demodulation_K
std::string waveforms_to_csv(const CodeSet& code, double fundamental_frequency_hz);

/// Reads a code from arrays of other software: light (N, K), or (N) if all exposures are equal, and
/// gates (N, K), also transposed. The brightest light is scaled to a mean of 1, and gates above 1
/// are divided by the largest.
/// @param light, gates  .npy files; the stem of `gates` becomes the code's name
/// @throws IoError as parse_code_npz(), or if all light is zero
CodeSet read_code_arrays(const std::filesystem::path& light, const std::filesystem::path& gates,
                         const TapLayout& layout = {});

/// Writes a code by extension: .json or .npz (with `order`).
/// @throws std::invalid_argument as code_to_json() and serialize_code_npz()
void write_code(const std::filesystem::path& path, const CodeSet& code, OutputPolicy policy,
                std::optional<TapOrder> order = std::nullopt);

/// Reads rows of one exposure from arrays of other software: light (N), or several equal columns,
/// and up to 16 rows (N, K) or (K, N). Light is scaled to a mean of 1.
/// @param light, rows  .npy files; the stem of `rows` becomes the code's name
/// @throws IoError naming file, row and column for inconsistent shapes, light that is negative, all
///         zero or differs between columns, and rows that are all zero
CodeSet read_rows(const std::filesystem::path& light, const std::filesystem::path& rows);
/// Reads rows from the arrays `modfs` and `demodfs` of an .npz file.
CodeSet read_rows(const std::filesystem::path& archive);

/// Reads precomputed codes. @throws IoError as parse_atlas()
std::vector<AtlasEntry> read_atlas(const std::filesystem::path& path);

/// Builds a built-in family for the camera, resamples a code of the built-in atlas, or reads a file
/// without resampling. Cameras with rows read .npz files and the pair LIGHT.npy,ROWS.npy as rows;
/// other cameras read LIGHT.npy,GATES.npy as exposures. With a mixer, the demodulations of .npz,
/// .npy and .csv files are weights in [-1, 1].
/// @throws IoError as read_code(), or if `name_or_path` is unknown
/// @throws std::invalid_argument for a family that the camera does not support
CodeSet load_code(const std::string& name_or_path, const Camera& camera,
                  const CodeFileOptions& options = {});

}  // namespace tofsmith
