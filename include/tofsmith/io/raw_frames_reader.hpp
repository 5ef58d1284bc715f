// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "tofsmith/core/array.hpp"
#include "tofsmith/core/raw_view.hpp"
#include "tofsmith/io/npy_stream.hpp"
#include "tofsmith/io/npz.hpp"
#include "tofsmith/io/raw_format.hpp"

namespace tofsmith {

/// Where the K measurements of a pixel stand in a file.
enum class RawLayout {
  interleaved,  ///< (H, W, K) or (F, H, W, K): side by side
  planar,       ///< (K, H, W) or (F, K, H, W): one image per measurement
};

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
  /// Most memory [bytes] for files that cannot be read in parts: .npz, and .npy in Fortran order.
  std::uint64_t largest_in_memory = max_npz_bytes;
  /// How a dump without header is laid out; the file is then read as one, whatever its extension,
  /// and `layout` does not count.
  std::optional<RawFormat> format;
};

class RawDumpReader;

/// Reads rows of the frames of a recording as they stand in the file, .npy of any size in the
/// memory of those rows; so is a dump that a RawFormat describes. An .npz, or an .npy in Fortran
/// order, is held in memory as a whole.
/// @note reading is safe from many threads at once, each with a buffer of its own
class RawFramesReader {
 public:
  /// @throws IoError as read_raw_frames() in raw_frames_file.hpp, or if a file that cannot be read
  /// in parts would take
  ///         more memory than allowed
  explicit RawFramesReader(const std::filesystem::path& path, const RawReadOptions& options = {});
  ~RawFramesReader();
  RawFramesReader(RawFramesReader&&) noexcept;

  int frames() const { return sizes_.frames; }
  int height() const { return sizes_.height; }
  int width() const { return sizes_.width; }
  int measurements() const { return sizes_.measurements; }
  /// Of the numbers that read_rows() gives: int16 and dumps come as floats.
  NpyType type() const { return type_; }
  /// Whether the file holds whole numbers.
  bool holds_integers() const { return holds_integers_; }
  /// What one row of a frame takes [bytes].
  std::size_t row_bytes() const;
  /// What the reader itself holds [bytes]: the values of a file that cannot be read in parts.
  std::size_t bytes_in_memory() const { return whole_.bytes().size(); }

  /// Rows first_row .. first_row + rows - 1 of a frame, in the file's layout and in type(): numbers
  /// of .npy and .npz but int16 are not converted, big-endian ones are turned round.
  /// @param buffer  what the view looks at, as long as no later call changes it
  /// @throws std::invalid_argument if there is no such frame or row
  /// @throws IoError if the file cannot be read or became shorter
  RawView read_rows(int frame, int first_row, int rows, std::vector<std::byte>& buffer) const;
  /// Frame `index` alone, as (1, H, W, K) floats.
  RawFrames read_frame(int index) const;

 private:
  void open_array(const std::filesystem::path& path, const RawReadOptions& options);
  void open_dump(const std::filesystem::path& path, const RawReadOptions& options);
  void read_stored_rows(int frame, int first_row, int rows, std::vector<std::byte>& buffer) const;
  RawView view_of(const std::byte* data, int rows, int rows_of_a_plane) const;
  RawView rows_in_memory(int frame, int first_row, int rows) const;

  std::optional<NpyReader> file_;        // none if `whole_` holds everything
  std::unique_ptr<RawDumpReader> dump_;  // of a dump: the only one of the three
  NpyArray whole_;
  NpyType type_ = NpyType::float32;
  bool holds_integers_ = false;
  RawLayout layout_;
  RawFrames sizes_;  // without values
};

}  // namespace tofsmith
