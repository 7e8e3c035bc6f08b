#pragma once

#include <cstdint>

#include "estimator/motion/sample.h"

namespace framewatch::estimator {

/// How large a change of a parameter is.
struct Change {
  double ratio = 0;  ///< of the baseline: -0.05 has lost a twentieth
  double std_error = 0;
  Time since{};               ///< the most likely instant of the change
  Time earliest{}, latest{};  ///< between which it lies

  template <typename Archive>
  void archive(Archive& a) {
    a.finite(ratio, std_error);
    a(since, earliest, latest);
  }
};

/// How far a record of a change has got. changing: the parameter changes or has changed, and how
/// much is not known well enough to be worth a number. measured: ratio and std_error hold.
enum class ChangeState { none, changing, measured };

/// Why a record ended, or why its number is another one than its earlier errors allow. further: the
/// parameter has changed once more; back: it is at its baseline again; not_confirmed: the windows
/// behind the change do not show it; of_all: every stiffness changed alike, which is another
/// record.
enum class ChangeReason { none, further, back, not_confirmed, of_all };

/// The record of one change, computed in one place (ChangeBook): whoever shows the change shows
/// this.
struct ChangeRecord {
  /// `parameter` of a change that all frames have in common.
  static constexpr int kEverything = -1;

  std::int64_t id = 0;  ///< the same from the first announcement to the end; from 1; 0: no record
  ChangeState state = ChangeState::none;
  int parameter = 0;
  /// While the state is changing, only the sign of the ratio and the times mean something.
  Change change;

  bool measured() const { return state == ChangeState::measured; }
};

enum class AlarmState { cleared, raised, changed };

/// A transition of a record: it begins, has another number, or ends.
struct Alarm {
  std::int64_t id;  ///< ChangeRecord::id
  AlarmState state;
  int parameter;  ///< ChangeRecord::parameter
  /// The record's; of a cleared alarm the last one that was told.
  Change change;
  Time found;            ///< end of the window that shows it
  bool measured = true;  ///< false: the record is in state changing, its change is no number
  ChangeReason reason = ChangeReason::none;
};

}  // namespace framewatch::estimator
