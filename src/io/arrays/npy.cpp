// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/io/npy.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cstring>
#include <utility>
#include <vector>

#include "io/arrays/npy_header.hpp"
#include "io/byte_cursor.hpp"
#include "io/half_precision.hpp"
#include "io/input_file.hpp"
#include "io/shared/byte_order.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

namespace {

/// Reads the Python literal {'descr': '<f4', 'fortran_order': False, 'shape': (3, 4), }.
class HeaderLiteral {
 public:
  HeaderLiteral(std::span<const std::byte> bytes, std::size_t offset, std::string_view file)
      : cursor_(bytes, file) {
    cursor_.take(offset, "header");
  }

  void parse(NpyHeader& header) {
    expect('{');
    while (peek() != '}') {
      entry(header);
      if (peek() != '}') expect(',');
    }
    expect('}');
    for (const bool found : {has_type_, has_order_, has_shape_})
      if (!found) cursor_.fail("the header lacks one of 'descr', 'fortran_order', 'shape'");
    skip_spaces();
    if (!cursor_.at_end()) cursor_.fail("expected only spaces after the header's }");
  }

 private:
  void entry(NpyHeader& header) {
    skip_spaces();
    const std::size_t start = cursor_.position();
    const std::string_view key = quoted();
    expect(':');
    if (key == "descr") {
      note(has_type_, start);
      type(header);
    } else if (key == "fortran_order") {
      note(has_order_, start);
      header.fortran_order = truth();
    } else if (key == "shape") {
      note(has_shape_, start);
      header.shape = lengths();
    } else {
      cursor_.fail_at(start, fmt::format("found the key '{}'; expected 'descr', 'fortran_order' "
                                         "or 'shape'",
                                         printable(key)));
    }
  }

  void note(bool& seen, std::size_t start) {
    if (seen) cursor_.fail_at(start, "found the same key twice");
    seen = true;
  }

  void type(NpyHeader& header) {
    constexpr std::string_view known =
        "expected one of bool, int8 to int64, uint8 to uint64, float16, float32, float64";
    skip_spaces();
    const std::size_t start = cursor_.position();
    if (peek() == '[')
      cursor_.fail(fmt::format("found an array of records; {} (save one field)", known));
    const std::string_view descr = quoted();
    const std::string_view code = descr.substr(std::min<std::size_t>(1, descr.size()));
    if (!code.empty() && code[0] == 'O')
      cursor_.fail_at(start, fmt::format("found Python objects; {}", known));
    if (!code.empty() && code[0] == 'c')
      cursor_.fail_at(start, fmt::format("found complex numbers; {} (save real and imaginary "
                                         "parts apart)",
                                         known));
    const auto found = std::find_if(npy_types.begin(), npy_types.end(),
                                    [&](const NpyTypeEntry& entry) { return entry.code == code; });
    const bool one_byte = found != npy_types.end() && found->bytes == 1;
    const char order = descr.empty() ? '?' : descr[0];
    if (found == npy_types.end() || !(order == '<' || order == '>' || (order == '|' && one_byte)))
      cursor_.fail_at(start, fmt::format("found items of type '{}'; {}", printable(descr), known));
    header.type = found->type;
    header.foreign_byte_order = !one_byte && (order == '<') != host_is_little_endian;
  }

  bool truth() {
    skip_spaces();
    const std::size_t start = cursor_.position();
    const std::string_view word = letters();
    if (word != "True" && word != "False") cursor_.fail_at(start, "expected True or False");
    return word == "True";
  }

  NpyShape lengths() {
    NpyShape shape;
    expect('(');
    while (peek() != ')') {
      shape.push_back(length());
      // (3,) is a tuple, (3) is a number.
      if (peek() != ')' || shape.size() == 1) expect(',');
    }
    expect(')');
    return shape;
  }

  std::size_t length() {
    skip_spaces();
    const auto rest = cursor_.rest();
    const char* begin = reinterpret_cast<const char*>(rest.data());
    std::size_t value = 0;
    const auto [end, error] = std::from_chars(begin, begin + rest.size(), value);
    if (error == std::errc::result_out_of_range)
      cursor_.fail("found an axis longer than memory has addresses");
    if (error != std::errc()) cursor_.fail("expected the length of an axis, an integer >= 0");
    cursor_.take(static_cast<std::size_t>(end - begin), "header");
    if (peek() == 'L') expect('L');  // written by Python 2
    return value;
  }

  std::string_view quoted() {
    const char quote = peek();
    if (quote != '\'' && quote != '"') cursor_.fail("expected a quoted word");
    expect(quote);
    return cursor_.take_until(quote, "a quoted word");
  }

