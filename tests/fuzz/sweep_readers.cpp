// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "reader.hpp"
#include "sweep/item_key.hpp"
#include "tofsmith/code/families.hpp"
#include "tofsmith/sweep/run_sweep.hpp"

namespace tofsmith::fuzz {

namespace {

namespace fs = std::filesystem;

const std::vector<std::string> keys = {"aa", "bb", "cc"};

/// Returns the path of a store after removing all files of earlier inputs next to it.
fs::path fresh_store() {
  const fs::path path = scratch_file("s.sqlite");
  for (const char* const end : {"", "-wal", "-shm", "-journal"}) fs::remove(path.string() + end);
  return path;
}

void read_store(Input bytes) {
  const fs::path path = fresh_store();
  write_bytes(path, bytes);
  SweepStore store = SweepStore::read(path);
  store.count(keys);
  for (const std::string& key : keys) store.find(key);
}

std::vector<Bytes> store_seeds() {
  const fs::path path = fresh_store();
  {
    SweepStore store = SweepStore::open(path, {.network_file_system = "NFS"});  // without WAL
    store.add(keys, [](std::size_t i) { return "{\"i\":" + std::to_string(i) + "}"; });
    store.claim(keys, 2);
    store.finish(std::vector<ItemOutcome>{{"aa", "{}", "", 1.5}, {"bb", "", "no such code", 0.5}});
  }
  return {bytes_of_file(path)};
}

std::vector<Bytes> item_seeds() {
  Camera camera = built_in_camera("paper-10f0");
  camera.samples = 24;
  const DepthErrorReport report =
      evaluate(build_family("sinusoid-k3", camera), camera, {.trials = 16});
  return {bytes_of(item_result_json(report))};
}

}  // namespace

std::vector<Reader> sweep_readers() {
  return {{"sweep-toml", [](Input bytes) { parse_sweep_toml(text_of(bytes)); },
           seeds({bytes_of("set = [\"samples=24\"]\ncodes = [\"sinusoid-k4\"]\ntrials = 16\n"
                           "combine = \"zip\"\n"
                           "[[axis]]\nkey = \"light.peak_factor\"\nvalues = [12, 15]\n"
                           "[[axis]]\nkey = \"signal_e_per_s\"\nfrom = 1e3\nto = 1e5\ncount = 3\n"
                           "spacing = \"log\"\n")})},
          {"item-json",
           [](Input bytes) { parse_item_result(std::string(text_of(bytes)), "code", "s.sqlite"); },
           &item_seeds},
          {"sqlite", &read_store, &store_seeds}};
}

}  // namespace tofsmith::fuzz
