// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <new>

#include "decode/ambient_projection.hpp"

namespace tofsmith {

/// Rows of floats, aligned to blocks of four. Row -1 contains zeros ("no bin").
class RecordTable {
 public:
  RecordTable(std::int32_t rows, int fields);

  int stride() const { return stride_; }
  /// Number of floats, including row -1.
  std::size_t size() const { return size_; }
  /// Row n starts at (n + 1) stride.
  const float* data() const { return values_.get(); }
  const float* row(std::int32_t n) const { return &values_[offset(n)]; }
  float* row(std::int32_t n) { return &values_[offset(n)]; }

 private:
  std::size_t offset(std::int32_t n) const {
    return static_cast<std::size_t>(n + 1) * static_cast<std::size_t>(stride_);
  }
  /// Two cache lines, which are prefetched together.
  static constexpr std::align_val_t alignment{128};
  struct Free {
    void operator()(float* values) const { ::operator delete[](values, alignment); }
  };
  int stride_;
  std::size_t size_;
  std::unique_ptr<float[], Free> values_;
};

/// Offsets of the fields of a bin's record, frequently used ones first. With the curve p at the
/// bin, the chord e to a neighbour, and the unit vector w across p in its direction,
///   e = beta p + c w.
/// Records of smooth curves contain DepthPolynomials instead of chords.
struct RecordLayout {
  int rank = 0;
  int measurements = 0;
  bool is_smooth = false;

  constexpr int point() const { return 0; }           ///< p / |p|^2 (rank)
  constexpr int left() const { return rank; }         ///< w to the previous bin (rank); 0: no chord
  constexpr int right() const { return 2 * rank; }    ///< w to the next bin (rank)
  constexpr int turn() const { return 3 * rank; }     ///< beta / c, left and right
  constexpr int reach() const { return turn() + 2; }  ///< 1 / c, left and right

  constexpr int slope() const { return rank; }          ///< W (rank)
  constexpr int bend() const { return 2 * rank; }       ///< B (rank)
  constexpr int asymmetry() const { return 3 * rank; }  ///< C (rank)
  constexpr int growth() const { return 4 * rank; }     ///< growth and growth_change

  constexpr int end_of_depth() const { return is_smooth ? growth() + 2 : reach() + 2; }

  constexpr int ambient() const { return end_of_depth(); }  ///< <x, a> / |a|^2
  constexpr int end_of_light() const { return ambient() + 1; }

  /// Variance of the signal: per signal, per ambient light, and without light.
  constexpr int signal_noise() const { return end_of_light(); }
  constexpr int end_of_noise() const { return signal_noise() + 3; }

  /// |p|, cosine and sine of LobeBound, and typical_variance() per signal; filled by OutputKernel.
  constexpr int bound() const { return end_of_noise(); }
  constexpr int end_of_bound() const { return bound() + 4; }

  /// Variance per signal (K); starts a block.
  constexpr int shot() const { return (end_of_bound() + 3) / 4 * 4; }
  constexpr int end() const { return shot() + measurements; }
};

/// Chords of a bin: blocks of four fields, from the last quarter of the left chord to the last
/// quarter of the right chord.
struct ChordLayout {
  static constexpr int quarters = 4;
  static constexpr int at_bin = quarters;
  static constexpr int blocks = 2 * quarters + 1;
  /// First row of a bin in a table of chords. The blocks of bin -1 are 0.
  static constexpr std::int32_t first_row(std::int32_t bin) { return blocks * (bin + 1) - 1; }

  /// S^2 times the variance of depth [m^2]: per signal, per ambient light, and without light;
  /// infinite without slope.
  static constexpr int depth_noise = 0;
  static constexpr int ambient = 3;  ///< change of <x, a> / |a|^2 along the chord
  static constexpr int fields = 4;
};

/// Maximum number of fields, a multiple of four.
inline constexpr int max_record_fields =
    (RecordLayout{max_measurements, max_measurements, true}.end() + 3) / 4 * 4;

/// All data that depend on the bin only, in single precision.
struct BinRecords {
  /// @param with_chords  false: positions only, chords are 0
  BinRecords(const DecodingTable& table, const AmbientProjection& projection, bool with_chords);

  RecordLayout layout;
  RecordTable records;
  RecordTable chords;

 private:
  template <typename Builder>
  BinRecords(const DecodingTable& table, bool with_chords, const Builder& builder);
};

}  // namespace tofsmith
