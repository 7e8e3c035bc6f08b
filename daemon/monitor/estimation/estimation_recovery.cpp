#include <utility>

#include "daemon/monitor/estimation/estimation.h"
#include "daemon/monitor/estimation/estimation_events.h"

namespace framewatch::daemon {

void Estimation::follow_recovery(const estimator::WindowEstimate& estimate) {
  const bool of_weak_motion = static_cast<std::size_t>(estimate.window) ==
                              window_lengths_s(config_.pipeline.options).size();
  recovery_->push(estimate, of_weak_motion, *watch_, strong_);
  const estimator::ParameterTable table = pipeline_.parameters();
  for (const int p : recovery_->due()) {
    const event_t* const raised = raised_.find("stiffness_change", table[p].name);
    if (raised != nullptr && is_recovering(*raised, p))
      announce(with_recovery(renewed(*raised, estimate.end), p));
  }
}

bool Estimation::is_recovering(const event_t& event, int parameter) const {
  const estimator::Recovery* recovery = recovery_->of(parameter);
  return recovery != nullptr && recovery->is_of(estimator::from_microseconds(event.since_us));
}

event_t Estimation::with_recovery(event_t event, int parameter) const {
  if (!is_recovering(event, parameter)) return event;
  return recovering(std::move(event), recovery_->of(parameter)->law());
}

}  // namespace framewatch::daemon
