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
#include "tofsmith/design/design.hpp"
#include "tofsmith/io/atomic_file.hpp"

namespace tofsmith {

/// The code as a JSON document: binary waveforms by their switching times on the unit period,
/// others by their samples; numbers read back as exactly what they were.
/// @throws std::invalid_argument if a text is not UTF-8 or the provenance is not finite
std::string code_to_json(const CodeSet& code);

/// @param file  what errors call it
/// @throws IoError "file:line:column: .." where it is no JSON, else "file: /json/pointer: .." for
///         members that are missing, unknown or of the wrong type, lengths that disagree, and
///         values that no code can have
CodeSet parse_code_json(std::string_view text, std::string_view file = "code.json");

/// How the K columns of an array run through E exposures of several taps.
enum class TapOrder {
  blocked,      ///< tap 0 of all exposures, then tap 1 of all exposures, ..
  interleaved,  ///< all taps of exposure 0, then all taps of exposure 1, ..
};

/// What an NPZ file does not say about its columns.
struct TapLayout {
  int taps = 1;
  std::optional<TapOrder> order;  ///< must be given for several taps of several exposures: it
                                  ///< is never guessed
  bool is_signed = false;         ///< demodulations are weights of a mixer, in [-1, 1]
};

/// Reads the arrays `modfs` and `demodfs`, each (N, K), in the layout that other time-of-flight
/// projects publish: a column of each for every measurement. A column of two levels, the lower of
/// which is 0, becomes a binary waveform; modulation keeps its scale. `corrfs` is not needed, but
/// must have the same shape.
/// @param file  what errors call it; its stem becomes the code's name
/// @throws IoError naming file, array, row and column for shapes that disagree, values that no
///         code can have, taps of one exposure with different modulation, or several taps of
///         several exposures without an order
CodeSet parse_code_npz(std::span<const std::byte> content, std::string_view file,
                       const TapLayout& layout = {});

/// The same layout: modulation and demodulation as cell averages, and
///   corrfs[z, i] = (1/N) sum_n modfs[n, i] demodfs[n + z, i],
/// the correlation without a camera's impulse responses.
/// @throws std::invalid_argument if the code has several taps, several exposures and there is no
///         order
std::vector<std::byte> serialize_code_npz(const CodeSet& code,
                                          std::optional<TapOrder> order = std::nullopt);

/// What load_code() must know about NPZ files with several taps.
struct CodeFileOptions {
  std::optional<int> taps;            ///< values read out of one exposure; none = as the camera's
  std::optional<TapOrder> tap_order;  ///< never guessed
};

/// Reads a code by extension: .json, .npz or .csv. `layout` is for .npz, and whether weights are
/// signed for .csv too; .json says it itself.
/// @throws IoError as parse_code_json() and parse_code_npz(), or if the file cannot be read
CodeSet read_code(const std::filesystem::path& path, const TapLayout& layout = {});

/// The waveforms of a code as a CSV table with one row per time sample, which read_code() reads
/// back:
///   time_s, modulation_1 .. modulation_E (power over average), demodulation_1 .. demodulation_K
/// A sample is the mean over its cell, so that duties are exact.
std::string waveforms_to_csv(const CodeSet& code, double fundamental_frequency_hz);

/// A code of exposures from the arrays of others: light (N, K), or one for all exposures (N), and
/// gates (N, K), in this order or with time along the second axis, and of any scale: the brightest
/// light gets a mean of 1, and gates above 1 are divided by the largest. Columns as in
/// parse_code_npz().
/// @param light, gates  .npy files; the stem of `gates` becomes the code's name
/// @throws IoError as parse_code_npz(), or if all light is zero
CodeSet read_code_arrays(const std::filesystem::path& light, const std::filesystem::path& gates,
                         const TapLayout& layout = {});

/// Writes a code by extension: .json or .npz. `order` is for .npz.
/// @throws IoError as AtomicFile, std::invalid_argument as code_to_json(), serialize_code_npz()
void write_code(const std::filesystem::path& path, const CodeSet& code, OutputPolicy policy,
                std::optional<TapOrder> order = std::nullopt);

/// Rows of one exposure from the arrays of others: light (N), or columns that are all the same, and
/// rows (N, K) or (K, N) of any scale and sign, up to 16. Light is scaled to a mean of 1; nothing
/// else is changed.
/// @param light, rows  .npy files; the stem of `rows` becomes the code's name
/// @throws IoError naming file, row and column for shapes that disagree, light that is negative,
///         differs between columns or is all zero, and rows that are all zero or too many
CodeSet read_rows(const std::filesystem::path& light, const std::filesystem::path& rows);
/// The same of the arrays `modfs` and `demodfs` of an .npz file.
CodeSet read_rows(const std::filesystem::path& archive);

/// Reads an atlas of best codes from a file.
/// @throws IoError as parse_atlas(), or if the file cannot be read
std::vector<AtlasEntry> read_atlas(const std::filesystem::path& path);

/// A built-in family, built for the camera; a code of the built-in atlas, on the camera's samples;
/// or a code from a file as it is there. A camera that reads rows takes an .npz file, and the pair
/// LIGHT.npy,ROWS.npy, as rows; others take LIGHT.npy,GATES.npy as exposures. A camera of a mixer
/// takes the demodulations of .npz, .npy and .csv files as weights in [-1, 1].
/// @throws IoError as read_code(), or if `name_or_path` is neither;
///         std::invalid_argument for a family that the camera cannot play
CodeSet load_code(const std::string& name_or_path, const Camera& camera,
                  const CodeFileOptions& options = {});

/// "blocked" or "interleaved". @throws std::invalid_argument for any other word
TapOrder parse_tap_order(std::string_view word);

}  // namespace tofsmith
