// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>

#include "core/shared/bits.hpp"
#include "io/half_precision.hpp"
#include "io/shared/byte_order.hpp"
#include "tofsmith/io/raw_format.hpp"

namespace tofsmith {

namespace {

double counted(std::uint64_t word, const RawFormat& format) {
  if (!format.is_signed) return static_cast<double>(word);
  const int sign = format.sign_bit_index();
  const auto rest = static_cast<std::int64_t>(word & mask_of(sign));
  if ((word >> sign & 1) == 0) return static_cast<double>(rest);
  return static_cast<double>(format.sign_encoding == SignEncoding::sign_magnitude
                                 ? -rest
                                 : rest - (std::int64_t{1} << sign));
}

template <typename Value>
Value load(const std::byte* from, RawByteOrder order) {
  if (order == RawByteOrder::little) return load_little_endian<Value>(from);
  std::array<std::byte, sizeof(Value)> turned;
  std::reverse_copy(from, from + sizeof(Value), turned.begin());
  return load_little_endian<Value>(turned.data());
}

/// Returns true if unused bits are zero or, above a signed number, copies of its sign.
bool fits(const RawFormat& format, std::uint64_t container, int container_bits) {
  const int unused = container_bits - format.bits;
  if (format.align == RawAlignment::high) return (container & mask_of(unused)) == 0;
  const std::uint64_t above = container >> format.bits;
  const bool is_negative = (container >> format.sign_bit_index() & 1) != 0;
  return above == 0 || (format.is_signed && is_negative && above == mask_of(unused));
}

template <typename Container>
std::optional<OversizedNumber> find_oversized(const RawFormat& format,
                                              std::span<const std::byte> row) {
  for (std::size_t i = 0; (i + 1) * sizeof(Container) <= row.size(); ++i) {
    const std::uint64_t container =
        load<Container>(row.data() + i * sizeof(Container), format.byte_order);
    if (!fits(format, container, 8 * static_cast<int>(sizeof(Container))))
      return OversizedNumber{i, container};
  }
  return std::nullopt;
}

template <typename Container>
void unpack_plain(const RawFormat& format, const std::byte* from, std::span<double> numbers) {
  const int container_bits = 8 * static_cast<int>(sizeof(Container));
  const int shift = format.align == RawAlignment::high ? container_bits - format.bits : 0;
  const std::uint64_t mask = mask_of(format.bits);
  for (double& number : numbers) {
    number =
        counted(std::uint64_t{load<Container>(from, format.byte_order)} >> shift & mask, format);
    from += sizeof(Container);
  }
}

template <typename Float>
void unpack_floats(const RawFormat& format, const std::byte* from, std::span<double> numbers) {
  for (double& number : numbers) {
    number = static_cast<double>(load<Float>(from, format.byte_order));
    from += sizeof(Float);
  }
}

void unpack_halves(const RawFormat& format, const std::byte* from, std::span<double> numbers) {
  for (double& number : numbers) {
    number = static_cast<double>(float_of_half(load<std::uint16_t>(from, format.byte_order)));
    from += sizeof(std::uint16_t);
  }
}

/// Unpacks groups of 4 (RAW10, RAW14) or 2 (RAW12) numbers: their high bytes, then their low bits,
/// lowest for the first number.
void unpack_mipi(const RawFormat& format, const std::byte* from, std::span<double> numbers) {
  const std::size_t group = format.bits == 12 ? 2 : 4;
  const int low_bits = format.bits - 8;
  const std::size_t low_bytes = group * static_cast<std::size_t>(low_bits) / 8;
  for (std::size_t at = 0; at < numbers.size(); at += group) {
    std::uint64_t low = 0;
    for (std::size_t i = 0; i < low_bytes; ++i)
      low |= std::to_integer<std::uint64_t>(from[group + i]) << (8 * i);
    for (std::size_t i = 0; i < group; ++i) {
      const std::uint64_t rest =
          low >> (i * static_cast<std::size_t>(low_bits)) & mask_of(low_bits);
      numbers[at + i] = counted(std::to_integer<std::uint64_t>(from[i]) << low_bits | rest, format);
    }
    from += group + low_bytes;
  }
}

void unpack_stream(const RawFormat& format, std::span<const std::byte> row, int first_bit,
                   std::span<double> numbers) {
  const bool low_first = format.packing == RawPacking::lsb_first;
  const std::uint64_t mask = mask_of(format.bits);
  std::uint64_t held = 0;  // unused bits: the next one is the lowest, or the highest of `count`
  int count = 0;
  std::size_t next = 0;
  const auto take_byte = [&] {
    const auto byte = std::to_integer<std::uint64_t>(row[next++]);
    held = low_first ? held | byte << count : held << 8 | byte;
    count += 8;
  };
  if (first_bit > 0) {
    take_byte();
    count -= first_bit;
    held = low_first ? held >> first_bit : held & mask_of(count);
  }
  for (double& number : numbers) {
    while (count < format.bits) take_byte();
    count -= format.bits;
    number = counted((low_first ? held : held >> count) & mask, format);
    held = low_first ? held >> format.bits : held & mask_of(count);
  }
}

}  // namespace

std::optional<OversizedNumber> find_oversized_number(const RawFormat& format,
                                                     std::span<const std::byte> row) {
  const int container = format.stored_bits();
  if (format.unused_bits == UnusedBits::ignored || container == format.bits) return std::nullopt;
  if (container == 8) return find_oversized<std::uint8_t>(format, row);
  if (container == 16) return find_oversized<std::uint16_t>(format, row);
  return find_oversized<std::uint32_t>(format, row);
}

void unpack_numbers(const RawFormat& format, std::span<const std::byte> row, int first_bit,
                    std::span<double> numbers) {
  if (format.numbers == RawNumbers::floats && format.bits == 16)
    return unpack_halves(format, row.data(), numbers);
  if (format.numbers == RawNumbers::floats)
    return format.bits == 32 ? unpack_floats<float>(format, row.data(), numbers)
                             : unpack_floats<double>(format, row.data(), numbers);
  if (format.packing == RawPacking::mipi) return unpack_mipi(format, row.data(), numbers);
  if (format.packing != RawPacking::plain) return unpack_stream(format, row, first_bit, numbers);
  const int container = format.stored_bits();
  if (container == 8) return unpack_plain<std::uint8_t>(format, row.data(), numbers);
  if (container == 16) return unpack_plain<std::uint16_t>(format, row.data(), numbers);
  unpack_plain<std::uint32_t>(format, row.data(), numbers);
}

}  // namespace tofsmith
