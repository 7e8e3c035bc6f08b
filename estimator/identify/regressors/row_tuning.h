// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include <Eigen/Core>

#include "estimator/identify/elements/deformations.h"
#include "estimator/identify/regressors/floor_rows.h"
#include "estimator/numeric/kernels.h"
#include "estimator/state/archive.h"

namespace framewatch::estimator {

/// Forms the regression rows of every floor, instant by instant. Rows depend only on the motion
/// since the start: two filters with the same input form the same bits. So the rows that leave the
/// window are formed again instead of being stored. Allocates only in the constructor.
class RowFilter : public SavedByVirtual {
 public:
  /// Returns to the state of a new filter with the present tuning. settle: instants that the
  /// filters run before rows count.
  virtual void reset(int settle) = 0;
  virtual void push(const DeformationSet& set) = 0;

  /// Returns the rows of a floor at the last push, rows x padded(front). count() is their number, 0
  /// while the floor settles.
  const double* rows(int floor) const { return &rows_[offset(floor)]; }
  virtual int count(int floor) const = 0;
  /// Returns true if rows of a floor are formed, including those that a start in motion uses up.
  virtual bool forms(int floor) const = 0;
  virtual const FloorRows& floor_rows(int floor) const = 0;
  /// Return the number of doubles in the rows of all floors, and the place where the rows of a
  /// floor begin.
  std::size_t size() const { return rows_.size(); }
  std::size_t offset(int floor) const { return offset_[static_cast<std::size_t>(floor)]; }
  const double* data() const { return rows_.data(); }

  /// Returns the origin of `rows`: 1 for the tuning's rows, 2 for rows of partly known motion, 0
  /// for neither.
  virtual std::uint8_t origin_of(int floor, const FloorRows* rows) const = 0;
  virtual const FloorRows* floor_rows_from(int floor, std::uint8_t origin) const = 0;

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

/// Defines how rows are formed and weighted for given parameters theta0. At first theta0 is the
/// design, later it is identified.
class RowTuning : public SavedByVirtual {
 public:
  /// Sets other parameters. Then tune every part, 0 to parts() - 1, before calling anything else.
  /// One part fits into one instant.
  virtual void set_theta0(const Eigen::VectorXd& theta0,
                          const std::vector<double>& noise_density) = 0;
  virtual int parts() const = 0;
  virtual void tune(int part) = 0;

  virtual const FloorRows& rows(int floor) const = 0;
  virtual const Eigen::VectorXd& theta0() const = 0;
  virtual const std::vector<double>& noise_density() const = 0;
  /// Returns the instants that the slowest filter needs to forget its start, and at least `least`.
  virtual int settle_rows(int least) const = 0;
  /// Returns the instants after a start before rows count: 0 if the unknown past is removed from
  /// the rows (UnknownPast).
  virtual int start_rows() const { return 0; }
  /// Returns the largest relative difference between a floor's filters and those tuned to `theta`.
  virtual double detuning(int floor, const Eigen::VectorXd& theta) = 0;
  /// Returns the flags of the axes that rows are formed from. Empty if the tuning does not depend
  /// on the set of axes.
  virtual const std::vector<std::uint8_t>& axes() const { return no_axes_; }
  /// All parameters, SI, and their relative standard errors.
  struct Known {
    Eigen::VectorXd theta;
    std::vector<double> std_error;
  };
  /// Sets other axes; then tune every part, as after set_theta0(). Groups of stories that merge,
  /// because a floor between them is no longer measured, keep their known ratio.
  virtual void set_axes(const std::vector<std::uint8_t>&, const Known&) {}
  /// Returns the parameters and errors of the last call of set_axes().
  virtual const Known& ratios() const { return no_ratios_; }
  /// Returns an independent copy.
  virtual std::unique_ptr<RowTuning> copy() const = 0;
  /// Returns a filter that refers to this tuning, which must outlive it.
  virtual std::unique_ptr<RowFilter> make_filter(int settle) = 0;

 protected:
  RowTuning() = default;
  RowTuning(const RowTuning&) = default;
  RowTuning& operator=(const RowTuning&) = default;

 private:
  std::vector<std::uint8_t> no_axes_;
  Known no_ratios_;
};

}  // namespace framewatch::estimator
