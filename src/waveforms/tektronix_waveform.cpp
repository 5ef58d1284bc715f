// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "waveforms/tektronix_waveform.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "io/shared/byte_order.hpp"
#include "tofsmith/core/error.hpp"
#include "waveforms/ieee488_block.hpp"

namespace tofsmith {

namespace {

constexpr std::string_view tfw_magic = "TEKAFG3000";
constexpr std::size_t tfw_header_bytes = 512, tfw_fields_at = 16, tfw_picture_at = 28;
constexpr std::uint32_t tfw_version = 20050114;
constexpr int tfw_picture_columns = 206;  // each has a minimum and a maximum of 8 bits

constexpr std::size_t record_bytes = 5;

void put_u32_big(std::span<std::byte> into, std::uint32_t value) {
  for (std::size_t i = 0; i < 4; ++i) into[i] = static_cast<std::byte>(value >> (24 - 8 * i));
}

void draw(const std::vector<std::int32_t>& codes, std::span<std::byte> picture) {
  const std::size_t columns = std::min<std::size_t>(tfw_picture_columns, codes.size());
  for (std::size_t c = 0; c < columns; ++c) {
    const auto begin = codes.begin() + static_cast<std::ptrdiff_t>(codes.size() * c / columns);
    const auto end = codes.begin() + static_cast<std::ptrdiff_t>(codes.size() * (c + 1) / columns);
    const auto [min, max] = std::minmax_element(begin, end);
    picture[2 * c] = static_cast<std::byte>(*min >> 6);
    picture[2 * c + 1] = static_cast<std::byte>(*max >> 6);
  }
}

}  // namespace

std::vector<std::byte> tektronix_afg_bytes(const QuantizedWaveform& waveform) {
  waveform.validate();
  require(waveform.levels <= tektronix_afg_full_levels, waveform.name + " levels", waveform.levels,
          fmt::format("must be <= {}", tektronix_afg_full_levels));
  std::vector<std::byte> bytes;
  bytes.reserve(2 * waveform.codes.size());
  for (const std::int32_t code : waveform.codes) {
    bytes.push_back(static_cast<std::byte>(code >> 8));
    bytes.push_back(static_cast<std::byte>(code & 0xff));
  }
  return bytes;
}

std::vector<std::byte> tektronix_tfw(const QuantizedWaveform& waveform) {
  const std::vector<std::byte> points = tektronix_afg_bytes(waveform);
  std::vector<std::byte> file(tfw_header_bytes + points.size());
  std::ranges::copy(std::as_bytes(std::span(tfw_magic)), file.begin());
  const auto fields = std::span(file).subspan(tfw_fields_at);
  put_u32_big(fields, tfw_version);
  put_u32_big(fields.subspan(4), static_cast<std::uint32_t>(waveform.codes.size()));
  put_u32_big(fields.subspan(8), 1);
  draw(waveform.codes, std::span(file).subspan(tfw_picture_at));
  std::ranges::copy(points, file.begin() + tfw_header_bytes);
  return file;
}

std::vector<std::byte> tektronix_wfm(const QuantizedWaveform& waveform,
                                     std::string_view end_of_line) {
  waveform.validate();
  std::vector<std::byte> records(record_bytes * waveform.codes.size());
  for (int j = 0; j < waveform.points(); ++j) {
    std::byte* const record = records.data() + record_bytes * static_cast<std::size_t>(j);
    const double code = waveform.codes[static_cast<std::size_t>(j)];
    store_little_endian(static_cast<float>(2.0 * code / (waveform.levels - 1) - 1.0), record);
    record[4] = static_cast<std::byte>((waveform.trigger_at(j) ? 1 : 0) | (j == 0 ? 2 : 0));
  }
  const std::vector<std::byte> block = ieee488_block(records);
  const std::string begin = fmt::format("MAGIC 1000{}", end_of_line),
                    end = fmt::format("CLOCK {:.10e}{}", waveform.sample_rate_hz, end_of_line);
  std::vector<std::byte> file;
  file.reserve(begin.size() + block.size() + end.size());
  const auto append = [&](std::span<const std::byte> part) {
    file.insert(file.end(), part.begin(), part.end());
  };
  append(std::as_bytes(std::span(begin)));
  append(block);
  append(std::as_bytes(std::span(end)));
  return file;
}

}  // namespace tofsmith
