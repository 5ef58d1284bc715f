// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "gpu/device_trials.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "decode/filter/shared/filter_parts.hpp"
#include "gpu/doubles.hpp"
#include "gpu/table_words.hpp"
#include "tofsmith/core/parallel.hpp"

namespace tofsmith {

namespace {

constexpr std::int64_t min_part_trials = 1024, max_part_trials = std::int64_t{1} << 22;

std::string options_of_trials(const DepthTrials& trials) {
  const auto rank = trials.decoder().plane_map()->weight.rows();
  return fmt::format("-DHAS_DOUBLES{} -DRANK={} -DMEASUREMENTS={} -DTAPS={}",
                     fuses_products() ? " -DFUSES_PRODUCTS" : "", rank, trials.measurements(),
                     std::max(trials.measurements(), trials.model().taps()));
}

int flag(bool is_so) { return is_so ? 1 : 0; }

/// What is the same at all points.
TrialParameters trial_parameters_of(const DepthTrials& trials, TableWords& tables) {
  const TrialModel& model = trials.model();
  const TapConversion& sensor = model.conversion();
  const EvaluateOptions& asked = trials.options();
  const DepthPrior& depths = trials.depths();
  TrialParameters p{};
  p.rows = static_cast<double>(model.rows());
  p.rows_per_bin = static_cast<double>(model.rows_per_bin());
  p.prior_begin = depths.begin();
  p.prior_end = depths.end();
  p.seed_low = static_cast<std::uint32_t>(asked.seed);
  p.seed_high = static_cast<std::uint32_t>(asked.seed >> 32);
  p.has_uniform_albedo = flag(trials.has_uniform_albedo());
  p.on_bins = flag(asked.depth == DepthSampling::bins);
  p.prior_parts = static_cast<int>(depths.part_masses().size());
  p.prior_masses = tables.add(depths.part_masses());
  p.prior_below = tables.add(depths.below_parts());
  p.taps = model.taps();
  p.has_own_shot_noise = flag(model.has_own_shot_noise());
  p.records = tables.add(std::span(model.records().data(), model.records().size()));
  p.record_stride = model.records().stride();
  p.is_poisson = flag(sensor.is_poisson);
  p.has_adc = flag(sensor.has_adc);
  p.is_signed = flag(sensor.is_signed);
  p.read_noise_e = sensor.read_noise_e;
  p.full_well_e = sensor.full_well_e;
  p.dn_per_e = sensor.dn_per_e;
  p.black_level_dn = sensor.black_level_dn;
  p.min_dn = sensor.min_dn;
  p.max_dn = sensor.max_dn;
  p.row_points = -1;
  if (const RowTrials* rows = trials.rows()) {
    p.is_poisson = flag(rows->is_poisson());
    p.read_noise_e = static_cast<float>(rows->read_noise_e());
    p.row_points = tables.add(rows->of_signal());
    p.row_weights = tables.add(rows->weights());
    p.points_per_bin = RowTrials::points_per_bin;
  }
  return p;
}

/// Of a point, beside what is the same at all.
void add_point(const DepthTrials& trials, std::size_t point, TableWords& tables,
               TrialParameters& p) {
  const OperatingPoint& light = trials.points()[point];
  p.signal_e_per_s = light.signal_e_per_s;
  p.signal = static_cast<float>(trials.albedo() * light.signal_e_per_s);
  p.point_low = static_cast<std::uint32_t>(point);
  if (const RowTrials* rows = trials.rows()) {
    p.row_floors = tables.add(rows->beside_signal(light.ambient_e_per_s));
    return;
  }
  p.mean_floors = tables.add(trials.mean_floor_e(point));
  p.shot_floors = tables.add(trials.shot_floor_e2(point));
  const std::vector<float>& max_e = trials.max_e(point);
  p.max_electrons = max_e.empty() ? -1 : tables.add(max_e);
  if (!trials.draws_in_plane()) return;
  const PlaneNoise& noise = trials.plane_noise()[point];
  p.weights = tables.add(noise.weight);
  p.products = tables.add(noise.products);
  p.offsets = tables.add(noise.offset);
  p.covariances = tables.add(noise.floor);
}

}  // namespace

TrialDevice::TrialDevice(const Device& device, const DepthTrials& trials,
                         const DeviceOptions& options)
    : trials_(trials),
      decoder_(trials.believed()),
      tile_(device, decoder_, options.use_doubles, true),
      queue_(device),
      draw_(queue_.kernel(trial_kernels, options_of_trials(trials),
                          trials.draws_in_plane() ? "draw_in_plane" : "draw_measurements")),
      opened_(queue_.allocate(sizeof(std::int32_t))),
      part_trials_(
          std::clamp(static_cast<std::int64_t>(1e6 * options.memory_mb /
                                               static_cast<double>(tile_.bytes_per_pixel() + 12)),
                     min_part_trials, max_part_trials)) {
  std::vector<std::uint32_t> words;
  TableWords tables(words);
  const TrialParameters all = trial_parameters_of(trials, tables);
  for (std::size_t point = 0; point < trials.points().size(); ++point)
    add_point(trials, point, tables, of_point_.emplace_back(all));
  const std::size_t bytes = words.size() * sizeof(std::uint32_t);
  queue_.upload(words.data(), bytes, *reserve(queue_, words_, static_cast<std::int64_t>(bytes)));
}

void TrialDevice::run_here(const TrialRun& part, std::int64_t trial) {
  const std::int64_t number = part.trials.begin + trial;
  const TrialBlock block = trials_.run(part.round, {number, number + 1}, work_);
  part.true_bin[trial] = block.true_bin.front();
  part.decoded_bin[trial] = block.decoded_bin.front();
}

/// Decodes trials by what the device has drawn.
void TrialDevice::decode_here(const std::vector<std::int32_t>& open, double* decoded_bin) {
  const TrialDecoder& decoder = trials_.decoder();
  const bool in_plane = trials_.draws_in_plane(), sub_bin = trials_.options().sub_bin;
  const std::size_t each = static_cast<std::size_t>(trials_.measurements()) + 1,
                    numbers = in_plane
                                  ? static_cast<std::size_t>(decoder.plane_map()->offset.size())
                                  : each - 1;
  const std::vector<float> drawn = tile_.numbers_of(open);
  parallel_for((std::ssize(open) + trials_per_tile - 1) / trials_per_tile, [&](std::int64_t part) {
    const auto first = static_cast<std::size_t>(part) * trials_per_tile,
               count = std::min<std::size_t>(open.size() - first, trials_per_tile);
    TrialTile tile;
    tile.pixels.pixels = static_cast<int>(count);
    float* const to = in_plane ? tile.pixels.plane : tile.taps;
    std::fill_n(to, numbers * trials_per_tile, 0.0f);
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t k = 0; k < numbers; ++k)
        to[k * trials_per_tile + i] = drawn[(first + i) * each + k];
    if (in_plane)
      decoder.decode_plane(sub_bin, tile.pixels, tile.decoded_bin);
    else
      decoder.decode_raw(tile.taps, sub_bin, tile.pixels, tile.decoded_bin);
    for (std::size_t i = 0; i < count; ++i) decoded_bin[open[first + i]] = tile.decoded_bin[i];
  });
  decoded_here_ += std::ssize(open);
}

