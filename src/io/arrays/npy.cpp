// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/io/npy.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstring>
#include <utility>
#include <vector>

#include "io/arrays/npy_header.hpp"
#include "io/half_precision.hpp"
#include "io/input_file.hpp"
#include "io/shared/byte_order.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

namespace {

template <typename Number, typename... Items>
std::vector<Number> converted(const NpyArray& array) {
  std::vector<Number> numbers(array.size());
  const NpyType type = array.type() == NpyType::boolean ? NpyType::uint8 : array.type();
  const auto convert_if = [&]<typename Item>(Item) {
    if (type != npy_type_of<Item>) return;
    const auto* items = reinterpret_cast<const Item*>(array.bytes().data());
    std::transform(items, items + array.size(), numbers.begin(),
                   [](Item item) { return static_cast<Number>(item); });
  };
  (convert_if(Items()), ...);
  return numbers;
}

template <typename Number>
std::vector<Number> converted_halves(const NpyArray& array) {
  std::vector<Number> numbers(array.size());
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    std::uint16_t bits;
    std::memcpy(&bits, array.bytes().data() + i * sizeof(bits), sizeof(bits));
    numbers[i] = static_cast<Number>(float_of_half(bits));
  }
  return numbers;
}

template <typename Number>
std::vector<Number> to_numbers(const NpyArray& array) {
  if (array.type() == NpyType::float16) return converted_halves<Number>(array);
  return converted<Number, std::int8_t, std::int16_t, std::int32_t, std::int64_t, std::uint8_t,
                   std::uint16_t, std::uint32_t, std::uint64_t, float, double>(array);
}

}  // namespace

std::size_t item_size(NpyType type) { return npy_types[static_cast<std::size_t>(type)].bytes; }
std::string_view name_of(NpyType type) { return npy_types[static_cast<std::size_t>(type)].name; }

bool is_float(NpyType type) {
  return type == NpyType::float16 || type == NpyType::float32 || type == NpyType::float64;
}

std::string describe_shape(const NpyShape& shape) {
  if (shape.size() == 1) return fmt::format("({},)", shape[0]);
  return fmt::format("({})", fmt::join(shape, ", "));
}

NpyArray::NpyArray(NpyType type, NpyShape shape) : type_(type), shape_(std::move(shape)) {
  const auto bytes = npy_byte_count(type_, shape_);
  require(bytes.has_value(), "shape", describe_shape(shape_), "must fit in memory");
  bytes_.resize(*bytes);
}

void NpyArray::fill(std::span<const std::byte> values) {
  require(values.size() == bytes_.size(), "number of values", values.size() / item_size(type_),
          fmt::format("must be {} for shape {}", size(), describe_shape(shape_)));
  std::copy(values.begin(), values.end(), bytes_.begin());
}

void NpyArray::check_type(NpyType asked) const {
  if (asked == type_ || (asked == NpyType::uint8 && type_ == NpyType::boolean)) return;
  reject("type", name_of(type_), fmt::format("must be {} here", name_of(asked)));
}

std::vector<double> NpyArray::to_doubles() const { return to_numbers<double>(*this); }
std::vector<float> NpyArray::to_floats() const { return to_numbers<float>(*this); }

NpyArray parse_npy(std::span<const std::byte> content, std::string_view file) {
  const NpyHeader header = parse_npy_header(content, content.size(), file);
  NpyArray array(header.type, header.shape);
  const auto data = content.subspan(header.data_offset);
  std::copy(data.begin(), data.end(), array.bytes().begin());
  restore_host_order(header, array);
  return array;
}

NpyArray read_npy(const std::filesystem::path& path) { return NpyReader(path).read_all(); }

std::vector<std::byte> serialize_npy(const NpyArray& array) {
  const std::string header = serialize_npy_header(array.type(), array.shape());
  const auto header_bytes = std::as_bytes(std::span(header));
  std::vector<std::byte> content(header_bytes.begin(), header_bytes.end());
  content.insert(content.end(), array.bytes().begin(), array.bytes().end());
  if constexpr (!host_is_little_endian)
    swap_byte_order(std::span(content).subspan(header.size()), item_size(array.type()));
  return content;
}

void write_npy(const std::filesystem::path& path, const NpyArray& array, OutputPolicy policy) {
  AtomicFile file(path, policy);
  if constexpr (host_is_little_endian) {  // avoids copying arrays of several gigabytes
    file.write(serialize_npy_header(array.type(), array.shape()));
    file.write(array.bytes());
  } else {
    file.write(serialize_npy(array));
  }
  file.commit();
}

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
