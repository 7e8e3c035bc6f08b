#pragma once

#include <framewatch/event_t.hpp>
#include <framewatch/temperature_t.hpp>

#include "daemon/monitor/event_report/event_report.h"
#include "estimator/gap/gap_monitor.h"
#include "estimator/identify/estimate/estimate.h"
#include "estimator/motion/sample.h"

namespace framewatch::daemon {

/// Receives what an Estimation takes in and finds, beside the messages that it publishes. Override
/// what you need; arguments are valid during the call.
class EstimationListener {
 public:
  virtual ~EstimationListener() = default;

  /// A sample, before the pipeline takes it.
  virtual void on_sample(const estimator::AccelSample& /*sample*/) {}
  virtual void on_temperature(const temperature_t& /*temperature*/) {}
  /// A calibrated instant.
  virtual void on_instant(const estimator::SampleSet& /*instant*/) {}
  /// An estimate of the main window, before it is published.
  virtual void on_estimate(const estimator::WindowEstimate& /*estimate*/) {}
  virtual void on_gap(const estimator::GapNews& /*news*/) {}
  /// An event, after it was published.
  virtual void on_event(const event_t& /*event*/) {}
  /// The report of a strong motion that has ended.
  virtual void on_shaken(const EventReport& /*report*/) {}
};

}  // namespace framewatch::daemon
