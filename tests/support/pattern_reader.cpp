// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "pattern_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "core/shared/bits.hpp"
#include "core/shared/text_numbers.hpp"
#include "io/text/shared/line_cursor.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

namespace {

constexpr std::size_t max_words = std::size_t{1} << 26;

std::string lower(std::string_view text) {
  std::string result(text);
  for (char& c : result) c = lower_case(c);
  return result;
}

/// Removes all text between `begin` and `end`, including both, but keeps line ends.
std::string without(std::string_view text, std::string_view begin, std::string_view end) {
  std::string result;
  while (true) {
    const std::size_t from = text.find(begin);
    result += text.substr(0, from);
    if (from == std::string_view::npos) return result;
    const std::size_t to = text.find(end, from + begin.size());
    if (to == std::string_view::npos) return result;
    text.remove_prefix(end == "\n" ? to : to + end.size());
  }
}

class Reader {
 public:
  explicit Reader(std::string_view file) : file_(file) {}

  [[noreturn]] void fail(std::string_view problem) const { throw IoError(file_, problem); }

  std::uint64_t number(std::string_view text, int radix) const {
    text = trimmed(text);
    std::uint64_t value = 0;
    const char* const end = text.data() + text.size();
    const auto [stopped, error] =
        std::from_chars(text.data(), text.data() + text.size(), value, radix);
    if (error != std::errc() || stopped != end)
      fail(fmt::format("found '{}'; expected a number of base {} and at most 64 bits",
                       text.substr(0, 60), radix));
    return value;
  }

  std::string_view between(std::string_view text, std::string_view key,
                           std::string_view end) const {
    const std::size_t at = text.find(key);
    if (at == std::string_view::npos) fail(fmt::format("found no '{}'", key));
    const std::size_t begin = at + key.size(), stop = text.find(end, begin);
    if (stop == std::string_view::npos) fail(fmt::format("found no '{}' behind '{}'", end, key));
    return text.substr(begin, stop - begin);
  }

  template <typename Parse>
  std::vector<std::uint64_t> words(std::string_view list, Parse&& parse) const {
    std::vector<std::uint64_t> result;
    constexpr std::string_view separators = ", \t\r\n";
    for (std::size_t at = list.find_first_not_of(separators); at != std::string_view::npos;) {
      const std::size_t end = std::min(list.find_first_of(separators, at), list.size());
      result.push_back(parse(list.substr(at, end - at)));
      at = list.find_first_not_of(separators, end);
    }
    if (result.empty()) fail("found no word; expected one or more");
    return result;
  }

 private:
  std::string file_;
};

/// Removes the text after the first semicolon of each line.
std::string without_coe_comments(std::string_view text) {
  std::string result;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::string_view line = text.substr(begin, end - begin);
    const std::size_t semicolon = line.find(';');
    result += semicolon == std::string_view::npos ? line : line.substr(0, semicolon + 1);
    result += '\n';
    begin = end + 1;
  }
  return result;
}

PatternWords parse_coe(std::string_view text, const Reader& reader) {
  const std::string clean = lower(without_coe_comments(text));
  const std::size_t radix_at = clean.find("memory_initialization_radix");
  const std::size_t data_at = clean.find("memory_initialization_vector");
  if (radix_at == std::string::npos || data_at == std::string::npos)
    reader.fail("found no memory_initialization_radix and _vector; expected a .coe file");
  const auto radix =
      reader.number(reader.between(std::string_view(clean).substr(radix_at), "=", ";"), 10);
  if (radix != 2 && radix != 10 && radix != 16)
    reader.fail(fmt::format("found the radix {}; expected 2, 10 or 16", radix));
  const auto data = reader.between(std::string_view(clean).substr(data_at), "=", ";");
  return {0, reader.words(data, [&](std::string_view word) {
            return reader.number(word, static_cast<int>(radix));
          })};
}

