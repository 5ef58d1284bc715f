// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tofsmith/core/image.hpp"
#include "tofsmith/decode/decoding_table.hpp"
#include "tofsmith/io/atomic_file.hpp"
#include "tofsmith/io/npy.hpp"
#include "tofsmith/io/raw_format.hpp"

namespace tofsmith {

/// Reads raw measurements of shape (H, W, K), or (F, H, W, K) for several frames, as integers or
/// floats from .npy, .npz or .h5 (the array "raw", or the only array). Values are unchanged,
/// including NaN and infinity.
/// @param measurements  K of the code, if known
/// @throws IoError for other extensions, shapes or types, or if K differs
RawFrames read_raw_frames(const std::filesystem::path& path,
                          std::optional<int> measurements = std::nullopt);

/// Writes float32 to .npy or .npz: (H, W, K) for one frame, (F, H, W, K) otherwise.
/// @throws std::invalid_argument if there are no values, or their number differs from the sizes
/// @throws IoError as AtomicFile, or for other extensions
void write_raw_frames(const std::filesystem::path& path, const RawFrames& raw, OutputPolicy policy);

/// Order of the axes of a recording.
enum class RawLayout {
  interleaved,  ///< (H, W, K) or (F, H, W, K): measurements of a pixel are adjacent
  planar,       ///< (K, H, W) or (F, K, H, W): one image per measurement
};

constexpr std::array<std::string_view, 2> words_of(RawLayout /*any*/) {
  return {"interleaved", "planar"};
}
/// Returns "interleaved" or "planar".
std::string_view name_of(RawLayout layout);
/// Inverse of name_of(). @throws std::invalid_argument for any other word
RawLayout parse_raw_layout(std::string_view name);

/// Options for reading a recording.
struct RawReadOptions {
  /// K of the code, if known.
  std::optional<int> measurements;
  /// Layout of the file, which is not inferred. If only the other layout fits, the error suggests
  /// it.
  RawLayout layout = RawLayout::interleaved;
  /// Maximum memory [bytes] for files that cannot be read in parts: .npz, .npy in Fortran order,
  /// and chunks of .h5.
  std::uint64_t max_in_memory = max_npz_bytes;
  /// Array of an .npz, or data set of an .h5 ("/camera/raw"); empty: the one named "raw", or the
  /// only one.
  std::string dataset;
  /// Layout of a raw dump without header. If set, the file is read as a dump, whatever its
  /// extension, and `layout` is ignored.
  std::optional<RawFormat> format;
  /// Markers of saturated and invalid numbers, which are replaced before any arithmetic (see
  /// DecodingTable::marking). No markers by default.
  RawMarking marking = {};
};

class RawDumpReader;
struct StoredArray;

/// Reads rows of the frames of a recording in the layout of the file. Files of type .npy and .h5
/// and dumps with a RawFormat are read in parts, so that they may be larger than memory; .npz
/// files, and .npy files in Fortran order, are held in memory.
/// @note thread-safe if each thread uses its own buffer
class RawFramesReader {
 public:
  /// @throws IoError as read_raw_frames(), if a file that cannot be read in parts exceeds the
  ///         memory limit, if an .h5 lacks the data set, or if the file's type cannot represent a
  ///         marker
  explicit RawFramesReader(const std::filesystem::path& path, const RawReadOptions& options = {});
  /// Opens one file per measurement, in the order of the measurements: arrays (H, W) or (F, H, W),
  /// or dumps with one measurement. A single file contains all measurements; `layout` applies to it
  /// only.
  /// @throws IoError as above; naming the file if its type or shape differs from the first
  explicit RawFramesReader(const std::vector<std::filesystem::path>& files,
                           const RawReadOptions& options = {});
  ~RawFramesReader();
  RawFramesReader(RawFramesReader&&) noexcept;

  int frames() const { return sizes_.frames; }
  int height() const { return sizes_.height; }
  int width() const { return sizes_.width; }
  int measurements() const { return sizes_.measurements; }
  /// Returns the type of the numbers before marking: float32 for int8, int16, float16 and dumps,
  /// float64 for integers of more than 16 bits.
  NpyType type() const { return type_; }
  /// Returns true if the file contains integers.
  bool holds_integers() const { return holds_integers_; }
  /// Returns the memory of one row of a frame in type() [bytes].
  std::size_t row_bytes() const;
  /// Returns the additional memory of one row for marking or rotation [bytes]; 0 if not needed.
  std::size_t marked_row_bytes() const;
  /// Returns the memory of a file that cannot be read in parts [bytes].
  std::size_t bytes_in_memory() const;

  /// Reads rows first_row ... first_row + rows - 1 of a frame, in the file's layout and in type().
  /// Numbers of .npy and .npz in a type of RawView are not converted, except for their byte order.
  /// If marking may replace numbers, all are converted to interleaved floats or doubles.
  /// @param buffer  memory of the view, which is valid until a later call changes the buffer
  /// @throws std::invalid_argument if there is no such frame or row
  /// @throws IoError if the file cannot be read or has become shorter
  RawView read_rows(int frame, int first_row, int rows, std::vector<std::byte>& buffer) const;
  /// Reads frame `index` as (1, H, W, K) floats.
  RawFrames read_frame(int index) const;

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

  std::unique_ptr<StoredArray> file_;    // null if `whole_` contains everything
  std::unique_ptr<RawDumpReader> dump_;  // dump; then `file_` is null and `whole_` empty
  std::vector<RawFramesReader> parts_;   // one per measurement; then the other sources are unused
  NpyArray whole_;
  NpyType type_ = NpyType::float32;
  bool holds_integers_ = false, holds_unsigned_ = false;
  RawMarking marking_;
  RawLayout layout_ = RawLayout::interleaved;
  RawFrames sizes_;  // without values
};

/// Reads all frames of one file, or of one file per measurement, into memory.
/// @throws IoError as RawFramesReader
RawFrames read_raw_frames(const std::vector<std::filesystem::path>& files,
                          const RawReadOptions& options);

}  // namespace tofsmith
