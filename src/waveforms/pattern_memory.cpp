// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "waveforms/pattern_memory.hpp"

#include <fmt/format.h>

#include <bit>

#include "core/shared/bits.hpp"
#include "tofsmith/core/error.hpp"

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

std::vector<std::int32_t> codes_of(const PatternMemory& memory, const PatternField& field) {
  std::vector<std::int32_t> codes;
  codes.reserve(memory.words.size());
  for (const std::uint64_t word : memory.words)
    codes.push_back(static_cast<std::int32_t>(word >> field.first_bit & mask_of(field.bits)));
  return codes;
}

}  // namespace tofsmith