int mif_radix(std::string_view word, const Reader& reader) {
  word = trimmed(word);
  if (word == "hex") return 16;
  if (word == "bin") return 2;
  if (word == "oct") return 8;
  if (word == "uns" || word == "dec") return 10;
  reader.fail(fmt::format("found the radix '{}'; expected BIN, HEX, OCT, UNS or DEC", word));
}

/// Parses "address : word;", "[first..last] : word;" and several words from one address.
class MifContent {
 public:
  MifContent(const Reader& reader, std::size_t depth, int address_radix, int data_radix)
      : reader_(reader),
        address_radix_(address_radix),
        data_radix_(data_radix),
        words_(depth),
        given_(depth) {}

  void add(std::string_view entry) {
    const std::size_t colon = entry.find(':');
    if (colon == std::string_view::npos)
      reader_.fail(fmt::format("found '{}'; expected 'address : word;'", trimmed(entry)));
    std::string_view where = trimmed(entry.substr(0, colon));
    const auto data = reader_.words(entry.substr(colon + 1), [&](std::string_view word) {
      return reader_.number(word, data_radix_);
    });
    if (!where.starts_with('[')) {
      const std::uint64_t first = reader_.number(where, address_radix_);
      for (std::size_t i = 0; i < data.size(); ++i) put(first + i, data[i]);
      return;
    }
    const std::string_view first = reader_.between(where, "[", ".."),
                           last = reader_.between(where, "..", "]");
    const std::uint64_t begin = reader_.number(first, address_radix_);
    const std::uint64_t end =
        std::min<std::uint64_t>(reader_.number(last, address_radix_), words_.size());
    for (std::uint64_t a = begin; a <= end; ++a) put(a, data[(a - begin) % data.size()]);
  }

  std::vector<std::uint64_t> take() && {
    const auto missing = std::find(given_.begin(), given_.end(), false);
    if (missing != given_.end())
      reader_.fail(fmt::format("found no word at the address {}; expected {} words, as DEPTH says",
                               missing - given_.begin(), words_.size()));
    return std::move(words_);
  }

 private:
  void put(std::uint64_t address, std::uint64_t word) {
    if (address >= words_.size())
      reader_.fail(fmt::format("found the address {}; expected addresses below {}, as DEPTH says",
                               address, words_.size()));
    words_[address] = word;
    given_[address] = true;
  }

  const Reader& reader_;
  int address_radix_, data_radix_;
  std::vector<std::uint64_t> words_;
  std::vector<bool> given_;
};

PatternWords parse_mif(std::string_view text, const Reader& reader) {
  const std::string clean = lower(without(without(text, "%", "%"), "--", "\n"));
  const std::size_t content_at = clean.find("content");
  if (content_at == std::string::npos) reader.fail("found no CONTENT; expected a .mif file");
  const std::string_view head = std::string_view(clean).substr(0, content_at);
  const auto setting = [&](std::string_view key) {
    const std::size_t at = head.find(key);
    if (at == std::string_view::npos) reader.fail(fmt::format("found no '{}'", key));
    return reader.between(head.substr(at), "=", ";");
  };
  const std::uint64_t depth = reader.number(setting("depth"), 10),
                      width = reader.number(setting("width"), 10);
  if (depth < 1 || depth > max_words || width < 1 || width > 64)
    reader.fail(fmt::format("found DEPTH {} and WIDTH {}; expected 1 .. {} words of 1 .. 64 bits",
                            depth, width, max_words));
  MifContent content(reader, depth, mif_radix(setting("address_radix"), reader),
                     mif_radix(setting("data_radix"), reader));
  std::string_view rest =
      reader.between(std::string_view(clean).substr(content_at), "begin", "end");
  while (!trimmed(rest).empty()) {
    const std::size_t end = rest.find(';');
    if (end == std::string_view::npos)
      reader.fail(fmt::format("found '{}' without ';'", trimmed(rest).substr(0, 60)));
    content.add(rest.substr(0, end));
    rest.remove_prefix(end + 1);
  }
  return {static_cast<int>(width), std::move(content).take()};
}

