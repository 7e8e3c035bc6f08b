#pragma once

#include <vector>

#include "estimator/motion/sample.h"
#include "estimator/shaking/story_response.h"
#include "estimator/watch/change_point.h"
#include "estimator/watch/change_record.h"

namespace framewatch::estimator {

struct ShakingOptions {
  /// The base (all axes, where it has no sensor) moves strongly above this distance from its mean.
  double trigger_mps2 = 0.1;
  double quiet_s = 20;  ///< below it for so long: the strong motion has ended
};

/// What the stiffness before the shaking was taken from.
enum class BeforeFrom { none, baseline, windows_before, first_windows };

/// A stiffness before, during and after strong motion; count 0: not known.
struct ShakenStiffness {
  WindowMean before, during, after;
  BeforeFrom before_from = BeforeFrom::none;
  bool free = false;      ///< `after` is of windows behind the strong motion; else of its last ones
  bool watched = false;   ///< changes are looked for against a baseline: only a record is a change
  ChangeRecord record{};  ///< of its change; without an id: there is none

  /// Whether there is a size of a change.
  bool known() const {
    return record.id != 0 ? record.measured() : before.count > 0 && after.count > 0;
  }
  /// The record's where there is one with a number: whoever shows a change shows that.
  double ratio() const {
    return record.measured() ? record.change.ratio : after.value / before.value - 1;
  }
  double std_error() const;  ///< of ratio()
};

/// Why nothing is known of a time.
enum class UnheardWhy {
  no_samples,     ///< the program ran and no sample came
  restart,        ///< it was started anew; what it had heard before is known from raw samples
  restart_no_raw  ///< it was started anew, and no raw samples of before were there to read
};

/// A time of which no sample is known.
struct Unheard {
  Time from{}, to{};        ///< the last instant before it, the first one behind it
  bool from_known = false;  ///< false: nothing was heard before `to`
  UnheardWhy why = UnheardWhy::no_samples;

  template <typename Archive>
  void archive(Archive& a) {
    a(from, to, from_known);
    a.within(why, 0, static_cast<double>(UnheardWhy::restart_no_raw));
  }
};

/// One strong motion, as the sensors and the windows showed it.
struct Shaking {
  Time start{}, end{};  ///< first and last instant above the trigger
  Time found{};         ///< when it was clear that it had ended
  PeakResponse peak;
  std::vector<ShakenStiffness> stiffness;  ///< of the stiffness half of theta
  double gap_nrmse = 0;                    ///< the largest meanwhile; NaN: not simulated
  /// In order of time: those within it, and those that ended less than ShakingOptions::quiet_s
  /// before `start`, because it may have begun in them. Its peaks are those of the rest.
  std::vector<Unheard> unheard = {};
  double drift_settles_s = 0;  ///< drifts are not known for so long after each of them
};

}  // namespace framewatch::estimator
