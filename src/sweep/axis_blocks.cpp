// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "sweep/axis_blocks.hpp"

#include <fmt/format.h>

#include <map>

namespace tofsmith {

namespace {

SweepCombination combination_of(const SweepSpec& spec, const std::string& group) {
  const auto found = spec.groups.find(group);
  return found == spec.groups.end() ? SweepCombination::zip : found->second;
}

std::int64_t size_of(const SweepSpec& spec, const AxisDigit& digit) {
  return static_cast<std::int64_t>(spec.axes[digit.front()].values.size());
}

/// Limits the product to 2^62.
std::int64_t counted_product(std::int64_t a, std::int64_t b) {
  constexpr std::int64_t max_count = std::int64_t{1} << 62;
  if (a == 0 || b == 0) return 0;
  return a > max_count / b ? max_count : a * b;
}

}  // namespace

std::vector<std::vector<AxisBlock>> axis_blocks(const SweepSpec& spec) {
  std::vector<AxisBlock> blocks;
  std::map<std::string, std::size_t> block_of_group;
  for (std::size_t a = 0; a < spec.axes.size(); ++a) {
    const SweepAxis& axis = spec.axes[a];
    std::size_t block = blocks.size();
    if (!axis.group.empty()) block = block_of_group.try_emplace(axis.group, block).first->second;
    if (axis.linked) block = axis.group.empty() ? blocks.size() - 1 : block;
    if (block == blocks.size()) blocks.emplace_back();
    std::vector<AxisDigit>& digits = blocks[block].digits;
    const bool joins = axis.linked || combination_of(spec, axis.group) == SweepCombination::zip;
    if (!digits.empty() && joins)
      digits.back().push_back(a);
    else
      digits.push_back({a});
  }
  std::vector<std::vector<AxisBlock>> lists;
  std::ptrdiff_t zipped = -1;
  for (AxisBlock& block : blocks) {
    for (const AxisDigit& digit : block.digits)
      block.size = counted_product(block.size, size_of(spec, digit));
    const SweepAxis& first = spec.axes[block.digits.front().front()];
    const bool is_zipped = spec.combine == SweepCombination::zip && !first.crossed;
    if (is_zipped && zipped >= 0) {
      lists[static_cast<std::size_t>(zipped)].push_back(std::move(block));
      continue;
    }
    if (is_zipped) zipped = static_cast<std::ptrdiff_t>(lists.size());
    lists.push_back({std::move(block)});
  }
  return lists;
}

std::string name_of(const SweepSpec& spec, const AxisBlock& block) {
  const SweepAxis& first = spec.axes[block.digits.front().front()];
  return first.group.empty() ? fmt::format("axis {}", first.key)
                             : fmt::format("group {}", first.group);
}

std::int64_t SweepSpec::items() const {
  std::int64_t count = 1;
  for (const std::vector<AxisBlock>& together : axis_blocks(*this))
    count = counted_product(count, together.front().size);
  return count;
}

std::vector<std::size_t> SweepSpec::value_indices(std::int64_t item) const {
  std::vector<std::size_t> indices(axes.size());
  const std::vector<std::vector<AxisBlock>> lists = axis_blocks(*this);
  for (auto together = lists.rbegin(); together != lists.rend(); ++together) {
    for (const AxisBlock& block : *together) {
      std::int64_t place = item % block.size;
      for (auto digit = block.digits.rbegin(); digit != block.digits.rend(); ++digit) {
        const std::int64_t base = size_of(*this, *digit);
        for (const std::size_t axis : *digit)
          indices[axis] = static_cast<std::size_t>(place % base);
        place /= base;
      }
    }
    item /= together->front().size;
  }
  return indices;
}

}  // namespace tofsmith
