// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "waveforms/pattern_memory.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <iterator>
#include <sstream>
#include <string>

#include "core/shared/bits.hpp"
#include "core/shared/text_numbers.hpp"
#include "tofsmith/core/error.hpp"
#include "waveforms/generator_formats.hpp"

namespace tofsmith {

namespace {

constexpr int max_bits = 64;

int bits_per_output(std::span<const QuantizedWaveform> waveforms) {
  const auto levels = static_cast<std::uint32_t>(waveforms.front().levels);
  require(std::has_single_bit(levels), "levels", levels, "must be a power of two in a memory");
  for (const QuantizedWaveform& waveform : waveforms) {
    waveform.validate();
    require(waveform.levels == waveforms.front().levels, waveform.name + " levels", waveform.levels,
            "must be equal for all waveforms in a memory");
    require(waveform.points() == waveforms.front().points(), waveform.name + " points",
            waveform.points(), "must be equal for all waveforms in a memory");
  }
  return std::countr_zero(levels);
}

/// Waveform e x taps + t of the sensor belongs to tap t of exposure e.
void put(PatternMemory& memory, const QuantizedWaveform& waveform, int exposure,
         const PatternField& field) {
  const std::size_t first =
      static_cast<std::size_t>(exposure) * static_cast<std::size_t>(memory.points_per_exposure);
  for (std::size_t j = 0; j < waveform.codes.size(); ++j)
    memory.words[first + j] |= static_cast<std::uint64_t>(waveform.codes[j]) << field.first_bit;
}

}  // namespace

void PatternMemory::validate() const {
  require(word_bits >= 1 && word_bits <= max_bits, "word bits", word_bits, "must be in [1, 64]");
  require(!words.empty(), "words", words.size(), "must be at least one");
  for (const PatternField& field : fields)
    require(field.first_bit >= 0 && field.bits >= 1 && field.first_bit + field.bits <= word_bits,
            fmt::format("field {} first bit", field.name), field.first_bit,
            "must lie within the word with all bits of the field");
  for (const std::uint64_t word : words)
    require(word <= mask_of(word_bits), "word", word, "must fit in the word's bits");
}

PatternMemory pattern_memory(std::span<const QuantizedWaveform> waveforms, int exposures,
                             std::string comment) {
  require(exposures >= 1 && waveforms.size() > static_cast<std::size_t>(exposures), "waveforms",
          waveforms.size(),
          "must be one for the light and one or more for the sensor per exposure");
  const int bits = bits_per_output(waveforms);
  const auto light = waveforms.first(static_cast<std::size_t>(exposures));
  const auto sensor = waveforms.subspan(static_cast<std::size_t>(exposures));
  const int taps = static_cast<int>(sensor.size()) / exposures;
  require(static_cast<std::size_t>(taps) * static_cast<std::size_t>(exposures) == sensor.size(),
          "sensor waveforms", sensor.size(), "must be equal for all exposures");
  PatternMemory memory;
  memory.comment = std::move(comment);
  memory.word_bits = (1 + taps) * bits + 1;
  require(memory.word_bits <= max_bits, "word bits", memory.word_bits,
          "must be <= 64 (fewer bits per output make words shorter)");
  memory.points_per_exposure = light.front().points();
  memory.words.resize(static_cast<std::size_t>(exposures) *
                      static_cast<std::size_t>(memory.points_per_exposure));
  memory.fields.push_back({"light", 0, bits});
  for (int t = 0; t < taps; ++t)
    memory.fields.push_back({fmt::format("tap_{}", t + 1), (1 + t) * bits, bits});
  memory.fields.push_back({"trigger", (1 + taps) * bits, 1});
  for (int e = 0; e < exposures; ++e) {
    put(memory, light[static_cast<std::size_t>(e)], e, memory.fields[0]);
    for (int t = 0; t < taps; ++t)
      put(memory,
          sensor[static_cast<std::size_t>(e) * static_cast<std::size_t>(taps) +
                 static_cast<std::size_t>(t)],
          e, memory.fields[1 + static_cast<std::size_t>(t)]);
    QuantizedWaveform trigger = light[static_cast<std::size_t>(e)];
    for (int j = 0; j < trigger.points(); ++j)
      trigger.codes[static_cast<std::size_t>(j)] = trigger.trigger_at(j) ? 1 : 0;
    put(memory, trigger, e, memory.fields.back());
  }
  return memory;
}

namespace {

int hex_digits(const PatternMemory& memory) { return (memory.word_bits + 3) / 4; }

/// Each line begins with `mark`.
std::string heading(const PatternMemory& memory, std::string_view mark) {
  memory.validate();
  std::string text;
  const auto line = [&](std::string_view words) {
    fmt::format_to(std::back_inserter(text), "{} {}\n", mark, words);
  };
  std::istringstream lines(memory.comment);
  for (std::string comment; std::getline(lines, comment);) {
    // Control characters in a name, such as CR in VHDL, must not end the comment.
    std::string words(trimmed(comment));
    std::ranges::replace_if(
        words, [](char c) { return static_cast<unsigned char>(c) < ' '; }, ' ');
    line(words);
  }
  for (const PatternField& field : memory.fields)
    line(field.bits == 1 ? fmt::format("bit {}: {}", field.first_bit, field.name)
                         : fmt::format("bits {}..{}: {}", field.first_bit + field.bits - 1,
                                       field.first_bit, field.name));
  if (memory.points_per_exposure > 0)
    line(fmt::format("word of point j of exposure e (both from 0): e * {} + j",
                     memory.points_per_exposure));
  return text;
}

/// Calls `write(out, word, is_last)`.
template <typename Write>
void each_word(std::string& text, const PatternMemory& memory, Write&& write) {
  auto out = std::back_inserter(text);
  for (std::size_t i = 0; i < memory.words.size(); ++i)
    write(out, memory.words[i], i + 1 == memory.words.size());
}

/// Calls `constant(name, value)`.
template <typename Constant>
void each_constant(const PatternMemory& memory, Constant&& constant) {
  constant("WORD_BITS", memory.word_bits);
  constant("WORDS", static_cast<int>(memory.words.size()));
  constant("POINTS_PER_EXPOSURE", memory.points_per_exposure);
  for (const PatternField& field : memory.fields) {
    constant(upper(field.name) + "_FIRST_BIT", field.first_bit);
    constant(upper(field.name) + "_BITS", field.bits);
  }
}

int c_word_bits(const PatternMemory& memory) {
  return static_cast<int>(std::bit_ceil(static_cast<unsigned>(std::max(8, memory.word_bits))));
}

}  // namespace

std::string xilinx_coe(const PatternMemory& memory) {
  std::string text =
      heading(memory, ";") + "memory_initialization_radix=16;\nmemory_initialization_vector=\n";
  each_word(text, memory, [&](auto out, std::uint64_t word, bool last) {
    fmt::format_to(out, "{:0{}x}{}\n", word, hex_digits(memory), last ? ';' : ',');
  });
  return text;
}

std::string intel_mif(const PatternMemory& memory) {
  std::string text = heading(memory, "--");
  fmt::format_to(std::back_inserter(text),
                 "DEPTH = {};\nWIDTH = {};\nADDRESS_RADIX = UNS;\nDATA_RADIX = HEX;\nCONTENT\n"
                 "BEGIN\n",
                 memory.words.size(), memory.word_bits);
  std::size_t address = 0;
  each_word(text, memory, [&](auto out, std::uint64_t word, bool) {
    fmt::format_to(out, "{} : {:0{}X};\n", address++, word, hex_digits(memory));
  });
  return text + "END;\n";
}

std::string verilog_mem(const PatternMemory& memory) {
  std::string text = heading(memory, "//");
  each_word(text, memory, [&](auto out, std::uint64_t word, bool) {
    fmt::format_to(out, "{:0{}x}\n", word, hex_digits(memory));
  });
  return text;
}

std::string systemverilog_package(const PatternMemory& memory) {
  std::string text = heading(memory, "//");
  auto out = std::back_inserter(text);
  fmt::format_to(out, "package {}_pkg;\n", memory.name);
  each_constant(memory, [&](const std::string& name, int value) {
    fmt::format_to(out, "  localparam int {} = {};\n", name, value);
  });
  fmt::format_to(out, "  localparam logic [{}:0] {} [0:{}] = '{{\n", memory.word_bits - 1,
                 upper(memory.name), memory.words.size() - 1);
  each_word(text, memory, [&](auto to, std::uint64_t word, bool last) {
    fmt::format_to(to, "    {}'h{:0{}x}{}\n", memory.word_bits, word, hex_digits(memory),
                   last ? "" : ",");
  });
  return text + "  };\nendpackage\n";
}

std::string vhdl_package(const PatternMemory& memory) {
  std::string text = heading(memory, "--");
  auto out = std::back_inserter(text);
  fmt::format_to(out, "library ieee;\nuse ieee.std_logic_1164.all;\n\npackage {}_pkg is\n",
                 memory.name);
  each_constant(memory, [&](const std::string& name, int value) {
    fmt::format_to(out, "  constant {} : natural := {};\n", name, value);
  });
  fmt::format_to(out,
                 "  type {0}_t is array (0 to {1}) of std_logic_vector({2} downto 0);\n"
                 "  constant {3} : {0}_t := (\n",
                 memory.name, memory.words.size() - 1, memory.word_bits - 1, upper(memory.name));
  std::size_t address = 0;
  each_word(text, memory, [&](auto to, std::uint64_t word, bool last) {
    fmt::format_to(to, "    {} => \"{:0{}b}\"{}\n", address++, word, memory.word_bits,
                   last ? "" : ",");
  });
  fmt::format_to(out, "  );\nend package {}_pkg;\n", memory.name);
  return text;
}

std::string c_header(const PatternMemory& memory) {
  std::string text = heading(memory, "//");
  auto out = std::back_inserter(text);
  const std::string prefix = upper(memory.name), guard = prefix + "_H";
  fmt::format_to(out, "#ifndef {0}\n#define {0}\n\n#include <stdint.h>\n\n", guard);
  each_constant(memory, [&](const std::string& name, int value) {
    fmt::format_to(out, "#define {}_{} {}\n", prefix, name, value);
  });
  fmt::format_to(out, "\nstatic const uint{}_t {}[{}] = {{\n", c_word_bits(memory), memory.name,
                 memory.words.size());
  each_word(text, memory, [&](auto to, std::uint64_t word, bool last) {
    fmt::format_to(to, "    0x{:0{}x}{}{}\n", word, hex_digits(memory),
                   c_word_bits(memory) == 64 ? "u"
                                               "ll"
                                             : "u",
                   last ? "" : ",");
  });
  return text + "};\n\n#endif\n";
}

}  // namespace tofsmith
