#include "estimator/gap/gap_alarm.h"

#include <algorithm>
#include <cmath>

namespace framewatch::estimator {
namespace {

constexpr double kOver = 0.5;  ///< of the ratio that raises: below it a gap is over

double excess(double nrmse, double floor) {
  return std::sqrt(std::max(0.0, nrmse * nrmse - floor * floor));
}

int worst_axis(const GapWindow& w) {
  int worst = -1;
  double most = 0;
  for (std::size_t a = 0; a < w.axis_nrmse.size(); ++a) {
    const double e = excess(w.axis_nrmse[a], w.axis_floor[a]);
    if (!(e > most)) continue;
    most = e;
    worst = static_cast<int>(a);
  }
  return worst;
}

}  // namespace

std::optional<Time> GapAlarm::showing() const {
  return !raised_ && seconds_ > 0 ? std::optional(shown_) : std::nullopt;
}

const GapNews* GapAlarm::push(const GapWindow& w) {
  if (!(w.floor < options_.raise_ratio)) return nullptr;
  const double now = excess(w.nrmse, w.floor);
  const bool otherwise = raised_ ? now < kOver * options_.raise_ratio : now > options_.raise_ratio;
  if (!otherwise) {
    seconds_ = 0;
    return nullptr;
  }
  if (seconds_++ == 0) since_ = w.start, shown_ = w.end;
  if (seconds_ < options_.lasting_s) return nullptr;
  seconds_ = 0;
  news_.found = w.end;
  news_.excess = now;
  if (raised_) {
    raised_ = false;
    news_.state = AlarmState::cleared;
    return &news_;
  }
  raised_ = true;
  news_.state = AlarmState::raised;
  news_.id = to_microseconds(w.end);
  news_.since = since_;
  news_.worst_axis = worst_axis(w);
  return &news_;
}

}  // namespace framewatch::estimator
