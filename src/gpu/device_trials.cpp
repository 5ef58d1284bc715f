// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "gpu/device_trials.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "gpu/table_words.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

namespace {

constexpr std::int64_t min_part_trials = 1024, max_part_trials = std::int64_t{1} << 22;

/// The least raw numbers that lie in the plane at q, (K, rank), and what is added to them (K).
std::vector<float> numbers_of_plane(const PlaneMap& map) {
  const Eigen::MatrixXd& w = map.weight;
  const Eigen::MatrixXd back = w.transpose() * (w * w.transpose()).inverse();
  const Eigen::VectorXd added = -back * map.offset;
  std::vector<float> table;
  for (Eigen::Index k = 0; k < back.rows(); ++k)
    for (Eigen::Index j = 0; j < back.cols(); ++j) table.push_back(static_cast<float>(back(k, j)));
  for (const double number : added) table.push_back(static_cast<float>(number));
  return table;
}

std::string options_of_trials(const TrialParts& parts) {
  return fmt::format("-DHAS_DOUBLES -DRANK={} -DMEASUREMENTS={}", parts.plane_map.weight.rows(),
                     parts.plane_map.weight.cols());
}

}  // namespace

TrialDevice::TrialDevice(const Device& device, const DepthTrials& trials,
                         const DeviceOptions& options)
    : trials_(trials),
      parts_(trials),
      decoder_(parts_.believed),
      tile_(device, decoder_, options.use_doubles),
      queue_(device),
      draw_(queue_.kernel(trial_kernels, options_of_trials(parts_), "draw_trials")),
      part_trials_(
          std::clamp(static_cast<std::int64_t>(1e6 * options.memory_mb /
                                               static_cast<double>(tile_.bytes_per_pixel() + 8)),
                     min_part_trials, max_part_trials)) {
  const TrialModel& model = parts_.model;
  const EvaluateOptions& asked = parts_.options;
  std::vector<std::uint32_t> words;
  TableWords tables(words);
  TrialParameters all{
      .rows = static_cast<double>(model.rows()),
      .rows_per_bin = static_cast<double>(model.rows_per_bin()),
      .seed_low = static_cast<std::uint32_t>(asked.seed),
      .seed_high = static_cast<std::uint32_t>(asked.seed >> 32),
      .has_uniform_albedo = parts_.uniform_albedo ? 1 : 0,
      .on_bins = asked.depth == DepthSampling::bins ? 1 : 0,
      .has_own_shot_noise = model.has_own_shot_noise() ? 1 : 0,
      .taps = model.taps(),
      .records = tables.add(std::span(model.records().data(), model.records().size())),
      .record_stride = model.records().stride(),
      .numbers_of_plane = tables.add(numbers_of_plane(parts_.plane_map))};
  for (std::size_t p = 0; p < trials.points().size(); ++p) {
    const OperatingPoint& light = trials.points()[p];
    const PlaneNoise& noise = parts_.plane_noise[p];
    TrialParameters point = all;
    point.signal_e_per_s = light.signal_e_per_s;
    point.signal = static_cast<float>(parts_.albedo * light.signal_e_per_s);
    point.point_low = static_cast<std::uint32_t>(p);
    point.mean_floors = tables.add(noise.mean_floor_e);
    point.shot_floors = tables.add(noise.shot_floor_e2);
    point.weights = tables.add(noise.weight);
    point.products = tables.add(noise.products);
    point.offsets = tables.add(noise.offset);
    point.covariances = tables.add(noise.floor);
    of_point_.push_back(point);
  }
  const std::size_t bytes = words.size() * sizeof(std::uint32_t);
  queue_.upload(words.data(), bytes, *reserve(queue_, words_, static_cast<std::int64_t>(bytes)));
}

void TrialDevice::run_here(const TrialRun& part, std::int64_t trial) {
  const std::int64_t number = part.trials.begin + trial;
  const TrialBlock block = trials_.run(part.round, {number, number + 1}, work_);
  part.true_bin[trial] = block.true_bin.front();
  part.decoded_bin[trial] = block.decoded_bin.front();
  ++by_processor_;
}

