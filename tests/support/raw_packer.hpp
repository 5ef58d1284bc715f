// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "damaged_files.hpp"
#include "tofsmith/io/raw_frames.hpp"

namespace tofsmith {

/// Reads a frame as (1, H, W, K).
inline RawFrames read_frame(const RawFramesReader& reader, int index) {
  std::vector<std::byte> buffer;
  const RawView view = reader.read_rows(index, 0, reader.height(), buffer);
  RawFrames frame{1, view.height, view.width, view.measurements, {}};
  frame.values.resize(static_cast<std::size_t>(view.pixels() * view.measurements));
  copy_pixels(view, 0, view.pixels(), frame.values.data());
  return frame;
}

/// Writes a raw file bit by bit according to docs/raw_formats.md, with a map of each bit's place.
class RawPacker {
 public:
  explicit RawPacker(const RawFormat& format) : format_(format) {}

  FileBytes pack(const std::vector<double>& numbers, int frames) {
    gap(format_.header_bytes);
    auto next = numbers.begin();
    for (int f = 0; f < frames; ++f) {
      gap(format_.frame_header_bytes);
      for (std::size_t image = 0; image < format_.images(); ++image) {
        gap(format_.image_header_bytes);
        const std::size_t begin = bytes_.size();
        for (std::size_t row = 0; row < format_.rows_per_image(); ++row) {
          if (format_.rows_start_bytes) align();
          const std::size_t row_begin = bytes_.size();
          if (format_.row_header_bytes > 0) gap(format_.row_header_bytes);
          const auto end = next + static_cast<std::ptrdiff_t>(format_.numbers_per_row());
          put_row({next, end});
          next = end;
          if (format_.row_bytes > 0)
            gap(format_.row_bytes - static_cast<int>(bytes_.size() - row_begin));
        }
        align();
        EXPECT_EQ(bytes_.size() - begin, format_.image_bytes());
        gap(format_.image_trailer_bytes);
      }
      gap(format_.frame_trailer_bytes);
    }
    gap(format_.trailer_bytes);
    return bytes_;
  }

 private:
  void gap(int count) {
    align();
    bytes_.insert(bytes_.end(), static_cast<std::size_t>(count), std::byte{0xa5});
  }
  void align() { bit_ = 0; }
  std::uint64_t word_of(double number) const {
    const auto integer = static_cast<std::int64_t>(number);
    const auto word = static_cast<std::uint64_t>(integer);
    const std::uint64_t all = (std::uint64_t{1} << format_.bits) - 1;
    if (!format_.is_signed) return word & all;
    // Bits above the sign bit are ignored by readers: set some of them.
    const std::uint64_t sign = std::uint64_t{1} << format_.sign_bit.value_or(format_.bits - 1),
                        unused = all & ~(2 * sign - 1) & 0xaaaaaaaa;
    if (format_.sign_encoding == SignEncoding::twos_complement)
      return (word & (2 * sign - 1)) | unused;
    return (integer < 0 ? sign | static_cast<std::uint64_t>(-integer) : word) | unused;
  }
  /// Returns the IEEE half-precision bits of an exactly representable number: 0 or at least 2^-14.
  static std::uint64_t half_of(double number) {
    if (number == 0.0) return 0;
    const int exponent = std::ilogb(number);
    const double mantissa = (std::ldexp(std::abs(number), -exponent) - 1.0) * 1024.0;
    return (number < 0.0 ? 0x8000U : 0U) | static_cast<unsigned>(exponent + 15) << 10 |
           static_cast<unsigned>(mantissa);
  }
  void put_bit(bool bit) {
    if (bit_ == 0) bytes_.push_back(std::byte{0});
    const int place = format_.packing == RawPacking::msb_first ? 7 - bit_ : bit_;
    if (bit) bytes_.back() |= static_cast<std::byte>(1U << place);
    bit_ = (bit_ + 1) % 8;
  }
  void put_container(std::uint64_t word, std::size_t size) {
    for (std::size_t i = 0; i < size; ++i)
      bytes_.push_back(static_cast<std::byte>(
          word >> 8 * (format_.byte_order == RawByteOrder::big ? size - 1 - i : i)));
  }
  void put_row(const std::vector<double>& row) {
    if (format_.numbers == RawNumbers::floats) {
      for (const double number : row)
        if (format_.bits == 64)
          put_container(std::bit_cast<std::uint64_t>(number), 8);
        else if (format_.bits == 16)
          put_container(half_of(number), 2);
        else
          put_container(std::bit_cast<std::uint32_t>(static_cast<float>(number)), 4);
    } else if (format_.packing == RawPacking::plain) {
      const int container = format_.container_bits > 0 ? format_.container_bits
                            : format_.bits <= 8        ? 8
                            : format_.bits <= 16       ? 16
                                                       : 32;
      for (const double number : row)
        put_container(word_of(number)
                          << (format_.align == RawAlignment::high ? container - format_.bits : 0),
                      static_cast<std::size_t>(container) / 8);
    } else if (format_.packing == RawPacking::mipi) {
      const std::size_t group = format_.bits == 12 ? 2 : 4;
      for (std::size_t at = 0; at < row.size(); at += group) {
        for (std::size_t i = 0; i < group; ++i)
          put_container(word_of(row[at + i]) >> (format_.bits - 8), 1);
        for (std::size_t i = 0; i < group; ++i)
          for (int b = 0; b < format_.bits - 8; ++b) put_bit((word_of(row[at + i]) >> b & 1) != 0);
      }
    } else {
      for (const double number : row)
        for (int b = 0; b < format_.bits; ++b) {
          const int place = format_.packing == RawPacking::msb_first ? format_.bits - 1 - b : b;
          put_bit((word_of(number) >> place & 1) != 0);
        }
    }
  }

  const RawFormat& format_;
  FileBytes bytes_;
  int bit_ = 0;
};

}  // namespace tofsmith
