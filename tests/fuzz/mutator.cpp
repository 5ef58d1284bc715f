// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Updates lengths and checksums after mutations. Otherwise almost all mutations of a PNG would be
// rejected by the checksum of a chunk, and mutations of an .npz by the checksum of an entry.
#include <zlib.h>

#include <cstring>
#include <optional>

#include "reader.hpp"

namespace tofsmith::fuzz {

namespace {

using Octets = std::vector<std::uint8_t>;

std::uint32_t big_endian(const std::uint8_t* at) {
  return std::uint32_t{at[0]} << 24 | std::uint32_t{at[1]} << 16 | std::uint32_t{at[2]} << 8 |
         at[3];
}
void put_big_endian(std::uint8_t* at, std::uint32_t value) {
  for (int i = 0; i < 4; ++i) at[i] = static_cast<std::uint8_t>(value >> (24 - 8 * i));
}
std::uint32_t little_endian(const std::uint8_t* at, int bytes) {
  std::uint32_t value = 0;
  for (int i = bytes; i-- > 0;) value = value << 8 | at[i];
  return value;
}
void append_little_endian(Octets& to, std::uint32_t value, int bytes) {
  for (int i = 0; i < bytes; ++i) to.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
}
std::uint32_t checksum(const std::uint8_t* data, std::size_t size) {
  return static_cast<std::uint32_t>(crc32(0, data, static_cast<uInt>(size)));
}

/// Returns the uncompressed data if it is at most 1 MB.
std::optional<Octets> inflated(const std::uint8_t* data, std::size_t size, int window_bits) {
  z_stream stream{};
  if (inflateInit2(&stream, window_bits) != Z_OK) return std::nullopt;
  Octets out(std::size_t{1} << 20);
  stream.next_in = const_cast<std::uint8_t*>(data);
  stream.avail_in = static_cast<uInt>(size);
  stream.next_out = out.data();
  stream.avail_out = static_cast<uInt>(out.size());
  const int end = inflate(&stream, Z_FINISH);
  out.resize(stream.total_out);
  inflateEnd(&stream);
  if (end != Z_STREAM_END) return std::nullopt;
  return out;
}

Octets deflated(const Octets& data, int window_bits) {
  z_stream stream{};
  deflateInit2(&stream, 1, Z_DEFLATED, window_bits, 8, Z_DEFAULT_STRATEGY);
  Octets out(deflateBound(&stream, static_cast<uLong>(data.size())));
  stream.next_in = const_cast<std::uint8_t*>(data.data());
  stream.avail_in = static_cast<uInt>(data.size());
  stream.next_out = out.data();
  stream.avail_out = static_cast<uInt>(out.size());
  deflate(&stream, Z_FINISH);
  out.resize(stream.total_out);
  deflateEnd(&stream);
  return out;
}

/// Sets the length field of an .npy header to the position of its line end.
void repair_npy(std::uint8_t* data, std::size_t size) {
  if (size < 12 || std::memcmp(data, "\x93NUMPY", 6) != 0) return;
  const std::size_t begin = data[6] >= 2 ? 12 : 10;
  const auto* const end =
      static_cast<const std::uint8_t*>(std::memchr(data + begin, '\n', size - begin));
  if (end == nullptr) return;
  const auto length = static_cast<std::uint32_t>(end + 1 - (data + begin));
  for (std::size_t i = 8; i < begin; ++i)
    data[i] = static_cast<std::uint8_t>(length >> 8 * (i - 8));
}

/// Calls `work(name, data, size)` for every complete chunk.
template <typename Work>
void for_chunks(std::uint8_t* data, std::size_t size, const Work& work) {
  for (std::size_t at = 8; at + 12 <= size;) {
    const std::size_t length = big_endian(data + at);
    if (length > size - at - 12) return;
    work(data + at + 4, data + at + 8, length);
    at += 12 + length;
  }
}

void repair_png(std::uint8_t* data, std::size_t size) {
  for_chunks(data, size, [](std::uint8_t* name, std::uint8_t* content, std::size_t length) {
    put_big_endian(content + length, checksum(name, length + 4));
  });
}

/// Mutates the rows of a PNG in place if it has one IDAT chunk whose new content fits.
bool mutate_png_rows(std::uint8_t* data, std::size_t size, const Mutate& mutate) {
  bool done = false;
  for_chunks(data, size, [&](std::uint8_t* name, std::uint8_t* content, std::size_t length) {
    if (done || std::memcmp(name, "IDAT", 4) != 0) return;
    auto rows = inflated(content, length, 15);
    if (!rows || rows->empty()) return;
    rows->resize(mutate(rows->data(), rows->size(), rows->size()));
    const Octets packed = deflated(*rows, 15);
    if (packed.size() > length) return;
    std::copy(packed.begin(), packed.end(), content);  // rest is ignored
    done = true;
  });
  return done;
}

struct Entry {
  Octets name, content;
  bool deflated = false;
};

/// Returns the entries of an archive, read from their local headers; none if it is broken.
std::vector<Entry> entries_of(const std::uint8_t* data, std::size_t size) {
  std::vector<Entry> entries;
  std::size_t at = 0;
  while (at + 30 <= size && std::memcmp(data + at, "PK\3\4", 4) == 0) {
    const std::size_t packed = little_endian(data + at + 18, 4),
                      name = little_endian(data + at + 26, 2),
                      extra = little_endian(data + at + 28, 2), begin = at + 30 + name + extra;
    if (begin > size || packed > size - begin) return {};
    Entry entry{{data + at + 30, data + at + 30 + name}, {data + begin, data + begin + packed}};
    entry.deflated = little_endian(data + at + 8, 2) == 8;
    if (entry.deflated) {
      auto content = inflated(data + begin, packed, -15);
      if (!content) return {};
      entry.content = std::move(*content);
    }
    entries.push_back(std::move(entry));
    at = begin + packed;
  }
  return entries;
}

Octets archive_of(const std::vector<Entry>& entries) {
  Octets archive, directory;
  for (const Entry& entry : entries) {
    const Octets packed = entry.deflated ? deflated(entry.content, -15) : entry.content;
    const auto offset = static_cast<std::uint32_t>(archive.size());
    Octets header;
    append_little_endian(header, 20, 2);
    append_little_endian(header, 0, 2);
    append_little_endian(header, entry.deflated ? 8 : 0, 2);
    append_little_endian(header, 0x00210000, 4);  // 1980-01-01
    append_little_endian(header, checksum(entry.content.data(), entry.content.size()), 4);
    append_little_endian(header, static_cast<std::uint32_t>(packed.size()), 4);
    append_little_endian(header, static_cast<std::uint32_t>(entry.content.size()), 4);
    append_little_endian(header, static_cast<std::uint32_t>(entry.name.size()), 2);
    append_little_endian(header, 0, 2);
    append_little_endian(archive, 0x04034b50, 4);
    archive.insert(archive.end(), header.begin(), header.end());
    archive.insert(archive.end(), entry.name.begin(), entry.name.end());
    archive.insert(archive.end(), packed.begin(), packed.end());
    append_little_endian(directory, 0x02014b50, 4);
    append_little_endian(directory, 20, 2);
    directory.insert(directory.end(), header.begin(), header.end());
    append_little_endian(directory, 0, 2);  // comment, disk, attributes
    append_little_endian(directory, 0, 4);
    append_little_endian(directory, 0, 4);
    append_little_endian(directory, offset, 4);
    directory.insert(directory.end(), entry.name.begin(), entry.name.end());
  }
  const auto begin = static_cast<std::uint32_t>(archive.size());
  archive.insert(archive.end(), directory.begin(), directory.end());
  append_little_endian(archive, 0x06054b50, 4);
  append_little_endian(archive, 0, 4);
  append_little_endian(archive, static_cast<std::uint32_t>(entries.size()), 2);
  append_little_endian(archive, static_cast<std::uint32_t>(entries.size()), 2);
  append_little_endian(archive, static_cast<std::uint32_t>(directory.size()), 4);
  append_little_endian(archive, begin, 4);
  append_little_endian(archive, 0, 2);
  return archive;
}

/// Mutates the name or content of one entry and packs the archive again; returns 0 on failure.
std::size_t mutate_entry(std::uint8_t* data, std::size_t size, std::size_t max_size, unsigned seed,
                         const Mutate& mutate) {
  std::vector<Entry> entries = entries_of(data, size);
  if (entries.empty()) return 0;
  Entry& entry = entries[seed % entries.size()];
  Octets& part = seed / 16 % 8 == 0 ? entry.name : entry.content;
  const std::size_t before = part.size();
  part.resize(before + 64);
  part.resize(mutate(part.data(), before, part.size()));
  if (&part == &entry.content && seed / 128 % 4 != 0) repair_npy(part.data(), part.size());
  entry.deflated = seed / 512 % 2 == 1;
  const Octets archive = archive_of(entries);
  if (archive.size() > max_size) return 0;
  std::copy(archive.begin(), archive.end(), data);
  return archive.size();
}

}  // namespace

std::size_t mutate_within(Repair repair, std::uint8_t* data, std::size_t size, std::size_t max_size,
                          unsigned seed, const Mutate& mutate) {
  const bool as_it_is = seed % 4 == 0;  // also test broken checksums and lengths
  seed /= 4;
  // Inputs with a choice have up to three leading choice bytes.
  std::size_t ahead = 0;
  const auto starts = [&](std::string_view magic) {
    while (ahead < 3 && ahead + magic.size() <= size) {
      if (std::memcmp(data + ahead, magic.data(), magic.size()) == 0) return true;
      ++ahead;
    }
    return false;
  };
  if (!as_it_is && repair == Repair::zip && starts("PK\3\4"))
    if (const std::size_t changed =
            mutate_entry(data + ahead, size - ahead, max_size - ahead, seed, mutate))
      return ahead + changed;
  ahead = 0;
  if (repair == Repair::png && seed % 3 == 0 && starts("\x89PNG") &&
      mutate_png_rows(data + ahead, size - ahead, mutate)) {
    repair_png(data + ahead, size - ahead);
    return size;
  }
  size = mutate(data, size, max_size);
  ahead = 0;
  if (as_it_is) return size;
  if (repair == Repair::png && starts("\x89PNG")) repair_png(data + ahead, size - ahead);
  ahead = 0;
  if (repair != Repair::none && starts("\x93NUMPY")) repair_npy(data + ahead, size - ahead);
  return size;
}

}  // namespace tofsmith::fuzz
