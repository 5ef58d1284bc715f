// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tofsmith/core/fields.hpp"
#include "tofsmith/core/hidden.hpp"
#include "tofsmith/core/image.hpp"
#include "tofsmith/decode/decoding_table.hpp"
#include "tofsmith/io/atomic_file.hpp"
#include "tofsmith/io/npy.hpp"
#include "tofsmith/io/raw_format.hpp"

namespace tofsmith {

/// Reads raw measurements (H, W, K) or (F, H, W, K) from .npy, .npz or .h5 (the array "raw", or the
/// only array), unchanged.
/// @param measurements  K of the code, if known
/// @throws IoError for other extensions, shapes or types
RawFrames read_raw_frames(const std::filesystem::path& path,
                          std::optional<int> measurements = std::nullopt);

/// Writes float32 to .npy or .npz: (H, W, K) for one frame, (F, H, W, K) otherwise.
/// @throws std::invalid_argument if the number of values does not match the sizes
void write_raw_frames(const std::filesystem::path& path, const RawFrames& raw, OutputPolicy policy);

/// Order of the axes of a recording.
enum class RawLayout {
  interleaved,  ///< (H, W, K) or (F, H, W, K): measurements of a pixel are adjacent
  planar,       ///< (K, H, W) or (F, K, H, W): one image per measurement
};

constexpr auto words_of(RawLayout /*any*/) { return word_list("interleaved", "planar"); }

/// Options for reading a recording.
struct RawReadOptions {
  /// K of the code, if known.
  std::optional<int> measurements;
  /// Never inferred. If only the other layout fits, the error suggests it.
  RawLayout layout = RawLayout::interleaved;
  /// Maximum memory [bytes] for .npz, .npy in Fortran order, and chunks of .h5.
  std::uint64_t max_in_memory = max_npz_bytes;
  /// Array of an .npz, or data set of an .h5 ("/camera/raw"); empty: "raw", or the only one.
  std::string dataset;
  /// Layout of a raw dump; if set, `layout` and the extension are ignored.
  std::optional<RawFormat> format;
  /// Markers of saturated and invalid numbers, replaced before any arithmetic.
  RawMarking marking = {};
};

class RawDumpReader;
struct StoredArray;

/// Reads rows of the frames of a recording. .npz files, and .npy files in Fortran order, are held
/// in memory; other files may be larger than memory.
/// @note thread-safe if each thread uses its own buffer
class RawFramesReader {
 public:
  /// @throws IoError as read_raw_frames(), if a file exceeds the memory limit, an .h5 lacks the
  ///         data set, or the file's type cannot represent a marker
  explicit RawFramesReader(const std::filesystem::path& path, const RawReadOptions& options = {});
  /// Opens one file per measurement, in order: arrays (H, W) or (F, H, W), or dumps with one
  /// measurement. `layout` applies only to a single file with all measurements.
  /// @throws IoError as above, or if type or shape of the files differ
  explicit RawFramesReader(const std::vector<std::filesystem::path>& files,
                           const RawReadOptions& options = {});

  int frames() const { return sizes_.frames; }
  int height() const { return sizes_.height; }
  int width() const { return sizes_.width; }
  int measurements() const { return sizes_.measurements; }
  /// Type of the numbers before marking: float32 for int8, int16, float16 and dumps, float64 for
  /// integers of more than 16 bits.
  NpyType type() const { return type_; }
  bool holds_integers() const { return holds_integers_; }
  /// Memory of one row of a frame in type() [bytes].
  std::size_t row_bytes() const;
  /// Additional memory of one row for marking or rotation [bytes].
  std::size_t marked_row_bytes() const;
  /// Memory of a file that cannot be read in parts [bytes].
  std::size_t bytes_in_memory() const;

  /// Reads rows of a frame, in the file's layout and in type(); as interleaved floats or doubles if
  /// marking may replace numbers.
  /// @param buffer  memory of the view, which is valid until the buffer changes
  /// @throws std::invalid_argument if there is no such frame or row
  RawView read_rows(int frame, int first_row, int rows, std::vector<std::byte>& buffer) const;

 private:
  struct OneMeasurement {};
  RawFramesReader(const std::filesystem::path& path, const RawReadOptions& options, OneMeasurement);
  void open_array(const std::filesystem::path& path, const RawReadOptions& options,
                  bool is_one_measurement);
  void open_parts(const std::vector<std::filesystem::path>& files, const RawReadOptions& options);
  void open_dump(const std::filesystem::path& path, const RawReadOptions& options);
  RawView rows_as_stored(int frame, int first_row, int rows, std::vector<std::byte>& buffer) const;
  void read_stored_rows(int frame, int first_row, int rows, std::vector<std::byte>& buffer) const;
  RawView view_of(const std::byte* data, int rows, int rows_of_a_plane) const;
  RawView rows_in_memory(int frame, int first_row, int rows) const;
  RawView rows_of_parts(int frame, int first_row, int rows, std::vector<std::byte>& buffer) const;

  Hidden<StoredArray> file_;
  Hidden<RawDumpReader> dump_;          // then `file_` is null and `whole_` empty
  std::vector<RawFramesReader> parts_;  // per measurement; then the other sources are unused
  NpyArray whole_;
  NpyType type_ = NpyType::float32;
  bool holds_integers_ = false, holds_unsigned_ = false;
  RawMarking marking_;
  RawLayout layout_ = RawLayout::interleaved;
  RawFrames sizes_;  // without values
};

/// Reads all frames into memory. @throws IoError as RawFramesReader
RawFrames read_raw_frames(const std::vector<std::filesystem::path>& files,
                          const RawReadOptions& options);

}  // namespace tofsmith