/// Fills true_bin, and undrawn_ with the trials that the processor is to draw.
void TrialDevice::draw_part(const TrialRun& part) {
  const std::int64_t count = part.trials.end - part.trials.begin;
  TrialParameters parameters = of_point_[part.round.point];
  parameters.first = static_cast<double>(part.trials.begin);
  parameters.rows_per_trial = parameters.rows / static_cast<double>(part.round.trials);
  parameters.first_of_stream = static_cast<std::uint32_t>(part.round.first + part.trials.begin);
  parameters.trials = static_cast<int>(count);
  parameters.margin = margin;
  const bool in_plane = trials_.draws_in_plane();
  const DeviceRaw& raw = tile_.reserve_planes(count, in_plane ? raw_plane : raw_float);
  const std::size_t bytes = static_cast<std::size_t>(count) * sizeof(double);
  reserve(queue_, true_bins_, static_cast<std::int64_t>(bytes));
  undrawn_.clear();
  if (in_plane) {
    queue_.run(draw_, count, parameters, &words_, &true_bins_, raw.numbers(), raw.averaged());
    return queue_.download(true_bins_, bytes, part.true_bin);  // all is drawn then
  }
  std::int32_t open = 0;
  queue_.upload(&open, sizeof open, opened_);
  reserve(queue_, open_, count * std::int64_t{sizeof(std::int32_t)});
  queue_.run(draw_, count, parameters, &words_, &true_bins_, raw.numbers(), raw.averaged(),
             &opened_, &open_);
  queue_.download(true_bins_, bytes, part.true_bin);
  queue_.download(opened_, sizeof open, &open);
  undrawn_.resize(static_cast<std::size_t>(open));
  if (open > 0) queue_.download(open_, undrawn_.size() * sizeof(std::int32_t), undrawn_.data());
}

