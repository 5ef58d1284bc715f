// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "io/recordings/decoded_output.hpp"
#include "io/recordings/prepared_frames.hpp"
#include "tofsmith/io/decode_recording.hpp"

namespace tofsmith {

/// Everything of a request that needs no file. @throws std::invalid_argument
void check_request(const DecodeRequest& request, const AnyDecoder& decoder);

/// How frames are seen. @param source  of the frames, for errors
/// @throws IoError if the lens is of images of another size or its distortion folds back inside
/// them
PinholeView view_of_frames(const DecodeRequest& request, const std::string& source, int width,
                           int height);

/// How a lens's distortion is taken out of planes, if that is asked for and there is one.
std::optional<Undistortion> undistortion_of(const DecodeRequest& request, const PinholeView& view);

/// The planes to write; every plane once.
std::vector<DecodedPlane> planes_to_write(const DecodeRequest& request, const AnyDecoder& decoder);

Preparation preparation_of(const DecodeRequest& request);

/// A decoder with what differs from pixel to pixel.
class MappedDecoder {
 public:
  /// @param source  of the frames, for errors
  /// @throws IoError if maps cannot be read or do not fit, or frames are not of the size of the
  ///         table's depth correction
  MappedDecoder(const DecodeRequest& request, const AnyDecoder& decoder, const std::string& source,
                int height, int width);

  const DecodingTable& table() const { return table_; }

  /// Decodes one band to where it belongs in the planes.
  /// @param unfiltered  where a filter gave `raw` and mixed pixels are looked for
  void decode(const RawView& raw, const Band& band, const DecodeTarget& target,
              const DecodedView& decoded, const Progress& progress,
              const UnfilteredPixels& unfiltered = {}) const;
  /// Whether it is the request's `filter_by` that filters.
  bool filters() const { return static_cast<bool>(filter_by_); }
  /// Filters and decodes a frame by that.
  /// @param filtered  null: its numbers are not wanted, and mixed pixels not looked for
  void filter_and_decode(const RawView& raw, const Band& band, const DecodeTarget& target,
                         const DecodedView& decoded, FilteredFrame* filtered,
                         const Progress& progress, const UnfilteredPixels& unfiltered) const;

 private:
  /// What follows on decoding. @param raw  what was decoded, where mixed pixels are looked for
  void finish(const RawView& raw, const Band& band, const DecodeTarget& target,
              const DecodedView& decoded, const UnfilteredPixels& unfiltered) const;

  const AnyDecoder& decoder_;
  decltype(DecodeRequest::decode_by) decode_by_;
  decltype(DecodeRequest::filter_by) filter_by_;  // empty without a filter
  const DecodingTable& table_;
  PixelMaps maps_;
  std::optional<MixedPixels> mixed_;  // in bands that are whole frames
};

/// Decodes the next band of the frames to where it belongs in the planes; false after the last.
/// Filtered frames of which mixed pixels are looked for are filtered once more without those.
bool decode_next(PreparedFrames& input, const MappedDecoder& decoder, const Band& band,
                 const DecodeTarget& target, DecodedPlanes& planes, const Progress& progress);

/// What every decoder decodes with.
const DecodingTable& table_of(const AnyDecoder& decoder);

}  // namespace tofsmith
