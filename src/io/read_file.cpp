// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "io/shared/read_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <span>

#include "core/shared/text_numbers.hpp"
#include "io/input_file.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/io/atomic_file.hpp"

namespace tofsmith {

namespace {

[[noreturn]] void refuse_size(const std::filesystem::path& path, std::string_view found,
                              std::uint64_t max_bytes) {
  throw IoError(path.string(),
                fmt::format("found {} bytes; expected at most {}", found, max_bytes));
}

template <typename Container>
Container read_whole_file(const std::filesystem::path& path, std::uint64_t max_bytes) {
  InputFile file(path);
  constexpr std::uint64_t endless_bytes = std::uint64_t{1} << 28;  // limit for files without an end
  if (!file.size()) max_bytes = std::min(max_bytes, endless_bytes);
  const std::uint64_t announced = file.size().value_or(0);
  if (announced > max_bytes) refuse_size(path, fmt::format("{}", announced), max_bytes);
  Container content;
  // Files of /proc have size 0, and pipes have none. One byte more than expected detects the end.
  std::size_t expected = static_cast<std::size_t>(announced) + 1;
  for (;;) {
    const std::size_t done = content.size();
    content.resize(done + std::max(expected - std::min(expected, done), std::size_t{4096}));
    const auto free = std::as_writable_bytes(std::span(content)).subspan(done);
    const std::size_t got = file.read(free);
    content.resize(done + got);
    if (content.size() > max_bytes) refuse_size(path, "more", max_bytes);
    if (got < free.size()) return content;
    expected = content.size() + content.size() / 2;
  }
}

/// Surrogates become question marks, because no table or setting needs them.
/// @param low  offset of the low byte in each pair
std::string utf8_of_utf16(std::string_view bytes, std::size_t low) {
  std::string text;
  for (std::size_t i = 0; i + 1 < bytes.size(); i += 2) {
    const auto byte = [&](std::size_t at) { return static_cast<unsigned char>(bytes[i + at]); };
    const unsigned unit = byte(1 - low) * 256u + byte(low);
    const auto add = [&](unsigned value) { text += static_cast<char>(value); };
    if (unit < 0x80) {
      add(unit);
    } else if (unit < 0x800) {
      add(0xC0 | unit >> 6);
      add(0x80 | (unit & 0x3F));
    } else if (unit >= 0xD800 && unit < 0xE000) {
      add('?');
    } else {
      add(0xE0 | unit >> 12);
      add(0x80 | (unit >> 6 & 0x3F));
      add(0x80 | (unit & 0x3F));
    }
  }
  return text;
}

}  // namespace

std::string read_text_file(const std::filesystem::path& path, std::uint64_t max_bytes) {
  std::string text = read_whole_file<std::string>(path, max_bytes);
  if (text.starts_with("\xef\xbb\xbf")) text.erase(0, 3);
  if (text.starts_with("\xff\xfe")) return utf8_of_utf16(std::string_view(text).substr(2), 0);
  if (text.starts_with("\xfe\xff")) return utf8_of_utf16(std::string_view(text).substr(2), 1);
  return text;
}

std::vector<std::byte> read_binary_file(const std::filesystem::path& path,
                                        std::uint64_t max_bytes) {
  return read_whole_file<std::vector<std::byte>>(path, max_bytes);
}

std::string lower_extension(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  for (char& c : extension) c = lower_case(c);
  return extension;
}

std::string known_extension(const std::filesystem::path& path,
                            std::initializer_list<std::string_view> known) {
  std::string extension = lower_extension(path);
  if (std::find(known.begin(), known.end(), extension) != known.end()) return extension;
  throw IoError(
      path.string(),
      fmt::format("found {}; expected one of {}",
                  extension.empty() ? "no extension" : fmt::format("the extension '{}'", extension),
                  fmt::join(known, ", ")));
}

std::string file_name_of(std::string_view name) {
  std::string file;
  for (const char c : name) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                       c == '-' || c == '_' || (c == '.' && !file.empty());
    file += plain ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
  }
  return file;
}

}  // namespace tofsmith
