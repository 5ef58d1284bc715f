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

NpyArray NpyReader::read_rows(std::size_t begin, std::size_t count) const {
  const NpyHeader& header = state_->header;
  require(!header.shape.empty(), "axes", header.shape.size(), "must be >= 1 to read slices");
  const std::size_t rows = header.shape[0];
  require(begin <= rows, "begin", begin, fmt::format("must be <= {} slices", rows));
  require(count <= rows - begin, "count", count,
          fmt::format("must be <= {}, the slices from {} on", rows - begin, begin));

  NpyShape shape = header.shape;
  shape[0] = count;
  NpyArray slice(header.type, shape);
  if (slice.size() == 0) return slice;
  const std::size_t row_bytes = slice.bytes().size() / count;
  if (!header.fortran_order || count == rows) {
    state_->file.read_at(header.data_offset + begin * row_bytes, slice.bytes());
  } else {  // the wanted stretch of the first axis, for every index of the others
    const std::size_t item = item_size(header.type);
    for (std::size_t column = 0; column < row_bytes / item; ++column)
      state_->file.read_at(header.data_offset + (column * rows + begin) * item,
                           slice.bytes().subspan(column * count * item, count * item));
  }
  restore_host_order(header, slice);
  return slice;
}

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

NpyWriter::NpyWriter(const std::filesystem::path& path, NpyType type, NpyShape row_shape,
                     OutputPolicy policy)
    : file_(path, policy), type_(type), row_shape_(std::move(row_shape)) {
  NpyShape shape = row_shape_;
  shape.insert(shape.begin(), 0);
  file_.write(serialize_npy_header(type_, shape));
}

void NpyWriter::append(const NpyArray& rows) {
  const bool same_shape =
      rows.axes() == row_shape_.size() + 1 &&
      std::equal(row_shape_.begin(), row_shape_.end(), rows.shape().begin() + 1);
  if (rows.type() != type_ || !same_shape)
    throw std::invalid_argument(fmt::format("rows = {} {}; must be (n, ...) slices {} of {}",
                                            name_of(rows.type()), describe_shape(rows.shape()),
                                            describe_shape(row_shape_), name_of(type_)));
  if constexpr (host_is_little_endian) {
    file_.write(rows.bytes());
  } else {
    NpyArray swapped = rows;
    swap_byte_order(swapped.bytes(), item_size(type_));
    file_.write(std::as_const(swapped).bytes());
  }
  rows_ += rows.shape()[0];
}

void NpyWriter::commit() {
  NpyShape shape = row_shape_;
  shape.insert(shape.begin(), rows_);
  const std::string header = serialize_npy_header(type_, shape);
  file_.write_at(0, std::as_bytes(std::span(header)));
  file_.commit();
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
