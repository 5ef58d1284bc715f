// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "decode/search/shared/bin_records.hpp"

#include <algorithm>
#include <limits>

#include "core/shared/whole_vectors.hpp"
#include "decode/ambient_projection.hpp"
#include "decode/search/direction_table.hpp"
#include "decode/search/smooth_curve.hpp"

namespace tofsmith {

namespace {

constexpr int floats_per_line = 16;  // cache line

void store(const Eigen::VectorXd& values, float* to) {
  std::transform(values.begin(), values.end(), to,
                 [](double value) { return static_cast<float>(value); });
}

class RecordBuilder {
 public:
  RecordBuilder(const DecodingTable& table, const AmbientProjection& projection)
      : table_(table),
        projection_(projection),
        polynomials_(depth_polynomials(projection.curve)),
        layout_{projection.rank(), table.measurements(), polynomials_.has_value()},
        ambient2_(projection.ambient.squaredNorm()),
        noise_(table) {}

  const RecordLayout& layout() const { return layout_; }

  /// @param chords  table of all chords; null: skipped
  void fill(std::int32_t n, float* record, RecordTable* chords) const {
    const Eigen::VectorXd p = point(n);
    const double length2 = p.squaredNorm();
    if (length2 == 0.0) return;
    const Eigen::VectorXd shot = noise_.shot_gated.row(n);
    store(p / length2, record + layout_.point());
    store(noise_along(p / length2, shot), record + layout_.signal_noise());
    store(shot, record + layout_.shot());
    if (ambient2_ > 0.0) record[layout_.ambient()] = static_cast<float>(ambient_part(n));

    const std::int32_t samples = table_.samples();
    const std::int32_t before = (n + samples - 1) % samples, after = (n + 1) % samples;
    if (polynomials_) {
      fill_polynomial(n, record);
    } else {
      fill_side(n, before, record + layout_.left(), record + layout_.turn());
      fill_side(n, after, record + layout_.right(), record + layout_.turn() + 1);
    }
    if (!chords) return;
    const std::int32_t at_bin = ChordLayout::first_row(n) + ChordLayout::at_bin;
    store(depth_noise_at(p, 0.5 * (point(after) - point(before)), shot),
          chords->row(at_bin) + ChordLayout::depth_noise);
    for (int quarter = 0; quarter < ChordLayout::quarters; ++quarter) {
      fill_chord(n, before, quarter, chords->row(at_bin - 1 - quarter));
      fill_chord(n, after, quarter, chords->row(at_bin + 1 + quarter));
    }
  }

 private:
  Eigen::VectorXd point(std::int32_t n) const { return projection_.curve.row(n); }
  double ambient_part(std::int32_t n) const {
    return projection_.gated.row(n).dot(projection_.ambient) / ambient2_;
  }

  void fill_polynomial(std::int32_t n, float* record) const {
    store(polynomials_->slope.row(n), record + layout_.slope());
    store(polynomials_->bend.row(n), record + layout_.bend());
    store(polynomials_->asymmetry.row(n), record + layout_.asymmetry());
    record[layout_.growth()] = static_cast<float>(polynomials_->growth[n]);
    record[layout_.growth() + 1] = static_cast<float>(polynomials_->growth_change[n]);
  }

  void fill_side(std::int32_t n, std::int32_t neighbour, float* across_to, float* turn) const {
    const Eigen::VectorXd p = point(n), chord = point(neighbour) - p;
    const double beta = p.dot(chord) / p.squaredNorm();
    const Eigen::VectorXd across = chord - beta * p;
    const double c = across.norm();
    if (c * c <= parallel_chords * point(neighbour).squaredNorm()) return;
    store(across / c, across_to);
    turn[0] = static_cast<float>(beta / c);
    turn[2] = static_cast<float>(1.0 / c);
  }

  void fill_chord(std::int32_t n, std::int32_t neighbour, int quarter, float* fields) const {
    const double t = (quarter + 0.5) / ChordLayout::quarters;
    const Eigen::VectorXd p = point(n), chord = point(neighbour) - p;
    const Eigen::VectorXd shot =
        (1 - t) * noise_.shot_gated.row(n) + t * noise_.shot_gated.row(neighbour);
    store(depth_noise_at(p + t * chord, chord, shot), fields + ChordLayout::depth_noise);
    if (ambient2_ > 0.0)
      fields[ChordLayout::ambient] = static_cast<float>(ambient_part(neighbour) - ambient_part(n));
  }

  Eigen::Vector3d depth_noise_at(const Eigen::VectorXd& p, const Eigen::VectorXd& slope,
                                 const Eigen::VectorXd& shot) const {
    const Eigen::VectorXd across = slope - slope.dot(p) / p.squaredNorm() * p;
    const double across2 = across.squaredNorm();
    if (!(across2 > parallel_chords * slope.squaredNorm()))
      return {0.0, 0.0, std::numeric_limits<double>::infinity()};
    return noise_along(across * (table_.row_m() / across2), shot);
  }

  /// Variance of <weight, q>: per signal, per ambient light, and without light.
  Eigen::Vector3d noise_along(const Eigen::VectorXd& weight, const Eigen::VectorXd& shot) const {
    const Eigen::VectorXd squares = (projection_.noise_basis * weight).cwiseAbs2();
    Eigen::Vector3d noise;
    noise << squares.dot(shot), squares.dot(noise_.shot_ambient),
        squares.dot(noise_.floor_variance_e2);
    return noise;
  }

  const DecodingTable& table_;
  const AmbientProjection& projection_;
  std::optional<DepthPolynomials> polynomials_;
  RecordLayout layout_;
  double ambient2_;  // |a|^2
  ExpectedNoise noise_;
};

}  // namespace

RecordTable::RecordTable(std::int32_t rows, int fields)
    : stride_(fields <= floats_per_line ? rounded_up(fields, 4)
                                        : rounded_up(fields, floats_per_line)),
      size_(offset(rows)),
      values_(static_cast<float*>(::operator new[](size_ * sizeof(float), alignment))) {
  std::fill_n(values_.get(), size_, 0.0f);
}

BinRecords::BinRecords(const DecodingTable& table, const AmbientProjection& projection,
                       bool with_chords)
    : BinRecords(table, with_chords, RecordBuilder(table, projection)) {}

template <typename Builder>
BinRecords::BinRecords(const DecodingTable& table, bool with_chords, const Builder& builder)
    : layout(builder.layout()),
      records(table.samples(), layout.end()),
      chords(ChordLayout::first_row(table.samples()), ChordLayout::fields) {
  for (std::int32_t n = 0; n < table.samples(); ++n)
    builder.fill(n, records.row(n), with_chords ? &chords : nullptr);
}

}  // namespace tofsmith
