// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tofsmith::fuzz {

using Bytes = std::vector<std::byte>;
using Input = std::span<const std::byte>;

/// Format whose lengths and checksums are updated after mutations, so that mutations reach the code
/// that follows the checks.
enum class Repair { none, npy, png, zip };

/// A reader of files with its seeds.
struct Reader {
  std::string name;
  std::function<void(Input)> read;
  /// Computed on demand, because some seeds require a design.
  std::function<std::vector<Bytes>()> seeds;
  Repair repair = Repair::none;
};

inline Bytes bytes_of(std::string_view text) {
  const auto bytes = std::as_bytes(std::span(text));
  return {bytes.begin(), bytes.end()};
}

inline std::string_view text_of(Input bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

inline std::function<std::vector<Bytes>()> seeds(std::vector<Bytes> all) {
  return [all = std::move(all)] { return all; };
}

inline Bytes bytes_of_file(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return bytes_of(std::string(std::istreambuf_iterator<char>(file), {}));
}

inline void write_bytes(const std::filesystem::path& path, Input bytes) {
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()),
             static_cast<std::streamsize>(bytes.size()));
}

/// Returns the path of a scratch file, for readers that open files by name.
inline std::filesystem::path scratch_file(std::string_view name) {
  return std::filesystem::temp_directory_path() / name;
}

/// Removes the first byte and returns it modulo `count`: a choice of the reader's options.
inline std::size_t take_choice(Input& bytes, std::size_t count) {
  if (bytes.empty()) return 0;
  const auto choice = static_cast<std::size_t>(bytes.front()) % count;
  bytes = bytes.subspan(1);
  return choice;
}
inline Bytes with_choice(std::size_t choice, Bytes bytes) {
  bytes.insert(bytes.begin(), static_cast<std::byte>(choice));
  return bytes;
}

/// Removes and returns the input up to a zero byte.
inline Input take_up_to_zero(Input& bytes) {
  const auto text =
      static_cast<std::size_t>(std::find(bytes.begin(), bytes.end(), std::byte{0}) - bytes.begin());
  const Input head = bytes.first(text);
  bytes = bytes.subspan(std::min(bytes.size(), text + 1));
  return head;
}

/// Readers of each folder.
std::vector<Reader> text_readers();
std::vector<Reader> array_readers();
std::vector<Reader> image_readers();
std::vector<Reader> mesh_readers();
std::vector<Reader> document_readers();
std::vector<Reader> bench_readers();
std::vector<Reader> sweep_readers();

/// Returns the readers selected on the command line.
std::span<const Reader> chosen_readers();
/// Selects the reader of the next inputs.
void choose(const Reader& reader);

/// Mutates the first `size` bytes of a buffer of `max` bytes and returns the new size.
using Mutate = std::function<std::size_t(std::uint8_t* data, std::size_t size, std::size_t max)>;
/// Mutates an input, in some cases within its compressed parts, and updates lengths and checksums
/// according to `repair`. A malformed input may stay unrepaired. Returns the new size.
std::size_t mutate_within(Repair repair, std::uint8_t* data, std::size_t size, std::size_t max_size,
                          unsigned seed, const Mutate& mutate);

}  // namespace tofsmith::fuzz
