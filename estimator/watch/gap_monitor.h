#pragma once

#include <optional>
#include <vector>

#include "estimator/motion/motion_filter.h"
#include "estimator/options.h"
#include "estimator/structure/sensors.h"
#include "estimator/watch/channel_correction.h"
#include "estimator/watch/gap_alarm.h"
#include "estimator/watch/gap_meter.h"
#include "estimator/watch/noise_path.h"
#include "estimator/watch/running_model.h"

namespace framewatch {

/// Simulates the current model under the measured base motion all the time and says how far it is
/// from what the channels above measure. docs/gap.md, docs/equations.md (42) to (44). Base axes of
/// one direction are averaged: a turning base is a gap.
class GapMonitor {
 public:
  /// axes: with what is left of their delays (Pipeline::axes). model: none, it is learned.
  GapMonitor(const Structure& structure, const std::vector<SensorAxis>& axes,
             const EstimatorOptions& estimation, const GapOptions& options,
             const std::optional<GapModel>& model);

  /// From now on this is the model; begins anew. Takes time and memory of its own.
  void adopt(const GapModel& model);
  bool has_model() const { return current_.has_value(); }

  /// Of the main window: what a model is learned from. believed: values of what windows do not
  /// show, theta order.
  void learn(const WindowEstimate& estimate, const Eigen::VectorXd& believed);
  /// One calibrated instant; noise_density of each axis, m/s^2/sqrt(Hz), or none. Once a second,
  /// while there is something to compare, the gap of the last window; valid until the next call.
  const GapWindow* push(const SampleSet& set, const std::vector<double>& noise_density);
  /// What the last push() has news of, or null.
  const GapNews* news() const { return news_; }

  template <typename Archive>
  void archive(Archive& a) {
    bool modelled = has_model();
    std::vector<double> theta;
    if (modelled) theta.assign(theta_.begin(), theta_.end());
    a(learner_, alarm_, modelled, theta);
    if constexpr (Archive::kReading) {
      if (modelled && !has_model() && theta.size() == static_cast<std::size_t>(table_.size()))
        adopt({Eigen::Map<const Eigen::VectorXd>(theta.data(), table_.size()), {}});
    }
    if (modelled && has_model()) a(*current_);
  }

 private:
  /// One model and everything that is of it alone.
  struct Current {
    Current(const GapMonitor& monitor, const GapModel& model);

    ChannelCorrection correction;
    MotionFilter filter;
    RunningModel running;
    NoisePath noise;
    GapMeter meter;
    SensorClock::duration delay;  ///< of what is compared
    std::vector<double> held;     ///< ring of instants x axes: filtered, NaN where not valid
    int newest = 0;
    double settled_s = 0;
    std::int64_t expected_index = -1;

    template <typename Archive>
    void archive(Archive& a) {
      a(correction, filter, running, noise, meter, held, newest, settled_s, expected_index);
    }
  };
  /// Mean over the base axes, x and y.
  Eigen::Vector2d base_mean(const std::vector<double>& of_axes) const;
  void hold(Current& c);
  void compare(Current& c) const;
  void noise_variances(const Current& c, const std::vector<double>& noise_density);

  Structure structure_;
  ParameterTable table_;
  std::vector<SensorAxis> axes_;
  std::vector<int> dof_;  ///< of each axis; -1: base
  double rate_hz_, high_pass_hz_;
  GapOptions options_;
  BaselineLearner learner_;
  Eigen::VectorXd theta_;
  std::optional<Current> current_;
  GapAlarm alarm_;
  std::vector<double> noise_variance_;
  const GapNews* news_ = nullptr;
};

}  // namespace framewatch
