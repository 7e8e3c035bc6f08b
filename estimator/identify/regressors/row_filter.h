#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "estimator/identify/elements/deformations.h"
#include "estimator/identify/regressors/floor_rows.h"
#include "estimator/numeric/kernels.h"
#include "estimator/state/archive.h"

namespace framewatch::estimator {

/// Forms the regression's rows of every floor, instant after instant. A pure function of the motion
/// since the start: two filters given the same make the same rows to the bit, so the rows that
/// leave the window are formed again instead of stored. Allocates when constructed, never after.
class RowFilter {
 public:
  virtual ~RowFilter() = default;

  /// Back to the state of a new filter, with the tuning as it is now. settle: instants the filters
  /// run before rows count.
  virtual void reset(int settle) = 0;
  virtual void push(const DeformationSet& set) = 0;

  /// rows x padded(front) of a floor at the last push; count() is 0 while it settles.
  const double* rows(int floor) const { return &rows_[offset(floor)]; }
  virtual int count(int floor) const = 0;
  /// Whether rows of a floor are formed, those among them that a start in motion costs.
  virtual bool forms(int floor) const = 0;
  virtual const FloorRows& floor_rows(int floor) const = 0;
  /// Doubles of all floors' rows, and where a floor's begin.
  std::size_t size() const { return rows_.size(); }
  std::size_t offset(int floor) const { return offset_[static_cast<std::size_t>(floor)]; }
  const double* data() const { return rows_.data(); }

  /// Where floor_rows() comes from: 1 the tuning, 2 what some known motions leave, 0 neither.
  virtual std::uint8_t origin_of(int floor, const FloorRows* rows) const = 0;
  virtual const FloorRows* floor_rows_from(int floor, std::uint8_t origin) const = 0;

  virtual void save(StateWriter& state) = 0;
  virtual void load(StateReader& state) = 0;
  template <typename Archive>
  void archive(Archive& a) {
    if constexpr (Archive::kReading)
      load(a);
    else
      save(a);
  }

 protected:
  explicit RowFilter(const FloorLayout& layout) {
    std::size_t at = 0;
    for (int floor = 0; floor < layout.floors(); ++floor) {
      offset_.push_back(at);
      at += static_cast<std::size_t>(layout.most_rows() * padded(layout.front(floor)));
    }
    rows_.assign(at, 0.0);
  }
  RowFilter(const RowFilter&) = default;
  RowFilter& operator=(const RowFilter&) = default;

  std::vector<std::size_t> offset_;
  std::vector<double> rows_;
};

}  // namespace framewatch::estimator
