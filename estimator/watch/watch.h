#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "estimator/structure/parameter_table.h"
#include "estimator/watch/baseline.h"
#include "estimator/watch/change_detector.h"

namespace framewatch {

struct WatchOptions {
  double learn_s = 60;  ///< of windows a baseline takes, when none is given
  /// Smallest changes that matter, relative; 0: not watched.
  double smallest_k = 0.03, smallest_g = 0.2;
  double alarms_per_year = 1;  ///< false ones that are put up with, of the whole building
  /// Time a year in which the building moves enough for windows to have values.
  double shaking_hours_per_year = 10;
};

enum class AlarmState { cleared, raised, changed };

/// News of a parameter's alarm.
struct Alarm {
  std::int64_t id;  ///< the same from raised to cleared; from 1
  AlarmState state;
  int parameter;
  Change change;  ///< of a cleared one: what it last was
  Time found;     ///< end of the window that says so
};

/// Watches frame and panel stiffness for changes against a baseline, given or learned first, in the
/// windows of every length at once: short ones are quick, long ones see small changes.
class Watch {
 public:
  /// windows_s: lengths of the windows, WindowEstimate::window its index.
  Watch(const ParameterTable& table, const WatchOptions& options,
        const std::vector<double>& windows_s, std::optional<Baseline> baseline);

  /// What this window changes about alarms; valid until the next call.
  const std::vector<Alarm>& push(const WindowEstimate& estimate);

  /// Null while it is being learned.
  const Baseline* baseline() const { return baseline_ ? &*baseline_ : nullptr; }
  /// Of every detector's sums: false alarms come at most as often as the options ask for.
  double threshold() const { return threshold_; }

  template <typename Archive>
  void archive(Archive& a) {
    bool known = baseline_.has_value();
    a(known, learner_);
    if (known) {
      if (!baseline_) baseline_.emplace();
      a(*baseline_);
      if constexpr (Archive::kReading) begin();
    }
    a(detectors_, states_, last_id_);
  }

 private:
  struct State {
    std::int64_t id = 0;  ///< of its alarm; 0: none
    std::size_t detector = 0;
    Change told;

    template <typename Archive>
    void archive(Archive& a) {
      a(id, detector, told);
    }
  };
  void begin();
  void tell(int parameter, const WindowEstimate& estimate);

  WatchOptions options_;
  std::vector<Watched> watched_;  ///< theta order
  std::vector<double> windows_s_;
  double threshold_;
  BaselineLearner learner_;
  std::optional<Baseline> baseline_;
  std::vector<ChangeDetector> detectors_;
  std::vector<State> states_;
  std::vector<Alarm> news_;
  std::int64_t last_id_ = 0;
};

}  // namespace framewatch
