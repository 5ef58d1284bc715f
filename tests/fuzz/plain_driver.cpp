// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Replacement for libFuzzer's main function: reads the seeds of each reader and random mutations of
// them. Unlike libFuzzer it is not guided by coverage, but it only requires GCC.
//   readers --reader=NAME|all [--runs=N]     N changed inputs per reader (1000)
// Sanitizers report an input that fails; the same command reproduces it.
#include <fmt/format.h>

#include <charconv>
#include <cstring>
#include <random>

#include "reader.hpp"

extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv);
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);
extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t max_size, unsigned seed);

namespace tofsmith::fuzz {
namespace {

constexpr std::size_t max_input_bytes = 65536;

std::mt19937& random_numbers() {
  static std::mt19937 engine;
  return engine;
}

std::size_t random_below(std::size_t count) {
  return std::uniform_int_distribution<std::size_t>(0, count - 1)(random_numbers());
}

void read(std::span<const std::uint8_t> input) {
  LLVMFuzzerTestOneInput(input.data(), input.size());
}

/// Reads the seeds of the chosen reader, then `runs` inputs with 1 to 8 mutations.
void run(const Reader& reader, int runs) {
  random_numbers().seed(std::mt19937::default_seed);
  const std::vector<Bytes> seeds = reader.seeds();
  std::vector<std::uint8_t> input(max_input_bytes);
  const auto load = [&](const Bytes& seed) {
    const std::size_t size = std::min(seed.size(), max_input_bytes);
    std::transform(seed.begin(), seed.begin() + static_cast<std::ptrdiff_t>(size), input.begin(),
                   [](std::byte byte) { return std::to_integer<std::uint8_t>(byte); });
    return size;
  };
  for (const Bytes& seed : seeds) read({input.data(), load(seed)});
  for (int i = 0; i < runs && !seeds.empty(); ++i) {
    std::size_t size = load(seeds[random_below(seeds.size())]);
    for (std::size_t change = 0, changes = 1 + random_below(8); change < changes; ++change)
      size = LLVMFuzzerCustomMutator(input.data(), size, max_input_bytes,
                                     static_cast<unsigned>(random_numbers()()));
    // With a vector of the exact size, sanitizers detect reads beyond its end.
    read(std::vector<std::uint8_t>(input.begin(),
                                   input.begin() + static_cast<std::ptrdiff_t>(size)));
  }
}

}  // namespace
}  // namespace tofsmith::fuzz

/// Applies one random mutation: a byte, a bit, a repeated or deleted piece, or a copied piece.
extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size,
                                        std::size_t max_size) {
  using tofsmith::fuzz::random_below;
  constexpr std::uint8_t telling[] = {0x00, 0x01, 0x7f, 0x80, 0xff, '0', '9', '-', '.', 'e', '\n'};
  if (size == 0) {
    if (max_size == 0) return 0;
    data[0] = static_cast<std::uint8_t>(random_below(256));
    return 1;
  }
  const std::size_t at = random_below(size);
  const std::size_t length = 1 + random_below(std::min<std::size_t>(size - at, 16));
  switch (random_below(6)) {
    case 0:
      data[at] = static_cast<std::uint8_t>(random_below(256));
      return size;
    case 1:
      data[at] = static_cast<std::uint8_t>(data[at] ^ (1u << random_below(8)));
      return size;
    case 2:
      data[at] = telling[random_below(std::size(telling))];
      return size;
    case 3:
      std::copy(data + at + length, data + size, data + at);
      return size - length;
    case 4:
      if (size + length > max_size) return size;
      std::copy_backward(data + at, data + size, data + size + length);
      return size + length;
    default:
      std::memmove(data + random_below(size - length + 1), data + at, length);
      return size;
  }
}

int main(int argc, char** argv) {
  using namespace tofsmith::fuzz;
  LLVMFuzzerInitialize(&argc, &argv);
  int runs = 1000;
  for (int i = 1; i < argc; ++i) {
    const std::string_view word = argv[i];
    if (!word.starts_with("--runs=")) continue;
    const auto [end, error] = std::from_chars(word.data() + 7, word.end(), runs);
    if (error != std::errc() || end != word.end() || runs < 0) {
      fmt::print(stderr, "found {}; expected --runs=N with N >= 0\n", word);
      return 2;
    }
  }
  for (const Reader& reader : chosen_readers()) {
    fmt::print("{}\n", reader.name);
    std::fflush(stdout);
    choose(reader);
    run(reader, runs);
  }
}