void TrialDevice::run_part(const TrialRun& part) {
  draw_part(part);
  tile_.find_positions(trials_.options().sub_bin, part.decoded_bin);
  if (const std::vector<std::int32_t> open = tile_.open_pixels(); !open.empty())
    decode_here(open, part.decoded_bin);
  for (const std::int32_t trial : undrawn_) run_here(part, trial);
  drawn_here_ += std::ssize(undrawn_);
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
      open_ = DeviceMemory();
      part_trials_ = std::max(count / 2, min_part_trials);
    }
  }
}

std::optional<BrokenRule> why_not_on_device(const EvaluateOptions& options) {
  if (options.method == DecodeMethod::zncc) return std::nullopt;
  return broken("method", name_of(options.method),
                "must be zncc, by which alone devices decode, or the device cpu");
}

struct DeviceTrials::Plan {
  Device device;
  DeviceOptions options;
};

DeviceTrials::DeviceTrials(const Device& device, const DeviceOptions& options) {
  options.validate();
  plan_ = std::make_unique<Plan>(Plan{with_doubles(device, "trials"), options});
}
DeviceTrials::~DeviceTrials() = default;
DeviceTrials::DeviceTrials(DeviceTrials&&) noexcept = default;
DeviceTrials& DeviceTrials::operator=(DeviceTrials&&) noexcept = default;

const Device& DeviceTrials::device() const { return plan_->device; }

TrialsBy DeviceTrials::trials_by() const {
  return [plan = plan_.get()](const DepthTrials& trials) -> TrialRunner {
    if (why_not_on_device(trials.options())) return {};
    return [there = std::make_shared<TrialDevice>(plan->device, trials, plan->options)](
               const TrialRun& run) { there->run(run); };
  };
}

std::optional<DeviceTrials> device_trials(std::string_view device, const EvaluateOptions& options) {
  if (device == "cpu") return std::nullopt;
  const std::optional<BrokenRule> why_not = why_not_on_device(options);
  if (device != "auto") {
    require(why_not);
    return std::optional<DeviceTrials>(std::in_place, Device::named(device));
  }
  const std::int64_t trials =
      options.target_standard_error > 0.0 ? options.max_trials : options.trials;
  if (why_not || trials < auto_min_trials_to_evaluate) return std::nullopt;
  const std::optional<Device> gpu = gpu_with_doubles();
  if (!gpu) return std::nullopt;
  return std::optional<DeviceTrials>(std::in_place, *gpu);
}

}  // namespace tofsmith
