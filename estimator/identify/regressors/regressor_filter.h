#pragma once

#include <cstdint>
#include <vector>

#include "estimator/identify/regressors/regressor_tuning.h"
#include "estimator/identify/regressors/row_filter.h"
#include "estimator/identify/regressors/unknown_past.h"

namespace framewatch::estimator {

/// Forms the regression's rows of every floor from p, p' and p'' of the element deformations: each
/// row passes its oscillator section (docs/equations.md (12), the last part of the drift-controlled
/// integrator) and is weighted, (13).
class RegressorFilter : public RowFilter {
 public:
  /// settle: instants a floor's filters run before its rows count, after a start or when another
  /// set of motions is known. The tuning must outlive the filter.
  RegressorFilter(RegressorTuning& tuning, const FloorLayout& layout, int settle);

  void reset(int settle) override;
  void push(const DeformationSet& set) override;

  int count(int floor) const override {
    const Floor& f = floor_[static_cast<std::size_t>(floor)];
    return f.settling > 0 || f.starting ? 0 : f.rows->rows;
  }
  bool forms(int floor) const override {
    const Floor& f = floor_[static_cast<std::size_t>(floor)];
    return f.settling == 0 && f.rows->rows > 0;
  }
  const FloorRows& floor_rows(int floor) const override {
    return *floor_[static_cast<std::size_t>(floor)].rows;
  }

  std::uint8_t origin_of(int floor, const FloorRows* rows) const override {
    if (rows == nullptr) return 0;
    if (rows == &tuning_->rows(floor)) return 1;
    return rows == &floor_[static_cast<std::size_t>(floor)].some_known ? 2 : 0;
  }
  const FloorRows* floor_rows_from(int floor, std::uint8_t origin) const override {
    if (origin == 1) return &tuning_->rows(floor);
    return origin == 2 ? &floor_[static_cast<std::size_t>(floor)].some_known : nullptr;
  }
  void save(StateWriter& state) override { members(state); }
  void load(StateReader& state) override { members(state); }

 private:
  template <typename Archive>
  void members(Archive& a) {
    a.within(settle_, 0, a.kMaxCount);
    a.each_within(known_, 0, 1);
    a.finite(rows_);
    for (int floor = 0; floor < layout_->floors(); ++floor) {
      Floor& f = floor_[static_cast<std::size_t>(floor)];
      std::uint8_t origin = origin_of(floor, f.rows);
      a(origin, f.some_known);
      if (!f.some_known.fits(*layout_, floor)) a.refuse();
      a.finite(f.s1, f.s2);
      a(f.past, f.starting);
      a.within(f.settling, 0, a.kMaxCount);
      f.rows = floor_rows_from(floor, origin == 2 ? 2 : 1);
    }
  }

  struct Floor {
    const FloorRows* rows = nullptr;  ///< the tuning's, or those below
    FloorRows some_known;
    std::vector<double> s1, s2;
    UnknownPast past;
    bool starting = false;  ///< too few rows since the start to know the past from
    int settling = 0;
  };
  void rebuild(int floor);
  bool all_known_around(int floor) const;
  bool same_surroundings(int floor, const std::vector<std::uint8_t>& known) const;

  RegressorTuning* tuning_;
  const FloorLayout* layout_;
  int settle_;
  std::vector<std::uint8_t> known_;
  std::vector<int> changed_;
  std::vector<Floor> floor_;
  std::vector<double> signal_, response_;
};

}  // namespace framewatch::estimator
