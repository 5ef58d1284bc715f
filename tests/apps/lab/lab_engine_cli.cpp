// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// The engine of the lab as a program, for tests of its page: reads one request from standard input
// and prints lines of JSON, {"progress"} while it computes and then {"answer", "arrays"} or
// {"error"}. Arrays are the hexadecimal digits of their bytes.
#include <fmt/format.h>

#include <cstdio>
#include <iostream>
#include <iterator>
#include <string>

#include "answer.hpp"

int main() {
  using tofsmith::lab::Json;
  const auto print = [](const Json& line) {
    fmt::print("{}\n", line.dump());
    std::fflush(stdout);
    return true;
  };
  const std::string request(std::istreambuf_iterator<char>(std::cin), {});
  const tofsmith::lab::Reply reply =
      tofsmith::lab::answer(request, [&](double fraction, std::string_view step) {
        return print({{"progress", {{"done", fraction}, {"total", 1}, {"text", step}}}});
      });
  Json line = Json::parse(reply.json);
  for (const auto& array : reply.arrays)
    std::visit(
        [&](const auto& values) {
          constexpr const char* types[] = {"Float32Array", "Float64Array", "Int32Array",
                                           "Uint8Array"};
          const auto* bytes = reinterpret_cast<const unsigned char*>(values.data());
          std::string hex;
          for (std::size_t i = 0; i < values.size() * sizeof(values[0]); ++i)
            hex += fmt::format("{:02x}", bytes[i]);
          line["arrays"][array.name] = {{"type", types[array.values.index()]}, {"hex", hex}};
        },
        array.values);
  print(line);
}
