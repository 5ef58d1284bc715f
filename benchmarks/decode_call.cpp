// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Counterpart of python_decode.py: decodes a frame on one thread for every line of input and prints
// the CPU time [s].
#include <fmt/format.h>

#include <cstdio>
#include <ctime>
#include <iostream>
#include <string>

#include "tofsmith/camera/camera.hpp"
#include "tofsmith/core/parallel.hpp"
#include "tofsmith/decode/decoder.hpp"
#include "tofsmith/io/raw_frames.hpp"

int main(int argc, char** argv) {
  using namespace tofsmith;
  if (argc != 3) {
    fmt::print(stderr, "usage: benchmark_decode_call RAW.npy FAMILY\n");
    return 2;
  }
  const ThreadLimit one_core(1);
  const RawFrames raw = read_raw_frames(argv[1]);
  Camera camera = built_in_camera("paper-10f0");
  camera.samples = 960;
  const CodeSet code = build_family(argv[2], camera);
  const Decoder decoder(make_decoding_table(ForwardModel(code, camera), camera));
  DepthImage image(raw.height, raw.width);
  const RawView view = view_of_frame(raw, 0);
  const DecodedView decoded = DecodedView::of(image);
  decoder.decode(view, decoded);
  for (std::string line; std::getline(std::cin, line);) {
    const std::clock_t start = std::clock();
    decoder.decode(view, decoded);
    fmt::print("{}\n", static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
    std::fflush(stdout);
  }
}
