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

/// What lengths and checksums of a format are put right after bytes have changed, so that changes
/// reach what stands behind them.
enum class Repair { none, npy, png, zip };

/// A reader of files, and what it reads.
struct Reader {
  std::string name;
  std::function<void(Input)> read;
  /// Made when they are asked for: some take a design.
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

/// A file of this name in a directory of the process, for readers of files alone.
inline std::filesystem::path scratch_file(std::string_view name) {
  return std::filesystem::temp_directory_path() / name;
}

/// For inputs whose first byte says how the others are read: which of `count`.
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

/// The input up to a zero byte; the rest stays.
inline Input take_up_to_zero(Input& bytes) {
  const auto text =
      static_cast<std::size_t>(std::find(bytes.begin(), bytes.end(), std::byte{0}) - bytes.begin());
  const Input head = bytes.first(text);
  bytes = bytes.subspan(std::min(bytes.size(), text + 1));
  return head;
}

/// What the floors contribute.
std::vector<Reader> text_readers();
std::vector<Reader> array_readers();
std::vector<Reader> image_readers();
std::vector<Reader> mesh_readers();
std::vector<Reader> document_readers();
std::vector<Reader> bench_readers();
std::vector<Reader> sweep_readers();

/// Readers that the command line names.
std::span<const Reader> chosen_readers();
/// Selects the reader of the next inputs.
void choose(const Reader& reader);

/// Puts right what `repair` says in the first `size` bytes, which have room for `max_size`; gives
/// how many there are then. `data` may stay as it is where its form is broken.
using Mutate = std::function<std::size_t(std::uint8_t* data, std::size_t size, std::size_t max)>;
/// Changes an input by `mutate`, of which some within its compressed parts, and puts it right.
std::size_t mutate_within(Repair repair, std::uint8_t* data, std::size_t size, std::size_t max_size,
                          unsigned seed, const Mutate& mutate);

}  // namespace tofsmith::fuzz
