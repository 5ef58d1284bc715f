// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Pixels per second decoded by an OpenCL device, from device and from host memory, compared with
// copies of the same bytes, and the number of differences from Decoder. Frames and recordings
// filtered per second on device and CPU, and the size above which the device is faster.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstring>
#include <functional>
#include <optional>

#include "decode_setup.hpp"
#include "gpu/device_decoder.hpp"
#include "gpu/device_filter.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {
namespace {

/// Shortest of several runs [s].
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
        queue.copy(from, 0, to, 0, bytes);
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

void tell_differences(const Planes& a, const Planes& b) {
  std::int64_t floats = 0;
  for_each_plane(
      [&]<typename Value>(const Image<Value>& one, const Image<Value>& other) {
        if constexpr (std::is_same_v<Value, float>) floats += differences(one.pixels, other.pixels);
      },
      a.image, b.image);
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
  // The values do not affect the speed.
  const std::vector<float> some = noisy_pixels(setup.decoder.table(), 1e5, 1e4, 1 << 19, 1);
  std::vector<float> raw;
  while (raw.size() < static_cast<std::size_t>(pixels) * static_cast<std::size_t>(measurements))
    raw.insert(raw.end(), some.begin(), some.end());
  const RawView view = RawView::interleaved(raw.data(), 1, pixels, measurements);
  Planes planes(pixels);
  DeviceTile tile(device, setup.decoder, true);
  tile.bring({.raw = view}, 0, pixels);
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

/// A slanted wall behind a box.
std::vector<float> frame_of_a_box(const DecodingTable& table, int height, int width) {
  RandomStream random(7, 0);
  std::vector<float> raw;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const bool is_box =
          std::abs(3 * y - height) < height / 2 && std::abs(2 * x - width) < width / 2;
      const double bin = table.samples() * (is_box ? 0.2 : 0.4 + 0.2 * x / width);
      append_noisy_pixel(table, is_box ? 5e4 : 1e4, 1e4, bin, random, raw);
    }
  return raw;
}

void report_filters(const Device& device, int runs) {
  constexpr int height = 480, width = 640;
  const DecodeSetup setup("hamiltonian-k4", camera_with("paper-10f0"));
  const DecodingTable& table = setup.decoder.table();
  const std::vector<float> raw = frame_of_a_box(table, height, width);
  const RawView view = RawView::interleaved(raw.data(), height, width, 4);
  const DeviceDecoder on_device(device, setup.decoder);
  for (const FilterStrength strength : all_values<FilterStrength>) {
    const Filter filter(table, FilterOptions::of(strength));
    const DeviceFilter filter_on_device(device, filter);
    FilteredFrame here, there;
    Planes planes_here(height * width), planes_there(height * width);
    const DecodedView wanted = planes_there.all();
    const double with_decoder =
        seconds_of([&] { filter_on_device.decode(view, on_device, wanted); }, runs);
    const double back = seconds_of([&] { filter_on_device.apply(view, there); }, runs);
    const double by_filter = seconds_of([&] { filter.apply(view, here); }, runs);
    const double by_both = seconds_of(
        [&] {
          filter.apply(view, here);
          setup.decoder.decode(here.view(), planes_here.all());
        },
        runs);
    fmt::print(
        "filter {:<9} VGA, K = 4: {:8.1f} frames/s with copies{}; filtered and decoded there "
        "{:8.1f}; here {:8.1f} and {:8.1f}; {} numbers differ\n",
        name_of(strength), 1.0 / back, strength == FilterStrength::normal ? " (asked: 1000)" : "",
        1.0 / with_decoder, 1.0 / by_filter, 1.0 / by_both,
        differences(there.values().values, here.values().values) +
            differences(there.averaged().pixels, here.averaged().pixels));
    tell_differences(planes_there, planes_here);
  }
}

/// Frames per second on the device and on the CPU.
void report_recordings(const std::string& device, int runs) {
  constexpr int height = 480, width = 640, frames = 8;
  const DecodeSetup setup("hamiltonian-k4", camera_with("paper-10f0"));
  const DecodingTable& table = setup.decoder.table();
  const std::vector<float> raw = frame_of_a_box(table, height, width);
  const RawView view = RawView::interleaved(raw.data(), height, width, 4);
  const Filter light(table, FilterOptions::of(FilterStrength::light)), normal(table);
  const auto rate = [&](const std::string& name, const FrameSteps& steps) {
    const auto backend = frame_backend(name, make_decoder(DecodeMethod::zncc, table));
    const auto pipeline = backend->prepare(steps, height, width);
    Planes planes(height * width);
    const DecodedView wanted = planes.all();
    const double seconds = seconds_of(
        [&] {
          for (int f = 0; f < frames; ++f)
            if (pipeline->submit(view, (f + 1) % steps.average == 0)) pipeline->decode(wanted);
        },
        runs);
    return frames / seconds;
  };
  const auto tell = [&](std::string_view what, const FrameSteps& steps) {
    const double there = rate(device, steps), here = rate("cpu", steps);
    fmt::print("recordings, {:<30} VGA, K = 4: {:8.1f} frames/s; here {:8.1f}; {:.2f} times\n",
               what, there, here, there / here);
  };
  tell("decoded only:", {});
  tell("means of 4:", {.average = 4});
  tell("time filter:", {.time_filter = TimeFilterOptions{}});
  tell("time filter, filter light:",
       {.time_filter = TimeFilterOptions{.before_filter = true}, .filter = &light});
  tell("time filter, filter normal:",
       {.time_filter = TimeFilterOptions{.before_filter = true}, .filter = &normal});
}

/// Smallest size from which `there` is faster than `here`, as text.
std::string crossover(const std::function<double(int)>& there,
                      const std::function<double(int)>& here) {
  std::optional<int> from;
  for (int side = 1024; side >= 32; side /= 2) {
    if (there(side) >= here(side)) break;
    from = side;
  }
  return from ? fmt::format("{} pixels", *from * *from) : "none up to 1048576 pixels";
}

/// Size from which the device is faster, including copies (see auto_min_pixels_to_filter).
void report_crossovers(const Device& device, int runs) {
  const DecodeSetup setup("hamiltonian-k4", camera_with("paper-10f0"));
  const DecodingTable& table = setup.decoder.table();
  const std::vector<float> raw = frame_of_a_box(table, 1024, 1024);
  const auto view = [&](int side) { return RawView::interleaved(raw.data(), side, side, 4); };
  Planes planes(1024 * 1024);
  const DecodedView wanted = planes.all();
  const Filter filter(table);
  const DeviceDecoder on_device(device, setup.decoder);
  const DeviceFilter filter_on_device(device, filter);
  FilteredFrame filtered;
  const std::string to_decode = crossover(
      [&](int side) { return seconds_of([&] { on_device.decode(view(side), wanted); }, runs); },
      [&](int side) {
        return seconds_of([&] { setup.decoder.decode(view(side), wanted); }, runs);
      });
  const std::string to_filter = crossover(
      [&](int side) {
        return seconds_of([&] { filter_on_device.decode(view(side), on_device, wanted); }, runs);
      },
      [&](int side) {
        return seconds_of(
            [&] {
              filter.apply(view(side), filtered);
              setup.decoder.decode(filtered.view(), wanted);
            },
            runs);
      });
  fmt::print(
      "faster than here, copies included, from: all outputs {} (auto: never), filter normal and "
      "all "
      "outputs {} (auto: {})\n",
      to_decode, to_filter, auto_min_pixels_to_filter);
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
  report_filters(device, runs);
  report_recordings(name, runs);
  report_crossovers(device, runs);
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
