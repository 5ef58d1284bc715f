// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "waveforms/pattern_memory.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/shared/bits.hpp"
#include "core/shared/random.hpp"
#include "io/shared/read_file.hpp"
#include "waveform_readers.hpp"

namespace tofsmith {
namespace {

using testing::HasSubstr;

struct Language {
  std::string file;
  std::string (*write)(const PatternMemory&);
  PatternSyntax syntax;
  const char* width;  ///< text with the bits of a word, or with the highest bit
};

const Language languages[] = {
    {"pattern.coe", xilinx_coe, {"vector=\n", ""}, ""},
    {"pattern.mif", intel_mif, {"BEGIN\n", " : "}, "WIDTH = {0};"},
    {"pattern.mem", verilog_mem, {"", ""}, ""},
    {"pattern.sv", systemverilog_package, {"'{\n", "'h"}, "logic [{1}:0]"},
    {"pattern.vhd", vhdl_package, {":= (\n", "\"", 2}, "std_logic_vector({1} downto 0)"},
    {"pattern.h", c_header, {"= {\n", "0x"}, "_WORD_BITS {0}\n"},
};

PatternMemory memory_of(int word_bits, std::vector<std::uint64_t> words) {
  PatternMemory memory;
  memory.comment = "two lines\nfor people";
  memory.word_bits = word_bits;
  memory.words = std::move(words);
  return memory;
}

TEST(PatternMemory, MatchesTheGoldenFiles) {
  PatternMemory memory = memory_of(4, {0b1011, 0b1001, 0b0100, 0b1101, 0b1010, 0b0001});
  memory.points_per_exposure = 3;
  memory.fields = {{"light", 0, 1}, {"tap_1", 1, 1}, {"tap_2", 2, 1}, {"trigger", 3, 1}};
  for (const Language& language : languages)
    EXPECT_EQ(language.write(memory),
              read_text_file(TOFSMITH_SOURCE_DIR "/tests/io/golden/" + language.file))
        << language.file;
}

TEST(PatternMemory, NamesCannotEndAComment) {
  PatternMemory memory = memory_of(4, {1, 2, 3});
  memory.comment = "a name\rend package;\x1b";
  for (const Language& language : languages) {
    const std::string text = language.write(memory);
    EXPECT_EQ(text.find_first_of("\r\x1b"), std::string::npos) << language.file;
    EXPECT_NE(text.find("a name end package;"), std::string::npos) << language.file;
  }
}

TEST(PatternMemory, ReadsBackExactlyAtEveryWidth) {
  for (int bits = 1; bits <= 64; ++bits) {
    RandomStream random(17, static_cast<std::uint64_t>(bits));
    std::vector<std::uint64_t> words = {0, ~std::uint64_t{0} >> (64 - bits)};
    for (int i = 0; i < 30; ++i)
      words.push_back((std::uint64_t{random()} << 32 | random()) >> (64 - bits));
    const PatternMemory memory = memory_of(bits, words);
    for (const Language& language : languages) {
      const std::string text = language.write(memory);
      const PatternWords back = parse_pattern(text, language.syntax);
      EXPECT_EQ(back.words, words) << language.file << " " << bits;
      EXPECT_EQ(back.digits, language.syntax.radix == 2 ? bits : (bits + 3) / 4) << language.file;
      EXPECT_THAT(text, HasSubstr(fmt::format(fmt::runtime(language.width), bits, bits - 1)));
    }
    EXPECT_THAT(intel_mif(memory), testing::AllOf(HasSubstr("DEPTH = 32;"), HasSubstr("\n10 : "),
                                                  HasSubstr("\n31 : ")));
    EXPECT_THAT(vhdl_package(memory),
                testing::AllOf(HasSubstr("(0 to 31)"), HasSubstr("    31 => \"")));
  }
}

/// Point by point, one exposure after another.
std::vector<std::int32_t> codes_of(const PatternMemory& memory, const PatternField& field) {
  std::vector<std::int32_t> codes;
  for (const std::uint64_t word : memory.words)
    codes.push_back(static_cast<std::int32_t>(word >> field.first_bit & mask_of(field.bits)));
  return codes;
}

TEST(PatternMemory, ContainsEveryOutputOfEveryExposure) {
  std::vector<QuantizedWaveform> waveforms;
  for (int i = 0; i < 6; ++i) {  // 2 exposures, 2 taps
    RandomStream random(18, static_cast<std::uint64_t>(i));
    QuantizedWaveform w{.name = "w", .levels = 8, .periods = 2, .sample_rate_hz = 1e6};
    for (int j = 0; j < 10; ++j) w.codes.push_back(static_cast<int>(random() % 8));
    waveforms.push_back(w);
  }
  const PatternMemory memory = pattern_memory(waveforms, 2, "");
  EXPECT_EQ(memory.word_bits, 10);
  ASSERT_EQ(memory.words.size(), 20u);
  const auto codes = [&](std::size_t first, std::size_t second) {
    std::vector<std::int32_t> joined = waveforms[first].codes;
    joined.insert(joined.end(), waveforms[second].codes.begin(), waveforms[second].codes.end());
    return joined;
  };
  EXPECT_EQ(codes_of(memory, memory.fields[0]), codes(0, 1));  // light
  EXPECT_EQ(codes_of(memory, memory.fields[1]), codes(2, 4));  // tap 1
  EXPECT_EQ(codes_of(memory, memory.fields[2]), codes(3, 5));  // tap 2
  const std::vector<std::int32_t> period = {1, 1, 1, 0, 0};
  for (std::size_t j = 0; j < 20; ++j)
    EXPECT_EQ(codes_of(memory, memory.fields[3])[j], period[j % 5]) << j;
}

TEST(PatternMemory, RejectsContentThatDoesNotFitIntoWords) {
  QuantizedWaveform w{.name = "w", .levels = 2, .codes = {0, 1}, .sample_rate_hz = 1e6};
  EXPECT_THROW(pattern_memory(std::vector{w}, 1, ""), std::invalid_argument);  // no sensor
  EXPECT_THROW(pattern_memory(std::vector{w, w, w, w, w}, 2, ""), std::invalid_argument);
  QuantizedWaveform other = w;
  other.codes = {0, 1, 1};
  EXPECT_THROW(pattern_memory(std::vector{w, other}, 1, ""), std::invalid_argument);
  other = w;
  other.levels = 4;
  EXPECT_THROW(pattern_memory(std::vector{w, other}, 1, ""), std::invalid_argument);
  other.levels = 3;
  EXPECT_THROW(pattern_memory(std::vector{other, other}, 1, ""), std::invalid_argument);
  other.levels = 1 << 16;
  EXPECT_THROW(pattern_memory(std::vector{other, other, other, other}, 1, ""),
               std::invalid_argument);
}

}  // namespace
}  // namespace tofsmith
