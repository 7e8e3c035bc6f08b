// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "estimator/motion/sample.h"
#include "estimator/structure/effect.h"
#include "estimator/watch/change_record.h"

namespace framewatch::estimator {

/// The model simulated beside the measurement. Time-dependent effects act from the start; external
/// forces do not act.
struct GapModel {
  Eigen::VectorXd theta;  ///< in the order of the parameter table, SI
  std::vector<Effect> effects;
};

struct GapOptions {
  double window_s = 10;  ///< whole seconds
  double learn_s = 60;  ///< total length of the windows to learn a model from, if no model is given
  /// Share of the motion that must remain unexplained, beyond the noise, for a gap.
  double raise_ratio = 0.15;
  double lasting_s = 10;  ///< time until a gap is accepted, and until it is over
};

/// The gap between simulation and measurement over one window: sqrt(sum (measured - simulated)^2 /
/// sum measured^2) of absolute accelerations, both behind the estimation's drift control and
/// filter. Its floor is the part that the noise of the sensors explains.
struct GapWindow {
  Time start, end;
  double nrmse = 0;                            ///< of all axes above the base
  double floor = 0;                            ///< NaN while it is not known
  std::vector<double> axis_nrmse, axis_floor;  ///< of each axis; NaN: base, or no values

  void archive(auto& a) { a(start, end, nrmse, floor, axis_nrmse, axis_floor); }
};

/// Sums simulation and measurement second by second and compares them over the last window_s.
class GapMeter {
 public:
  /// compared: by axis, 1: compared. rate_hz: of the instants.
  GapMeter(const std::vector<char>& compared, double rate_hz, int window_s);

  void restart();
  /// Adds one axis at the present instant, m/s^2. Not called for an axis without a value.
  void add(std::size_t axis, double measured, double simulated);
  /// Returns true if the present instant is the last of a second; close() then needs the noise.
  bool ends_second() const { return instants_ + 1 >= per_second_; }
  /// Ends the instant. Returns true when it ends a second and the window is full; gap() is then
  /// valid.
  bool close(Time time, const std::vector<double>& noise_variance);
  const GapWindow& gap() const { return gap_; }

  void archive(auto& a) {
    a(seconds_, gap_);
    a.within(newest_, 0, window_s_ - 1);
    a.within(full_, 0, window_s_);
    a.within(instants_, 0, per_second_);
  }

 private:
  struct Sum {
    double difference = 0, measured = 0;  ///< of squares
    std::int64_t count = 0;

    void archive(auto& a) {
      a.finite(difference, measured);
      a.within(count, 0, a.kMaxCount);
    }
  };
  void compare(const std::vector<double>& noise_variance);
  Sum& of(int second, std::size_t axis) {
    return seconds_[static_cast<std::size_t>(second) * compared_.size() + axis];
  }

  std::vector<char> compared_;
  int per_second_, window_s_;
  std::vector<Sum> seconds_;  ///< ring of window_s x axes
  int newest_ = 0, full_ = 0, instants_ = 0;
  GapWindow gap_;
};

/// The begin or end of a lasting gap between simulation and measurement.
struct GapNews {
  std::int64_t id =
      0;  ///< sensor time at which it was raised, microseconds; the same when it is cleared
  AlarmState state = AlarmState::raised;
  Time found, since;  ///< end and start of windows
  double excess = 0;  ///< sqrt(nrmse^2 - floor^2)
  int worst_axis = -1;
  /// For a raised gap: the stiffness furthest from the model's in the windows since then, in
  /// standard errors; -1: no stiffness differs.
  int parameter = -1;
  double ratio = 0, std_error = 0;  ///< its change relative to the model

  void archive(auto& a) {
    a.within(id, -2 * a.kMaxCount, 2 * a.kMaxCount);
    a.within(state, 0, static_cast<double>(AlarmState::changed));
    a(found, since);
    a.finite(excess);
    a.within(worst_axis, -1, 1e6);
    a.within(parameter, -1, 1e6);
    a.finite(ratio, std_error);
  }
};

/// Decides when a gap lasts. Ignores windows in which noise alone would be as large as a gap.
class GapAlarm {
 public:
  explicit GapAlarm(const GapOptions& options) : options_(options) {}

  /// Takes one window per second. Returns the news when a gap begins or ends, else null; valid
  /// until the next call.
  const GapNews* push(const GapWindow& window);
  bool raised() const { return raised_; }
  /// Returns the end of the first window that shows a gap not yet raised; nullopt if no window
  /// does.
  std::optional<Time> showing() const;

  void archive(auto& a) {
    a.within(seconds_, 0, a.kMaxCount);
    a(raised_, since_, shown_, news_);
  }

 private:
  GapOptions options_;
  bool raised_ = false;
  int seconds_ = 0;         ///< for which windows have contradicted the state
  Time since_{}, shown_{};  ///< start and end of the first such window
  GapNews news_;
};

}  // namespace framewatch::estimator
