// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <array>

#include "reader.hpp"
#include "tofsmith/calibrate/correlation_calibration.hpp"
#include "tofsmith/calibrate/impulse_response.hpp"
#include "tofsmith/io/npy.hpp"
#include "tofsmith/io/number_table.hpp"

namespace tofsmith::fuzz {

namespace {

namespace fs = std::filesystem;

void read_number_table_text(Input bytes) {
  const auto mark = static_cast<DecimalMark>(take_choice(bytes, 3));
  parse_number_table(text_of(bytes), "a.csv", {.decimal = mark});
}

constexpr std::array record_names = {"r.csv", "r.npy", "r.npz"};

fs::path record_file(Input bytes) {
  const fs::path path = scratch_file(record_names[take_choice(bytes, record_names.size())]);
  write_bytes(path, bytes);
  return path;
}

void read_record(Input bytes) { read_response_record(record_file(bytes), {.time_step_s = 1e-10}); }

void read_sweep_of_delays(Input bytes) {
  read_delay_sweep(record_file(bytes), {.samples = 12}).validate();
}

std::vector<Bytes> record_seeds() {
  std::string text = "time_ns,volts\n", delays = "delay_ns;a;b;c\n";
  for (int i = 0; i < 24; ++i) {
    text += std::to_string(i) + "e-1," + std::to_string(i % 7) + "\n";
    delays +=
        std::to_string(i * 3) + ";" + std::to_string(i % 7) + ",5;2;" + std::to_string(i) + "\n";
  }
  const std::vector<double> values(36, 0.5);
  return {with_choice(0, bytes_of(text)), with_choice(0, bytes_of(delays)),
          with_choice(1, serialize_npy(NpyArray::of<double>({36}, values))),
          with_choice(1, serialize_npy(NpyArray::of<double>({12, 3}, values))),
          with_choice(2, serialize_npz({{"corrfs", NpyArray::of<double>({12, 3}, values)}}))};
}

}  // namespace

std::vector<Reader> bench_readers() {
  return {{"number-table", &read_number_table_text,
           seeds({with_choice(0, bytes_of("Scope\nTime (us);CH1\n0,5;1,25\n1,5;-3\n")),
                  with_choice(0, bytes_of("Sample Interval,1e-9,,0,1,\n,,,1e-9,2,\n,,,2e-9,3,\n")),
                  with_choice(0, bytes_of("\"1,5\",\"2\"\n\"9.91E+37\",3\n")),
                  with_choice(1, bytes_of("# a\nt\tv\n1\t2e-3\n2\t3\n"))})},
          {"response", &read_record, &record_seeds},
          {"delay-sweep", &read_sweep_of_delays, &record_seeds}};
}

}  // namespace tofsmith::fuzz
