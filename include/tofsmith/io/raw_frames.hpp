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

/// Raw measurements of shape (H, W, K), or (F, H, W, K) for several frames, from .npy, .npz or .h5
/// (the array "raw", or the only one), of whole numbers or floats. Values are kept as they are, NaN
/// and infinity too.
/// @param measurements  K that the code asks for, if one is known
/// @throws IoError if the extension, the shape or the type is another, or K differs
RawFrames read_raw_frames(const std::filesystem::path& path,
                          std::optional<int> measurements = std::nullopt);

/// Writes float32 to .npy or .npz: (H, W, K) if there is one frame, (F, H, W, K) otherwise.
/// @throws std::invalid_argument if there are no values, or not as many as the sizes say
/// @throws IoError if the extension is another, or as AtomicFile does
void write_raw_frames(const std::filesystem::path& path, const RawFrames& raw, OutputPolicy policy);

/// Where the K measurements of a pixel stand in a file.
enum class RawLayout {
  interleaved,  ///< (H, W, K) or (F, H, W, K): side by side
  planar,       ///< (K, H, W) or (F, K, H, W): one image per measurement
};

constexpr std::array<std::string_view, 2> words_of(RawLayout /*any*/) {
  return {"interleaved", "planar"};
}
/// "interleaved", "planar".
std::string_view name_of(RawLayout layout);
/// @throws std::invalid_argument for any other word
RawLayout parse_raw_layout(std::string_view name);

/// How a recording is read.
struct RawReadOptions {
  /// K that the code asks for, if one is known.
  std::optional<int> measurements;
  /// Never guessed; where the other one would fit, the error says so.
  RawLayout layout = RawLayout::interleaved;
  /// Most memory [bytes] for files that cannot be read in parts: .npz, .npy in Fortran order, and
  /// chunks of .h5.
  std::uint64_t max_in_memory = max_npz_bytes;
  /// The array of an .npz, or the data set of an .h5 ("/camera/raw"); empty: the one called "raw",
  /// or the only one.
  std::string dataset;
  /// How a dump without header is laid out; the file is then read as one, whatever its extension,
  /// and `layout` does not count.
  std::optional<RawFormat> format;
  /// Replaces saturated and invalid numbers before any arithmetic (see DecodingTable::marking). The
  /// default replaces none.
  RawMarking marking = {};
};

class RawDumpReader;
struct StoredArray;

/// Reads rows of the frames of a recording as they stand in the file, .npy and .h5 of any size in
/// the memory of those rows; so is a dump that a RawFormat describes. An .npz, or an .npy in
/// Fortran order, is held in memory as a whole.
/// @note reading is safe from many threads at once, each with a buffer of its own
class RawFramesReader {
 public:
  /// @throws IoError as read_raw_frames(), if a file that cannot be read in parts would take more
  ///         memory than allowed, if an .h5 has no such data set, or if the file's numbers cannot
  ///         be one of the markers
  explicit RawFramesReader(const std::filesystem::path& path, const RawReadOptions& options = {});
  /// One file for each measurement of a pixel, in their order: (H, W) or (F, H, W) each, or dumps
  /// of one measurement. One file alone holds all measurements; `layout` counts for it only.
  /// @throws IoError as above; naming the file whose type or shape is not that of the first
  explicit RawFramesReader(const std::vector<std::filesystem::path>& files,
                           const RawReadOptions& options = {});
  ~RawFramesReader();
  RawFramesReader(RawFramesReader&&) noexcept;

  int frames() const { return sizes_.frames; }
  int height() const { return sizes_.height; }
  int width() const { return sizes_.width; }
  int measurements() const { return sizes_.measurements; }
  /// Type of the numbers before marking: float32 for int8, int16, float16 and dumps, float64 for
  /// whole numbers of more than 16 bits.
  NpyType type() const { return type_; }
  /// Whether the file holds whole numbers.
  bool holds_integers() const { return holds_integers_; }
  /// Memory of one row of a frame in type() [bytes].
  std::size_t row_bytes() const;
  /// Additional memory of one row that is marked or turned [bytes]; 0 if there is none.
  std::size_t marked_row_bytes() const;
  /// What the reader itself holds [bytes]: the values of a file that cannot be read in parts.
  std::size_t bytes_in_memory() const;

  /// Rows first_row .. first_row + rows - 1 of a frame, in the file's layout and in type(): numbers
  /// of .npy and .npz in one of the types of RawView are not converted, big-endian ones are turned
  /// round. Where marking may replace numbers, all are floats or doubles, side by side.
  /// @param buffer  what the view looks at, as long as no later call changes it
  /// @throws std::invalid_argument if there is no such frame or row
  /// @throws IoError if the file cannot be read or became shorter
  RawView read_rows(int frame, int first_row, int rows, std::vector<std::byte>& buffer) const;
  /// Frame `index` alone, as (1, H, W, K) floats.
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

  std::unique_ptr<StoredArray> file_;    // none if `whole_` holds everything
  std::unique_ptr<RawDumpReader> dump_;  // of a dump: the only one of the three
  std::vector<RawFramesReader> parts_;   // one a measurement; then none of the others
  NpyArray whole_;
  NpyType type_ = NpyType::float32;
  bool holds_integers_ = false, holds_unsigned_ = false;
  RawMarking marking_;
  RawLayout layout_ = RawLayout::interleaved;
  RawFrames sizes_;  // without values
};

/// All frames of one file, or of one file for each measurement, in memory.
/// @throws IoError as RawFramesReader
RawFrames read_raw_frames(const std::vector<std::filesystem::path>& files,
                          const RawReadOptions& options);

}  // namespace tofsmith
