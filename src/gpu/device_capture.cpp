// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "gpu/device_capture.hpp"

#include <algorithm>
#include <limits>

#include "gpu/device_raw.hpp"
#include "gpu/doubles.hpp"

namespace tofsmith {

namespace {

constexpr std::int64_t min_part_pixels = 1024, max_part_pixels = std::int64_t{1} << 24;

std::uint32_t low_half(std::uint64_t number) { return static_cast<std::uint32_t>(number); }
std::uint32_t high_half(std::uint64_t number) { return static_cast<std::uint32_t>(number >> 32); }

}  // namespace

DeviceCapture::Plan::Plan(const Device& device_, const DeviceOptions& options_)
    : device(with_doubles(device_, "captures")),
      options(options_),
      queue_(device),
      capture_(queue_.kernel(capture_kernels, "-DHAS_DOUBLES", "capture")) {}

DeviceMemory* DeviceCapture::Plan::bring(DeviceMemory& memory, const void* from,
                                         std::size_t bytes) const {
  DeviceMemory* const there = reserve(queue_, memory, static_cast<std::int64_t>(bytes));
  queue_.upload(from, bytes, *there);
  return there;
}

void DeviceCapture::Plan::bring_tables(const PixelCapture& pixel) {
  const auto bring_all = [&](DeviceMemory& memory, const auto& values) {
    bring(memory, values.data(), static_cast<std::size_t>(values.size()) * sizeof(double));
  };
  bring_all(chi_, pixel.correlation().table());
  bring_all(exposure_, pixel.exposure_s());
  bring_all(ambient_gain_, pixel.ambient_gain());
  if (pixel.rows()) bring_all(rows_, *pixel.rows());  // (K, N), column by column
}

void DeviceCapture::Plan::set_parameters(const UnexposedFrames& frames, const PixelCapture& pixel) {
  const NoiseParts& noise = pixel.noise();
  const auto flag = [](bool is_so) { return is_so ? 1 : 0; };
  const CaptureOptions& light = frames.source.options();
  const bool has_ambient =
      frames.light ? !frames.light->ambient.empty() : !frames.source.scene().ambient_scale.empty();
  parameters_ = {.signal_e_per_s = light.signal_e_per_s,
                 .ambient_e_per_s = light.ambient_e_per_s,
                 .reference_distance_m = light.reference_distance_m,
                 .range_m = pixel.range_m(),
                 .bin_m = pixel.bin_m(),
                 .dark_e_per_s = pixel.dark_e_per_s(),
                 .points_per_bin = pixel.correlation().points_per_bin(),
                 .read_noise_e = noise.read_noise_e,
                 .full_well_e = noise.full_well_e,
                 .gain_e_per_dn = noise.gain_e_per_dn,
                 .black_level_dn = noise.black_level_dn,
                 .min_dn = noise.min_dn,
                 .max_dn = noise.max_dn,
                 .margin = margin,
                 .points = pixel.correlation().points(),
                 .taps = pixel.correlation().tap_values(),
                 .measurements = frames.source.measurements(),
                 .is_collected = flag(frames.light != nullptr),
                 .has_ambient = flag(has_ambient),
                 .has_falloff = flag(light.falloff),
                 .is_gaussian = flag(noise.model == NoiseModel::gaussian),
                 .subtracts = flag(noise.subtracts),
                 .is_signed = flag(noise.is_signed),
                 .has_adc = flag(noise.has_adc),
                 .has_rows = flag(pixel.rows().has_value())};
}

void DeviceCapture::Plan::bring_light(const UnexposedFrames& frames, const Part& part) {
  const auto first = static_cast<std::size_t>(part.first),
             count = static_cast<std::size_t>(part.count),
             taps = static_cast<std::size_t>(parameters_.taps);
  parameters_.pixels = static_cast<int>(part.count);
  if (frames.light) {
    bring(collected_, frames.light->taps.data() + first * taps, count * taps * sizeof(double));
    if (parameters_.has_ambient)
      bring(ambient_, frames.light->ambient.data() + first, count * sizeof(double));
    return;
  }
  const SceneImage& scene = frames.source.scene();
  const auto bring_plane = [&](DeviceMemory& memory, const Image<float>& plane) {
    bring(memory, plane.pixels.data() + first, count * sizeof(float));
  };
  bring_plane(depth_, scene.depth_m);
  bring_plane(albedo_, scene.albedo);
  bring_plane(cosine_, scene.cosine);
  if (parameters_.has_ambient) bring_plane(ambient_scale_, scene.ambient_scale);
}

std::int64_t DeviceCapture::Plan::expose_part(const UnexposedFrames& frames, int frame,
                                              const Part& part) {
  const auto measurements = static_cast<std::size_t>(parameters_.measurements);
  const std::uint64_t seed = frames.source.options().seed,
                      number = static_cast<std::uint64_t>(part.first);
  const int of_seed = frames.first_frame + frame;
  const CaptureStream streams{.seed_low = low_half(seed),
                              .seed_high = high_half(seed),
                              .first_low = low_half(number),
                              .first_high = high_half(number),
                              .frame = static_cast<std::uint32_t>(of_seed)};
  const std::size_t values = static_cast<std::size_t>(part.count) * measurements;
  constexpr std::int32_t none = 0;
  bring(opened_, &none, sizeof none);
  reserve(queue_, open_, part.count * std::int64_t{sizeof(std::int32_t)});
  reserve(queue_, raw_, static_cast<std::int64_t>(values * sizeof(float)));
  if (parameters_.has_rows)
    reserve(queue_, sums_, static_cast<std::int64_t>(values * sizeof(double)));
  const auto if_there = [](const DeviceMemory& memory) -> const DeviceMemory* {
    return memory.bytes > 0 ? &memory : nullptr;
  };
  queue_.run(capture_, part.count, parameters_, streams, &chi_, &exposure_, &ambient_gain_,
             if_there(rows_), if_there(depth_), if_there(albedo_), if_there(cosine_),
             if_there(ambient_scale_), if_there(collected_), if_there(ambient_), if_there(sums_),
             &raw_, &opened_, &open_);
  float* const raw =
      frames.raw +
      (static_cast<std::size_t>(frame) * static_cast<std::size_t>(frames.pixels()) + number) *
          measurements;
  queue_.download(raw_, values * sizeof(float), raw);
  std::int32_t count = 0;
  queue_.download(opened_, sizeof count, &count);
  if (count == 0) return 0;
  std::vector<std::int32_t> open(static_cast<std::size_t>(count));
  queue_.download(open_, open.size() * sizeof(std::int32_t), open.data());
  std::vector<std::int64_t> pixels;
  for (const std::int32_t pixel : open) pixels.push_back(part.first + pixel);
  std::vector<float> numbers(pixels.size() * measurements);
  expose_pixels(frames, of_seed, pixels, numbers.data());
  for (std::size_t i = 0; i < open.size(); ++i)
    std::copy_n(numbers.data() + i * measurements, measurements,
                raw + static_cast<std::size_t>(open[i]) * measurements);
  return count;
}

std::int64_t DeviceCapture::Plan::bytes_per_pixel(const UnexposedFrames& frames) const {
  const std::int64_t light = frames.light ? 8 * (parameters_.taps + 1) : 4 * 4,
                     sums = parameters_.has_rows ? 8 * parameters_.measurements : 0;
  return light + sums + 4 * (parameters_.measurements + 1);
}

void DeviceCapture::Plan::release() {
  for (DeviceMemory* memory : {&depth_, &albedo_, &cosine_, &ambient_scale_, &collected_, &ambient_,
                               &sums_, &raw_, &open_})
    *memory = DeviceMemory();
}

std::int64_t DeviceCapture::Plan::expose(const UnexposedFrames& frames, const Progress& progress) {
  const std::int64_t pixels = frames.pixels();
  if (pixels < options.min_pixels) {
    expose_here(frames, progress);
    return pixels * frames.frames;
  }
  const std::lock_guard lock(mutex_);
  const PixelCapture& pixel = frames.source.pixel();
  set_parameters(frames, pixel);
  const auto each = static_cast<double>(bytes_per_pixel(frames));
  const auto most = static_cast<double>(
      std::min(max_part_pixels, std::int64_t{std::numeric_limits<int>::max()} /
                                    std::max(parameters_.measurements, parameters_.taps)));
  auto at_a_time = static_cast<std::int64_t>(
      std::clamp(1e6 * options.memory_mb / each, static_cast<double>(min_part_pixels), most));
  if (part_pixels_ > 0) at_a_time = std::min(at_a_time, part_pixels_);
  std::int64_t by_processor = 0;
  bool has_tables = false;
  for (Part part{0, 0}; part.first < pixels; part.first += part.count) {
    part.count = std::min(pixels - part.first, at_a_time);
    try {
      std::int64_t here = 0;
      if (!has_tables) bring_tables(pixel);
      has_tables = true;
      bring_light(frames, part);
      for (int frame = 0; frame < frames.frames; ++frame) {
        here += expose_part(frames, frame, part);
        report(progress,
               (static_cast<double>(part.first) +
                static_cast<double>(part.count) * (frame + 1) / frames.frames) /
                   static_cast<double>(pixels),
               "capture");
      }
      by_processor += here;
    } catch (const OutOfDeviceMemory&) {
      if (part.count <= min_part_pixels) throw;
      release();
      at_a_time = part_pixels_ = std::max(part.count / 2, min_part_pixels);
      part.count = 0;  // again
    }
  }
  return by_processor;
}

DeviceCapture::DeviceCapture(const Device& device, const DeviceOptions& options) {
  options.validate();
  plan_ = std::make_unique<Plan>(device, options);
}
DeviceCapture::~DeviceCapture() = default;
DeviceCapture::DeviceCapture(DeviceCapture&&) noexcept = default;
DeviceCapture& DeviceCapture::operator=(DeviceCapture&&) noexcept = default;

const Device& DeviceCapture::device() const { return plan_->device; }

ExposeBy DeviceCapture::expose_by() const {
  return [plan = plan_.get()](const UnexposedFrames& frames, const Progress& progress) {
    plan->expose(frames, progress);
  };
}

std::optional<DeviceCapture> device_capture(std::string_view device) {
  if (device == "cpu") return std::nullopt;
  if (device != "auto") return std::optional<DeviceCapture>(std::in_place, Device::named(device));
  const std::optional<Device> gpu = gpu_with_doubles();
  if (!gpu) return std::nullopt;
  const DeviceOptions options{.min_pixels = auto_min_pixels_to_capture};
  return std::optional<DeviceCapture>(std::in_place, *gpu, options);
}

}  // namespace tofsmith
