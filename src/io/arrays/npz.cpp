// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/io/npy.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <zip.h>

#include <algorithm>
#include <array>
#include <exception>
#include <functional>
#include <list>
#include <utility>

#include "io/arrays/npy_header.hpp"
#include "io/shared/byte_order.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

/// Outside the unnamed namespace, because NpzReader::State has a member of this type.
struct DiscardNpzArchive {
  void operator()(zip_t* archive) const { zip_discard(archive); }
};

namespace {

constexpr std::string_view suffix = ".npy";

using Archive = std::unique_ptr<zip_t, DiscardNpzArchive>;

struct FreeSource {
  void operator()(zip_source_t* source) const { zip_source_free(source); }
};
using Source = std::unique_ptr<zip_source_t, FreeSource>;

struct CloseEntry {
  void operator()(zip_file_t* entry) const { zip_fclose(entry); }
};
using Entry = std::unique_ptr<zip_file_t, CloseEntry>;

class ZipError {
 public:
  ZipError() { zip_error_init(&error_); }
  ~ZipError() { zip_error_fini(&error_); }
  ZipError(const ZipError&) = delete;
  ZipError& operator=(const ZipError&) = delete;
  zip_error_t* get() { return &error_; }
  std::string text() { return zip_error_strerror(&error_); }

 private:
  zip_error_t error_;
};

Archive open_archive(Source source, int flags, std::string_view file) {
  ZipError error;
  Archive archive(source ? zip_open_from_source(source.get(), flags, error.get()) : nullptr);
  if (!archive) throw IoError(file, fmt::format("cannot read as an NPZ archive: {}", error.text()));
  (void)source.release();
  return archive;
}

}  // namespace

struct NpzReader::State {
  Archive archive;
  std::string file;
  std::vector<std::string> names;
  std::vector<std::uint64_t> sizes;

  void read_directory();
  std::size_t index_of(std::string_view name) const;
  std::vector<std::byte> unpack(std::size_t index) const;
};

void NpzReader::State::read_directory() {
  std::uint64_t total = 0;
  const zip_int64_t count = zip_get_num_entries(archive.get(), 0);
  if (count < 1) throw IoError(file, "found no entries; expected an archive of arrays");
  for (zip_int64_t i = 0; i < count; ++i) {
    zip_stat_t entry;
    const auto index = static_cast<zip_uint64_t>(i);
    constexpr zip_uint64_t needed = ZIP_STAT_NAME | ZIP_STAT_SIZE;
    if (zip_stat_index(archive.get(), index, 0, &entry) != 0 || (entry.valid & needed) != needed)
      throw IoError(file, fmt::format("entry {}: {}", i, zip_strerror(archive.get())));
    std::string name = entry.name;
    if (name.ends_with(suffix)) name.resize(name.size() - suffix.size());
    if (std::find(names.begin(), names.end(), name) != names.end())
      throw IoError(file, fmt::format("found the entry '{}' twice; expected it once", name));
    if (entry.size > max_npz_bytes - total)
      throw IoError(file, fmt::format("the entries unpack to more than {} bytes; expected less",
                                      max_npz_bytes));
    total += entry.size;
    names.push_back(std::move(name));
    sizes.push_back(entry.size);
  }
}

std::size_t NpzReader::State::index_of(std::string_view name) const {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end())
    throw IoError(file,
                  fmt::format("there is no array '{}'; found {}", name, fmt::join(names, ", ")));
  return static_cast<std::size_t>(found - names.begin());
}

std::vector<std::byte> NpzReader::State::unpack(std::size_t index) const {
  const auto damaged = [&](const std::string& problem) {
    return IoError(file, fmt::format("entry '{}': {}", names[index], problem));
  };
  const Entry entry(zip_fopen_index(archive.get(), index, 0));
  if (!entry) throw damaged(zip_strerror(archive.get()));
  // The buffer grows with the data, not with the size in the directory. Reading past the expected
  // end makes libzip verify the checksum.
  constexpr std::size_t block = std::size_t{1} << 22;
  std::vector<std::byte> content;
  for (;;) {
    const std::size_t done = content.size();
    content.resize(done + std::min<std::uint64_t>(block, sizes[index] - done + 1));
    const zip_int64_t got = zip_fread(entry.get(), content.data() + done, content.size() - done);
    if (got < 0) throw damaged(zip_file_strerror(entry.get()));
    content.resize(done + static_cast<std::size_t>(got));
    if (content.size() > sizes[index] || (got == 0 && content.size() < sizes[index]))
      throw damaged(fmt::format("found {} bytes; expected {}, as in the directory of the archive",
                                content.size(), sizes[index]));
    if (got == 0) return content;
  }
}

