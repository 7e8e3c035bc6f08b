#pragma once

#include <algorithm>

namespace framewatch::drivers {

/// Follows a clock model without its jumps. Whoever takes equal steps must not see one when the
/// model's offset is corrected: times run faster or slower than the model by 0.2 % at most.
class SlewLimiter {
 public:
  /// The next time is taken from the model as it is.
  void reset() { started_ = false; }

  /// Host time to give out for `device_us`; the model says `model_us` and runs at `rate`. All
  /// microseconds.
  double follow(double device_us, double model_us, double rate) {
    const double step_us = device_us - device_us_;
    const double free_us = kSlew * std::max(0.0, step_us);
    const double on_us = host_us_ + step_us * rate;
    const double time_us =
        started_ ? on_us + std::clamp(model_us - on_us, -free_us, free_us) : model_us;
    if (!started_ || step_us > 0) {
      started_ = true;
      device_us_ = device_us;
      host_us_ = time_us;
    }
    return time_us;
  }

  template <typename Archive>
  void archive(Archive& a) {
    a(started_, device_us_, host_us_);
  }

 private:
  static constexpr double kSlew = 0.002;

  bool started_ = false;
  double device_us_ = 0, host_us_ = 0;  ///< of the newest time given out
};

}  // namespace framewatch::drivers
