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

/// How rows are formed and weighted for given parameters theta0, the design of the drawings at
/// first, later what was identified.
class RowTuning {
 public:
  virtual ~RowTuning() = default;

  /// Other parameters. Every part must then be tuned, 0 to parts() - 1, before anything else is
  /// asked. What a part takes fits into one instant.
  virtual void set_theta0(const Eigen::VectorXd& theta0,
                          const std::vector<double>& noise_density) = 0;
  virtual int parts() const = 0;
  virtual void tune(int part) = 0;

  virtual const FloorRows& rows(int floor) const = 0;
  virtual const Eigen::VectorXd& theta0() const = 0;
  virtual const std::vector<double>& noise_density() const = 0;
  /// Instants the slowest filter needs to forget its start, and at least `least`.
  virtual int settle_rows(int least) const = 0;
  /// Instants after a start before rows count: none, where what the filters do not know of the
  /// motion before is removed from the rows (UnknownPast).
  virtual int start_rows() const { return 0; }
  /// How far the filters of a floor are from what they would be at `theta`, relative.
  virtual double detuning(int floor, const Eigen::VectorXd& theta) = 0;
  /// Flags of the axes that rows are formed of, where another set of them asks for another tuning;
  /// empty where it does not.
  virtual const std::vector<std::uint8_t>& axes() const { return no_axes_; }
  /// All parameters, SI, and their relative standard errors.
  struct Known {
    Eigen::VectorXd theta;
    std::vector<double> std_error;
  };
  /// As set_theta0(). Groups of stories that become one, because a floor between them is not
  /// measured any more, keep the ratio that is known.
  virtual void set_axes(const std::vector<std::uint8_t>&, const Known&) {}
  /// The parameters and errors that set_axes() got last.
  virtual const Known& ratios() const { return no_ratios_; }
  /// The same, on its own.
  virtual std::unique_ptr<RowTuning> copy() const = 0;
  /// Refers to the tuning, which must outlive it.
  virtual std::unique_ptr<RowFilter> make_filter(int settle) = 0;

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
  RowTuning() = default;
  RowTuning(const RowTuning&) = default;
  RowTuning& operator=(const RowTuning&) = default;

 private:
  std::vector<std::uint8_t> no_axes_;
  Known no_ratios_;
};

}  // namespace framewatch::estimator