NpzReader::NpzReader(const std::filesystem::path& path) : state_(make_hidden<State>()) {
  state_->file = path.string();
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored))
    throw IoError(state_->file, "found a directory; expected a file");
  if (!std::filesystem::exists(path, ignored)) throw IoError(state_->file, "there is no such file");
  Source source(zip_source_file_create(path.c_str(), 0, -1, nullptr));
  state_->archive = open_archive(std::move(source), ZIP_RDONLY, state_->file);
  state_->read_directory();
}

NpzReader::NpzReader(std::span<const std::byte> content, std::string_view file)
    : state_(make_hidden<State>()) {
  state_->file = file;
  Source source(zip_source_buffer_create(content.data(), content.size(), 0, nullptr));
  state_->archive = open_archive(std::move(source), ZIP_RDONLY, state_->file);
  state_->read_directory();
}

const std::vector<std::string>& NpzReader::names() const { return state_->names; }

bool NpzReader::contains(std::string_view name) const {
  return std::find(names().begin(), names().end(), name) != names().end();
}

std::uint64_t NpzReader::unpacked_bytes(std::string_view name) const {
  return state_->sizes[state_->index_of(name)];
}

NpyArray NpzReader::read(std::string_view name, std::uint64_t max_bytes) const {
  if (const std::uint64_t bytes = unpacked_bytes(name); bytes > max_bytes)
    throw IoError(state_->file, fmt::format("entry '{}': found {} bytes once unpacked; expected at "
                                            "most {}",
                                            name, bytes, max_bytes));
  const auto content = state_->unpack(state_->index_of(name));
  return parse_npy(content, fmt::format("{}: entry '{}'", state_->file, name));
}

namespace {

NpzArrays read_all(const NpzReader& reader) {
  NpzArrays arrays;
  for (const std::string& name : reader.names())
    arrays.emplace(name, reader.read(name, max_npz_bytes));
  return arrays;
}

/// NPY files in two pieces each, so that items are not copied.
struct Entries {
  std::list<std::string> headers;
  std::list<std::vector<std::byte>> swapped;  // items on big-endian machines

  std::array<zip_buffer_fragment_t, 2> pieces(const NpyArray& array) {
    std::string& header = headers.emplace_back(serialize_npy_header(array.type(), array.shape()));
    std::span<const std::byte> items = array.bytes();
    if constexpr (!host_is_little_endian) {
      auto& copy = swapped.emplace_back(items.begin(), items.end());
      swap_byte_order(copy, item_size(array.type()));
      items = copy;
    }
    const auto bytes = [](const void* data) {  // libzip does not modify the data
      return const_cast<zip_uint8_t*>(static_cast<const zip_uint8_t*>(data));
    };
    return {{{bytes(header.data()), header.size()}, {bytes(items.data()), items.size()}}};
  }
};

/// Replaces libzip's own temporary file, whose name is generated by OpenSSL, which crashes if
/// memory is exhausted.
class ArchiveTarget {
 public:
  using WriteAt = std::function<void(std::uint64_t offset, std::span<const std::byte>)>;
  explicit ArchiveTarget(WriteAt write_at) : write_at_(std::move(write_at)) {}

  /// The archive owns the source. This object must outlive the archive.
  Source source() {
    return Source(zip_source_function_create(&ArchiveTarget::call, this, nullptr));
  }

  /// Exceptions cannot pass through libzip.
  void rethrow() const {
    if (thrown_) std::rethrow_exception(thrown_);
  }

 private:
  static zip_int64_t call(void* self, void* data, zip_uint64_t size, zip_source_cmd_t command) {
    return static_cast<ArchiveTarget*>(self)->answer(data, size, command);
  }

