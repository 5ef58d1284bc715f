// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Every reader of files under libFuzzer: input is either read or rejected with an exception.
//   readers --reader=NAME [flags of libFuzzer] CORPUS     --reader=list names them
//   readers --reader=NAME --seeds=DIRECTORY               writes the seeds
// scripts/fuzz.sh builds and runs it.
#include <fmt/format.h>

#include <cstdlib>
#include <stdexcept>

#include "reader.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith::fuzz {
namespace {

std::vector<Reader> all_readers() {
  std::vector<Reader> all;
  for (auto&& some : {text_readers(), document_readers(), array_readers(), image_readers(),
                      mesh_readers(), bench_readers(), sweep_readers()})
    all.insert(all.end(), some.begin(), some.end());
  return all;
}

std::vector<Reader> chosen;
const Reader* current = nullptr;

void write_seeds(const Reader& reader, const std::filesystem::path& directory) {
  std::filesystem::create_directories(directory);
  std::size_t i = 0;
  for (const Bytes& seed : reader.seeds())
    write_bytes(directory / fmt::format("seed-{}", i++), seed);
}

}  // namespace

std::span<const Reader> chosen_readers() { return chosen; }

void choose(const Reader& reader) { current = &reader; }

}  // namespace tofsmith::fuzz

extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv);
extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv) {
  using namespace tofsmith::fuzz;
  static const std::vector<Reader> readers = all_readers();
  for (int i = 1; i < *argc; ++i) {
    const std::string_view word = (*argv)[i];
    if (word == "--reader=list") {
      for (const Reader& reader : readers) fmt::print("{}\n", reader.name);
      std::exit(0);
    }
    if (word.starts_with("--reader="))
      for (const Reader& reader : readers)
        if (word.substr(9) == reader.name || word.substr(9) == "all") chosen.push_back(reader);
    if (word.starts_with("--seeds=") && !chosen.empty()) {
      write_seeds(chosen.front(), word.substr(8));
      std::exit(0);
    }
  }
  if (!chosen.empty()) {
    current = &chosen.front();
    return 0;
  }
  fmt::print(stderr, "expected --reader=NAME with a name from --reader=list, or --reader=all\n");
  std::exit(2);
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    tofsmith::fuzz::current->read(std::as_bytes(std::span(data, size)));
  } catch (const tofsmith::IoError&) {
  } catch (const std::invalid_argument&) {
  }
  return 0;
}

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);
extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t max_size, unsigned seed);
extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t max_size, unsigned seed) {
  return tofsmith::fuzz::mutate_within(tofsmith::fuzz::current->repair, data, size, max_size, seed,
                                       LLVMFuzzerMutate);
}
