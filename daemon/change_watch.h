#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <framewatch/event_t.hpp>
#include <framewatch/parameter_table_t.hpp>
#include <framewatch/window_estimate_t.hpp>

namespace framewatch::daemon {

/// Whether stiffnesses differ from what they were: one baseline per parameter, the mean over its
/// first kBaseline_s of values, and an event when a change is larger than kSmallest_ratio and
/// kSigma standard errors in kInARow windows, one after the other. Damping scatters too much for
/// that. Sensor time only.
class ChangeWatch {
 public:
  static constexpr double kBaseline_s = 8;
  static constexpr double kSmallest_ratio = 0.05;
  static constexpr double kSigma = 5;
  static constexpr int kInARow = 3;
  /// A raised change that moved this far is told again, and one whose error fell to this part.
  static constexpr double kNews_ratio = 0.02, kSurer_ratio = 0.5;

  /// window_s: of the estimates that observe() gets. first_id: of the events.
  ChangeWatch(const parameter_table_t& table, double window_s, std::int64_t first_id);

  /// Events that this estimate gives reason for.
  std::vector<event_t> observe(const window_estimate_t& estimate);
  /// Forgets the baselines and clears nothing: the next kBaseline_s are the new ones.
  void renew();

  /// NaN while it is not known.
  const std::vector<double>& baseline() const { return baseline_; }

 private:
  struct Watched {
    double sum = 0, squares = 0, error = 0;
    int count = 0, beyond = 0, within = 0;
    std::int64_t first_us = 0, since_us = 0, id = 0;
    double told = 0, told_error = 0;  ///< of the last event
  };
  event_t event(std::size_t p, int state, std::int64_t time_us, double change, double error) const;

  parameter_table_t table_;
  double window_s_;
  std::int64_t next_id_;
  std::vector<double> baseline_;
  std::vector<Watched> watched_;
};

}  // namespace framewatch::daemon