  std::string_view letters() {
    const auto rest = cursor_.rest();
    const auto end = std::find_if(rest.begin(), rest.end(), [](std::byte byte) {
      const char c = std::to_integer<char>(byte);
      return !((c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'));
    });
    return cursor_.take_text(static_cast<std::size_t>(end - rest.begin()), "header");
  }

  /// Returns the next character that is not a blank; '\0' at the end.
  char peek() {
    skip_spaces();
    return cursor_.at_end() ? '\0' : std::to_integer<char>(cursor_.rest()[0]);
  }

  void expect(char wanted) {
    if (peek() != wanted || cursor_.at_end())
      cursor_.fail(fmt::format("the header is malformed; expected {}", wanted));
    cursor_.take(1, "header");
  }

  void skip_spaces() {
    while (!cursor_.at_end()) {
      const char c = std::to_integer<char>(cursor_.rest()[0]);
      if (c != ' ' && c != '\n' && c != '\t' && c != '\r') return;
      cursor_.take(1, "header");
    }
  }

  static std::string printable(std::string_view word) {
    std::string text(word.substr(0, 40));
    for (char& c : text)
      if (c < ' ' || c > '~') c = '?';
    return text;
  }

  ByteCursor cursor_;
  bool has_type_ = false, has_order_ = false, has_shape_ = false;
};

void check_length(const NpyHeader& header, std::uint64_t file_bytes, std::string_view file) {
  const std::uint64_t there = file_bytes - header.data_offset;
  if (there == header.data_bytes) return;
  throw IoError(fmt::format("{}: byte {}", file, header.data_offset),
                fmt::format("found {} bytes of data; expected {} for shape {} of {}", there,
                            header.data_bytes, describe_shape(header.shape), name_of(header.type)));
}

void transpose_from_fortran(const NpyShape& shape, std::size_t item,
                            std::span<const std::byte> from, std::span<std::byte> to) {
  NpyShape stride(shape.size()), index(shape.size(), 0);
  std::size_t step = item;
  for (std::size_t axis = 0; axis < shape.size(); ++axis) {
    stride[axis] = step;
    step *= shape[axis];
  }
  std::size_t source = 0;
  for (std::size_t target = 0; target < to.size(); target += item) {
    std::memcpy(to.data() + target, from.data() + source, item);
    for (std::size_t axis = shape.size(); axis-- > 0;) {
      source += stride[axis];
      if (++index[axis] < shape[axis]) break;
      source -= stride[axis] * shape[axis];
      index[axis] = 0;
    }
  }
}

}  // namespace

NpyHeader parse_npy_header(std::span<const std::byte> start, std::uint64_t file_bytes,
                           std::string_view file) {
  ByteCursor cursor(start, file);
  if (cursor.take_text(6, "the NPY magic") != "\x93NUMPY")
    cursor.fail_at(0, "found no NPY magic; expected an array file written by numpy.save");
  const int major = std::to_integer<int>(cursor.take(1, "the version")[0]);
  const int minor = std::to_integer<int>(cursor.take(1, "the version")[0]);
  if (major < 1 || major > 3 || minor != 0)
    cursor.fail_at(6,
                   fmt::format("found NPY version {}.{}; expected 1.0, 2.0 or 3.0", major, minor));
  const std::size_t length = major == 1 ? cursor.take_u16_little("the header's length")
                                        : cursor.take_u32_little("the header's length");
  if (cursor.position() + length > max_npy_header_bytes)
    cursor.fail(fmt::format("found a header of {} bytes; expected at most 65536", length));
  const std::size_t literal = cursor.position();
  cursor.take(length, "the header");

  NpyHeader header;
  header.data_offset = cursor.position();
  HeaderLiteral(start.first(header.data_offset), literal, file).parse(header);
  const auto bytes = npy_byte_count(header.type, header.shape);
  if (!bytes)
    cursor.fail_at(literal, fmt::format("found shape {}; expected one that fits in memory",
                                        describe_shape(header.shape)));
  header.data_bytes = *bytes;
  check_length(header, file_bytes, file);
  return header;
}

std::string serialize_npy_header(NpyType type, const NpyShape& shape) {
  const NpyTypeEntry& entry = npy_types[static_cast<std::size_t>(type)];
  std::string literal =
      fmt::format("{{'descr': '{}{}', 'fortran_order': False, 'shape': {}, }}",
                  entry.bytes == 1 ? '|' : '<', entry.code, describe_shape(shape));
  // NumPy reserves 21 digits for the first axis, and pads the header to an aligned size.
  if (!shape.empty()) literal.append(21 - fmt::format("{}", shape[0]).size(), ' ');
  constexpr std::size_t alignment = 64, prefix = 10;
  literal.append(alignment - (prefix + literal.size() + 1) % alignment, ' ');
  literal += '\n';
  require(literal.size() <= 0xffff, "axes of the shape", shape.size(),
          "must fit in a header of 65535 bytes");
  std::string header = "\x93NUMPY";
  header += {'\x01', '\x00', static_cast<char>(literal.size() & 0xff),
             static_cast<char>(literal.size() >> 8)};
  return header + literal;
}

void restore_host_order(const NpyHeader& header, NpyArray& array) {
  if (header.foreign_byte_order) swap_byte_order(array.bytes(), item_size(array.type()));
  if (array.type() == NpyType::boolean)
    for (std::byte& truth : array.bytes()) truth = truth == std::byte{0} ? truth : std::byte{1};
  if (!header.fortran_order || array.axes() < 2) return;
  NpyArray transposed(array.type(), array.shape());
  transpose_from_fortran(array.shape(), item_size(array.type()), array.bytes(), transposed.bytes());
  array = std::move(transposed);
}

std::optional<std::size_t> npy_byte_count(NpyType type, const NpyShape& shape) {
  // The product of the other axes may overflow.
  if (std::find(shape.begin(), shape.end(), std::size_t{0}) != shape.end()) return 0;
  std::size_t count = item_size(type);
  for (const std::size_t length : shape)
    if (__builtin_mul_overflow(count, length, &count) || count > PTRDIFF_MAX) return std::nullopt;
  return count;
}

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
  state_ = make_hidden<State>(State{std::move(file), std::move(header)});
}

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