void TrialDevice::run_part(const TrialRun& part) {
  const std::int64_t count = part.trials.end - part.trials.begin;
  const auto size = static_cast<std::size_t>(count);
  TrialParameters parameters = of_point_[part.round.point];
  parameters.first = static_cast<double>(part.trials.begin);
  parameters.rows_per_trial = parameters.rows / static_cast<double>(part.round.trials);
  parameters.first_of_stream = static_cast<std::uint32_t>(part.round.first + part.trials.begin);
  parameters.trials = static_cast<int>(count);
  const DeviceRaw& raw = tile_.reserve_planes(count);
  const std::size_t bytes = size * sizeof(double);
  reserve(queue_, true_bins_, static_cast<std::int64_t>(bytes));
  queue_.run(draw_, count, parameters, &words_, &true_bins_, raw.numbers(), raw.averaged());
  queue_.download(true_bins_, bytes, part.true_bin);  // all is drawn then

  depth_m_.resize(size);
  bins_.resize(size);
  DecodedView wanted;
  if (parts_.options.sub_bin)
    wanted.depth_m = depth_m_.data();
  else
    wanted.bin = bins_.data();
  tile_.decode(wanted);
  tile_.fetch(wanted);
  const double bin_m = parts_.believed.bin_m(), samples = trials_.samples();
  for (std::size_t i = 0; i < size; ++i)
    part.decoded_bin[i] =
        parts_.options.sub_bin
            ? std::min(static_cast<double>(depth_m_[i]) / bin_m, std::nextafter(samples, 0.0))
            : static_cast<double>(bins_[i]);
  for (const std::int32_t open : tile_.open_pixels()) part.decoded_bin[open] = -1.0;
  for (std::int64_t i = 0; i < count; ++i)
    if (!(part.decoded_bin[i] >= 0.0)) run_here(part, i);
}

void TrialDevice::run(const TrialRun& run) {
  for (std::int64_t done = 0, all = run.trials.end - run.trials.begin; done < all;) {
    const std::int64_t count = std::min(all - done, part_trials_);
    const std::int64_t begin = run.trials.begin + done;
    try {
      run_part({run.round, {begin, begin + count}, run.true_bin + done, run.decoded_bin + done});
      done += count;
    } catch (const OutOfDeviceMemory&) {
      if (count <= min_part_trials) throw;
      tile_.release();
      true_bins_ = DeviceMemory();
      part_trials_ = std::max(count / 2, min_part_trials);
    }
  }
}

std::optional<BrokenRule> why_not_on_device(const Camera& camera, const EvaluateOptions& options) {
  const Sensor& sensor = camera.sensor;
  if (options.method != DecodeMethod::zncc)
    return broken("method", name_of(options.method),
                  "must be zncc, by which alone devices decode, or the device cpu");
  if (sensor.noise != NoiseModel::gaussian)
    return broken("sensor.noise", "poisson", "must be gaussian for trials on a device");
  if (sensor.full_well_e || sensor.adc_bits)
    return broken(sensor.adc_bits ? "sensor.adc_bits" : "sensor.full_well_e",
                  sensor.adc_bits ? *sensor.adc_bits : *sensor.full_well_e,
                  "must be left out for trials on a device");
  if (sensor.readout == Readout::rows)
    return broken("sensor.readout", "rows", "must be another one for trials on a device");
  if (options.clip_to_open_sensor || options.draw_every_measurement)
    return broken(options.clip_to_open_sensor ? "clip_to_open_sensor" : "draw_every_measurement",
                  "true", "must be false for trials on a device");
  if (!DepthPrior(camera).is_uniform())
    return broken("operating.depths, working_distance_m", "some",
                  "must be left out for trials on a device");
  return std::nullopt;
}

struct DeviceTrials::Plan {
  Device device;
  DeviceOptions options;
};

DeviceTrials::DeviceTrials(const Device& device, const DeviceOptions& options) {
  options.validate();
  require(device.info().has_doubles, "device", device.info().name, "must have doubles for trials");
  plan_ = std::make_unique<Plan>(Plan{device, options});
}
DeviceTrials::~DeviceTrials() = default;
DeviceTrials::DeviceTrials(DeviceTrials&&) noexcept = default;
DeviceTrials& DeviceTrials::operator=(DeviceTrials&&) noexcept = default;

const Device& DeviceTrials::device() const { return plan_->device; }

TrialsBy DeviceTrials::trials_by() const {
  return [plan = plan_.get()](const DepthTrials& trials) -> TrialRunner {
    if (!trials.draws_in_plane() || !TrialParts(trials).depths.is_uniform()) return {};
    return [there = std::make_shared<TrialDevice>(plan->device, trials, plan->options)](
               const TrialRun& run) { there->run(run); };
  };
}

std::optional<DeviceTrials> device_trials(std::string_view device, const Camera& camera,
                                          const EvaluateOptions& options) {
  if (device == "cpu") return std::nullopt;
  const std::optional<BrokenRule> why_not = why_not_on_device(camera, options);
  if (device != "auto") {
    require(why_not);
    return std::optional<DeviceTrials>(std::in_place, Device::named(device));
  }
  const std::int64_t trials =
      options.target_standard_error > 0.0 ? options.max_trials : options.trials;
  if (why_not || trials < auto_min_trials_to_evaluate) return std::nullopt;
  const std::optional<Device> gpu = Device::first_gpu();
  if (!gpu || !gpu->info().has_doubles) return std::nullopt;
  return std::optional<DeviceTrials>(std::in_place, *gpu);
}

}  // namespace tofsmith
