#pragma once

#include <cstdint>
#include <optional>

#include "estimator/gap/gap.h"
#include "estimator/watch/watch.h"

namespace framewatch::estimator {

/// A lasting gap between simulation and measurement begins or ends.
struct GapNews {
  std::int64_t id = 0;  ///< sensor time it was raised, microseconds; the same when it is cleared
  AlarmState state = AlarmState::raised;
  Time found, since;  ///< end and start of windows
  double excess = 0;  ///< sqrt(nrmse^2 - floor^2)
  int worst_axis = -1;
  /// Of a raised one: the stiffness that the windows since then show furthest, in standard errors,
  /// from the model's; -1: none is.
  int parameter = -1;
  double ratio = 0, std_error = 0;  ///< its change against the model, relative

  template <typename Archive>
  void archive(Archive& a) {
    a.within(id, -2 * a.kMaxCount, 2 * a.kMaxCount);
    a.within(state, 0, static_cast<double>(AlarmState::changed));
    a(found, since);
    a.finite(excess);
    a.within(worst_axis, -1, 1e6);
    a.within(parameter, -1, 1e6);
    a.finite(ratio, std_error);
  }
};

/// Decides when a gap lasts. Windows in which noise alone would be as large as a gap are ignored.
class GapAlarm {
 public:
  explicit GapAlarm(const GapOptions& options) : options_(options) {}

  /// One window per second. Null when nothing begins or ends; valid until the next call.
  const GapNews* push(const GapWindow& window);
  bool raised() const { return raised_; }
  /// End of the first of the windows that show a gap not yet raised; none while they show none.
  std::optional<Time> showing() const;

  template <typename Archive>
  void archive(Archive& a) {
    a.within(seconds_, 0, a.kMaxCount);
    a(raised_, since_, shown_, news_);
  }

 private:
  GapOptions options_;
  bool raised_ = false;
  int seconds_ = 0;         ///< for which the windows have contradicted the alarm
  Time since_{}, shown_{};  ///< start and end of the first of them
  GapNews news_;
};

}  // namespace framewatch::estimator
