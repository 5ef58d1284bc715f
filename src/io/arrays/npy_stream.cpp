// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/io/npy.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <utility>
#include <vector>

#include "io/arrays/npy_header.hpp"
#include "io/input_file.hpp"
#include "io/shared/byte_order.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

struct NpyReader::State {
  InputFile file;
  NpyHeader header;
};

NpyReader::NpyReader(const std::filesystem::path& path) {
  InputFile file(path);
  if (!file.size())
    throw IoError(path.string(), "found a pipe or device; expected a file, read in slices");
  std::vector<std::byte> start(std::min<std::uint64_t>(*file.size(), max_npy_header_bytes));
  file.read_at(0, start);
  NpyHeader header = parse_npy_header(start, *file.size(), path.string());
  state_ = std::make_unique<State>(State{std::move(file), std::move(header)});
}

NpyReader::~NpyReader() = default;
NpyReader::NpyReader(NpyReader&&) noexcept = default;

NpyType NpyReader::type() const { return state_->header.type; }
const NpyShape& NpyReader::shape() const { return state_->header.shape; }
bool NpyReader::fortran_order() const { return state_->header.fortran_order; }

NpyArray NpyReader::read_all() const {
  NpyArray array(type(), shape());
  state_->file.read_at(state_->header.data_offset, array.bytes());
  restore_host_order(state_->header, array);
  return array;
}

void NpyReader::read_items(std::size_t first, std::span<std::byte> into) const {
  const NpyHeader& header = state_->header;
  const std::size_t item = item_size(header.type), items = header.data_bytes / item;
  require(into.size() % item == 0, "bytes to read", into.size(),
          fmt::format("must be a multiple of {}", item));
  require(first <= items && into.size() / item <= items - first, "first", first,
          fmt::format("must leave {} items of {}", into.size() / item, items));
  state_->file.read_at(header.data_offset + first * item, into);
  if (header.foreign_byte_order) swap_byte_order(into, item);
}

NpyItemWriter::NpyItemWriter(const std::filesystem::path& path, NpyType type, const NpyShape& shape,
                             OutputPolicy policy)
    : file_(path, policy), type_(type) {
  const auto bytes = npy_byte_count(type, shape);
  require(bytes.has_value(), "shape", describe_shape(shape), "must fit in a file");
  missing_bytes_ = *bytes;
  file_.write(serialize_npy_header(type, shape));
}

void NpyItemWriter::append(std::span<const std::byte> items) {
  require(
      items.size() <= missing_bytes_ && items.size() % item_size(type_) == 0, "bytes", items.size(),
      fmt::format("must be whole items and at most the {} bytes that are missing", missing_bytes_));
  if constexpr (host_is_little_endian) {
    file_.write(items);
  } else {
    std::vector<std::byte> swapped(items.begin(), items.end());
    swap_byte_order(swapped, item_size(type_));
    file_.write(swapped);
  }
  missing_bytes_ -= items.size();
}

void NpyItemWriter::commit() {
  require(missing_bytes_ == 0, "missing bytes", missing_bytes_, "must be 0 at the end");
  file_.commit();
}

}  // namespace tofsmith