PatternWords parse_mem(std::string_view text, const Reader& reader) {
  const std::string clean = without(without(text, "/*", "*/"), "//", "\n");
  if (clean.find('@') != std::string::npos)
    reader.fail("found an address ('@'); expected words in order from address 0");
  return {0, reader.words(clean, [&](std::string_view word) {
            std::string digits(word);
            std::erase(digits, '_');
            return reader.number(digits, 16);
          })};
}

int checked_width(std::uint64_t bits, const Reader& reader) {
  if (bits < 1 || bits > 64)
    reader.fail(fmt::format("found words of {} bits; expected 1 .. 64", bits));
  return static_cast<int>(bits);
}

PatternWords parse_systemverilog(std::string_view text, const Reader& reader) {
  const std::string clean = without(text, "//", "\n");
  const int width = checked_width(
      reader.number(reader.between(clean, "localparam logic [", ":0]"), 10) + 1, reader);
  return {width, reader.words(reader.between(clean, "'{", "}"), [&](std::string_view word) {
            const std::size_t base = word.find("'h");
            if (base == std::string_view::npos)
              reader.fail(fmt::format("found '{}'; expected a word such as 4'h5", word));
            return reader.number(word.substr(base + 2), 16);
          })};
}

PatternWords parse_vhdl(std::string_view text, const Reader& reader) {
  const std::string clean = without(text, "--", "\n");
  const int width = checked_width(
      reader.number(reader.between(clean, "std_logic_vector(", "downto"), 10) + 1, reader);
  PatternWords result{width, {}};
  std::string_view rest = clean;
  for (std::size_t at = rest.find("=> \""); at != std::string_view::npos; at = rest.find("=> \"")) {
    rest.remove_prefix(at + 4);
    const std::string_view bits = rest.substr(0, rest.find('"'));
    if (bits.size() != static_cast<std::size_t>(width))
      reader.fail(fmt::format("found \"{}\"; expected {} bits", bits.substr(0, 70), width));
    result.words.push_back(reader.number(bits, 2));
  }
  if (result.words.empty()) reader.fail("found no word; expected one or more");
  return result;
}

PatternWords parse_c(std::string_view text, const Reader& reader) {
  const std::string clean = without(text, "//", "\n");
  const std::size_t at = clean.find("_WORD_BITS ");
  if (at == std::string::npos) reader.fail("found no _WORD_BITS; expected a header of tofsmith");
  const int width = checked_width(
      reader.number(reader.between(std::string_view(clean).substr(at), "_WORD_BITS ", "\n"), 10),
      reader);
  return {width, reader.words(reader.between(clean, "{", "}"), [&](std::string_view word) {
            if (!word.starts_with("0x"))
              reader.fail(fmt::format("found '{}'; expected a word such as 0x5u", word));
            return reader.number(word.substr(2, word.find('u') - 2), 16);
          })};
}

}  // namespace

PatternWords parse_pattern(std::string_view text, PatternSyntax syntax, std::string_view file) {
  const Reader reader(file);
  const auto parse = [syntax] {
    switch (syntax) {
      case PatternSyntax::coe:
        return parse_coe;
      case PatternSyntax::mif:
        return parse_mif;
      case PatternSyntax::mem:
        return parse_mem;
      case PatternSyntax::systemverilog:
        return parse_systemverilog;
      case PatternSyntax::vhdl:
        return parse_vhdl;
      case PatternSyntax::c:
        return parse_c;
    }
    return parse_c;
  }();
  PatternWords result = parse(text, reader);
  const std::uint64_t max_word = mask_of(result.word_bits == 0 ? 64 : result.word_bits);
  for (const std::uint64_t word : result.words)
    if (word > max_word)
      reader.fail(
          fmt::format("found the word 0x{:x}; expected at most {} bits", word, result.word_bits));
  return result;
}

}  // namespace tofsmith
