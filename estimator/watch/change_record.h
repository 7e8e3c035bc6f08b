// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "estimator/motion/sample.h"

namespace framewatch::estimator {

/// The size and the time of a change of one parameter.
struct Change {
  double ratio = 0;  ///< relative to the baseline; -0.05: a loss of 5 %
  double std_error = 0;
  Time since{};               ///< the most likely instant of the change
  Time earliest{}, latest{};  ///< the interval in which it lies

  void archive(auto& a) {
    a.finite(ratio, std_error);
    a(since, earliest, latest);
  }
};

/// How far a record of a change has got. changing: the parameter changes or has changed, but its
/// size is not known well enough for a number. measured: ratio and std_error are valid.
enum class ChangeState { none, changing, measured };

/// Why a record ended, or why its number differs by more than its earlier errors allow.
enum class ChangeReason {
  none,
  further,        ///< the parameter has changed once more
  back,           ///< it is at its baseline again
  not_confirmed,  ///< the windows behind the change do not show it
  of_all          ///< every stiffness changed alike, which is another record
};

/// The record of one change. ChangeBook computes it; everything that shows the change shows this.
struct ChangeRecord {
  /// `parameter` of a change that all frames have in common.
  static constexpr int kEverything = -1;

  std::int64_t id = 0;  ///< constant from the first announcement to the end; from 1; 0: no record
  ChangeState state = ChangeState::none;
  int parameter = 0;
  /// While the state is changing, only the sign of the ratio and the times are valid.
  Change change;

  bool measured() const { return state == ChangeState::measured; }
};

enum class AlarmState { cleared, raised, changed };

/// A transition of a record: it begins, its number changes, or it ends.
struct Alarm {
  std::int64_t id;  ///< ChangeRecord::id
  AlarmState state;
  int parameter;  ///< ChangeRecord::parameter
  /// ChangeRecord::change; for a cleared alarm the last published one.
  Change change;
  Time found;            ///< end of the window that shows it
  bool measured = true;  ///< false: the record is in state changing; `change` has no number
  ChangeReason reason = ChangeReason::none;
};

}  // namespace framewatch::estimator