  zip_int64_t answer(void* data, zip_uint64_t size, zip_source_cmd_t command) {
    switch (command) {
      case ZIP_SOURCE_SUPPORTS:
        return ZIP_SOURCE_SUPPORTS_WRITABLE;
      case ZIP_SOURCE_STAT:
        zip_stat_init(static_cast<zip_stat_t*>(data));
        return sizeof(zip_stat_t);
      case ZIP_SOURCE_WRITE:
        return write({static_cast<const std::byte*>(data), size});
      case ZIP_SOURCE_SEEK_WRITE: {
        const zip_int64_t to = zip_source_seek_compute_offset(offset_, end_, data, size, nullptr);
        if (to >= 0) offset_ = static_cast<std::uint64_t>(to);
        return to < 0 ? -1 : 0;
      }
      case ZIP_SOURCE_TELL_WRITE:
        return static_cast<zip_int64_t>(offset_);
      case ZIP_SOURCE_ERROR:
        return zip_error_to_data(&error_, data, size);
      case ZIP_SOURCE_OPEN:
      case ZIP_SOURCE_CLOSE:
      case ZIP_SOURCE_READ:
      case ZIP_SOURCE_SEEK:
      case ZIP_SOURCE_TELL:
      case ZIP_SOURCE_BEGIN_WRITE:
      case ZIP_SOURCE_COMMIT_WRITE:
      case ZIP_SOURCE_ROLLBACK_WRITE:
      case ZIP_SOURCE_REMOVE:
      case ZIP_SOURCE_FREE:
        return 0;  // the archive is new, so nothing is read
      default:
        return -1;
    }
  }

  zip_int64_t write(std::span<const std::byte> bytes) {
    try {
      write_at_(offset_, bytes);
    } catch (...) {
      thrown_ = std::current_exception();
      zip_error_set(&error_, ZIP_ER_WRITE, 0);
      return -1;
    }
    offset_ += bytes.size();
    end_ = std::max(end_, offset_);
    return static_cast<zip_int64_t>(bytes.size());
  }

  WriteAt write_at_;
  std::uint64_t offset_ = 0, end_ = 0;
  zip_error_t error_{};
  std::exception_ptr thrown_;
};

void pack(const NpzArrays& arrays, NpzCompression compression, ArchiveTarget& target,
          std::string_view file) {
  Archive archive = open_archive(target.source(), ZIP_CREATE | ZIP_TRUNCATE, file);
  const auto check = [&](bool good) {
    target.rethrow();
    if (!good) throw IoError(file, zip_strerror(archive.get()));
  };
  Entries entries;  // read by zip_close
  for (const auto& [name, array] : arrays) {
    const auto pieces = entries.pieces(array);
    zip_source_t* source =
        zip_source_buffer_fragment(archive.get(), pieces.data(), pieces.size(), 0);
    check(source != nullptr);
    const zip_int64_t added =
        zip_file_add(archive.get(), (name + std::string(suffix)).c_str(), source, ZIP_FL_ENC_UTF_8);
    if (added < 0) zip_source_free(source);
    check(added >= 0);
    const auto index = static_cast<zip_uint64_t>(added);
    constexpr zip_uint16_t first_of_january_1980 = (1 << 5) | 1;
    check(zip_file_set_dostime(archive.get(), index, 0, first_of_january_1980, 0) == 0);
    const bool deflate = compression == NpzCompression::deflated;
    check(zip_set_file_compression(archive.get(), index, deflate ? ZIP_CM_DEFLATE : ZIP_CM_STORE,
                                   0) == 0);
  }
  check(zip_close(archive.get()) == 0);
  (void)archive.release();  // freed by zip_close
}

void check_names(const NpzArrays& arrays) {
  require(!arrays.empty(), "arrays", "{}", "must have at least one");
  require(!arrays.contains(""), "array name", "''", "must not be empty");
}

}  // namespace

NpzArrays parse_npz(std::span<const std::byte> content, std::string_view file) {
  return read_all(NpzReader(content, file));
}

NpzArrays read_npz(const std::filesystem::path& path) { return read_all(NpzReader(path)); }

std::vector<std::byte> serialize_npz(const NpzArrays& arrays, NpzCompression compression) {
  check_names(arrays);
  std::vector<std::byte> bytes;
  ArchiveTarget target([&](std::uint64_t offset, std::span<const std::byte> more) {
    bytes.resize(std::max<std::size_t>(bytes.size(), offset + more.size()));
    std::copy(more.begin(), more.end(), bytes.begin() + static_cast<std::ptrdiff_t>(offset));
  });
  pack(arrays, compression, target, "NPZ archive");
  return bytes;
}

void write_npz(const std::filesystem::path& path, const NpzArrays& arrays, OutputPolicy policy,
               NpzCompression compression) {
  AtomicFile file(path, policy);  // first, so that an invalid path fails before packing
  check_names(arrays);
  ArchiveTarget target([&](std::uint64_t offset, std::span<const std::byte> bytes) {
    file.write_at(offset, bytes);
  });
  pack(arrays, compression, target, path.string());
  file.commit();
}

}  // namespace tofsmith
