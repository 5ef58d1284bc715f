// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Pixels that a device of OpenCL decodes per second, from its memory and from this computer's,
// beside copies of the same bytes in the same run; and how many of them differ from the Decoder's.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstring>
#include <functional>

#include "decode_setup.hpp"
#include "gpu/device_tile.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {
namespace {

/// The best of some runs [s].
double seconds_of(const std::function<void()>& work, int runs) {
  work();
  double best = 1e30;
  for (int i = 0; i < runs; ++i) {
    const auto start = std::chrono::steady_clock::now();
    work();
    const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - start;
    best = std::min(best, passed.count());
  }
  return best;
}

/// Bytes read and written per second by copies within the device.
double copy_rate(const Device& device, std::size_t bytes, int runs) {
  const DeviceQueue queue(device);
  const DeviceMemory from = queue.allocate(bytes), to = queue.allocate(bytes);
  const double seconds = seconds_of(
      [&] {
        queue.copy(from, to, bytes);
        queue.finish();
      },
      runs);
  return 2.0 * static_cast<double>(bytes) / seconds;
}

struct Planes {
  explicit Planes(int pixels) : image(1, pixels), bin(static_cast<std::size_t>(pixels)) {}
  DecodedView all() {
    DecodedView view = DecodedView::of(image);
    view.bin = bin.data();
    return view;
  }
  DepthImage image;
  std::vector<std::int32_t> bin;
};

template <typename Value>
std::int64_t differences(const std::vector<Value>& a, const std::vector<Value>& b) {
  std::int64_t count = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    count += std::memcmp(&a[i], &b[i], sizeof(Value)) != 0 ? 1 : 0;
  return count;
}

/// Tells how many bins, statuses and bits of other planes differ.
void tell_differences(const Planes& a, const Planes& b) {
  std::int64_t floats = 0;
  for (const auto plane :
       {&DepthImage::depth_m, &DepthImage::signal_e_per_s, &DepthImage::ambient_e_per_s,
        &DepthImage::confidence, &DepthImage::predicted_standard_deviation_m})
    floats += differences((a.image.*plane).pixels, (b.image.*plane).pixels);
  fmt::print(
      "{:<16} of {} pixels {} bins, {} statuses and {} floats differ (asked: 0, 0, none by "
      "2e-6)\n",
      "", a.bin.size(), differences(a.bin, b.bin),
      differences(a.image.status.pixels, b.image.status.pixels), floats);
}

void report(const Device& device, const char* code, int pixels, double copy_bytes_per_s, int runs) {
  Camera camera = camera_with("paper-10f0");
  camera.samples = 960;
  const DecodeSetup setup(code, camera);
  const int measurements = setup.decoder.measurements();
  // Some noise, repeated: what is decoded beside it does not matter.
  const std::vector<float> some = noisy_pixels(setup.decoder.table(), 1e5, 1e4, 1 << 19, 1);
  std::vector<float> raw;
  while (raw.size() < static_cast<std::size_t>(pixels) * static_cast<std::size_t>(measurements))
    raw.insert(raw.end(), some.begin(), some.end());
  const RawView view = RawView::interleaved(raw.data(), 1, pixels, measurements);
  Planes planes(pixels);
  DeviceTile tile(device, setup.decoder, true);
  tile.upload(view, 0, pixels);
  const DeviceDecoder on_device(device, setup.decoder);
  const auto tell = [&](const char* what, const DecodedView& wanted, double bytes_out,
                        double asked) {
    const double on_it = seconds_of(
        [&] {
          tile.decode(wanted);
          tile.queue().finish();
        },
        runs);
    const double with_copies = seconds_of([&] { on_device.decode(view, wanted); }, runs);
    const double here = seconds_of([&] { setup.decoder.decode(view, wanted); }, runs);
    tile.decode(wanted);
    const double bytes = 4.0 * measurements + bytes_out;
    fmt::print(
        "{:<16} {:<12} {:9.1f} Mpixel/s, {:.3f} of the copy (asked: {:.3f}); with copies "
        "{:8.1f}; Decoder here {:8.1f}; left to it {:.2f} %\n",
        code, what, 1e-6 * pixels / on_it, bytes * pixels / on_it / copy_bytes_per_s, asked,
        1e-6 * pixels / with_copies, 1e-6 * pixels / here,
        100.0 * static_cast<double>(tile.open_pixels().size()) / pixels);
  };
  tell("bins", {.bin = planes.bin.data()}, 4.0, 0.25);
  tell("all outputs", planes.all(), 25.0, 1.0 / 6.0);
  Planes on_it(pixels);
  on_device.decode(view, on_it.all());
  setup.decoder.decode(view, planes.all());
  tell_differences(on_it, planes);
}

int run(int argc, char** argv) {
  CLI::App app("decoding on a device of OpenCL beside copies in its memory");
  std::string name = "0";
  int megapixels = 8, runs = 10;
  bool quick = false;
  app.add_option("--device", name, "as of tofsmith decode");
  app.add_option("--megapixels", megapixels)->check(CLI::Range(1, 16))->capture_default_str();
  app.add_flag("--quick", quick, "one megapixel, twice");
  CLI11_PARSE(app, argc, argv);
  if (quick) megapixels = 1;
  if (quick) runs = 2;
  const Device device = Device::named(name);
  const int pixels = megapixels * 1000 * 1000;
  const double rate = copy_rate(device, 16 * static_cast<std::size_t>(pixels), runs);
  const DeviceInfo& info = device.info();
  fmt::print("{} ({}), {}: copies {:.1f} GB/s, read and written\n", info.name, name_of(info.kind),
             info.version, 1e-9 * rate);
  if (info.kind != DeviceKind::gpu) fmt::print("no GPU: shares say nothing of one\n");
  for (const char* code : {"hamiltonian-k3", "hamiltonian-k4", "hamiltonian-k5"})
    report(device, code, pixels, rate, runs);
  return 0;
}

}  // namespace
}  // namespace tofsmith

int main(int argc, char** argv) {
  try {
    return tofsmith::run(argc, argv);
  } catch (const tofsmith::IoError& error) {  // no device
    fmt::print(stderr, "benchmark_device: {}\n", error.what());
    return 1;
  }
}
