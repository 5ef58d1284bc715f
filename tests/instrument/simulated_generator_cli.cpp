// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// simulated_generator FAMILY MODEL [hangs MESSAGE]: a generator on the loopback. Prints its port,
// and behind every connection its outputs and its channels' points; ends with its standard input.
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "simulated_server.hpp"

int main(int argc, char** argv) {
  using tofsmith::SimulatedGenerator;
  if (argc < 3) return 2;
  const auto family = std::strcmp(argv[1], "siglent") == 0 ? SimulatedGenerator::Family::siglent
                      : std::strcmp(argv[1], "keysight") == 0
                          ? SimulatedGenerator::Family::keysight
                          : SimulatedGenerator::Family::tektronix;
  SimulatedGenerator generator(family, argv[2]);
  if (argc > 4) generator.set_fault(tofsmith::Fault::hangs, std::atoi(argv[4]), 0);
  tofsmith::SimulatedServer* running = nullptr;
  tofsmith::SimulatedServer server(std::move(generator), [&running] {
    running->with_generator([](const SimulatedGenerator& g) {
      std::printf("outputs %d %d points %zu %zu waveforms %d\n", g.channel(1).on ? 1 : 0,
                  g.channel(2).on ? 1 : 0, g.played_codes(1).size(), g.played_codes(2).size(),
                  g.waveforms());
      std::fflush(stdout);
    });
  });
  running = &server;
  std::printf("%d\n", server.port());
  std::fflush(stdout);
  while (std::getchar() != EOF) {
  }
  return 0;
}
