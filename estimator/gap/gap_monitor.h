// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include "estimator/gap/axis_correction.h"
#include "estimator/gap/base_response.h"
#include "estimator/gap/channel_check.h"
#include "estimator/gap/gap.h"
#include "estimator/gap/measured_inputs.h"
#include "estimator/gap/model_learner.h"
#include "estimator/gap/running_model.h"
#include "estimator/motion/drift_controlled_integrator.h"
#include "estimator/setup/pipeline_config.h"
#include "estimator/structure/group_design.h"
#include "estimator/structure/sensors.h"
#include "estimator/watch/baseline.h"

namespace framewatch::estimator {

/// Continuously simulates the current model under the measured inputs and returns the gap to the
/// motion measured above. docs/gap.md, docs/equations.md (45), (46). measured_inputs() drive the
/// model: a motion of the base that no axis measures appears as a gap.
class GapMonitor {
 public:
  /// axes: with the remaining fractions of their delays (Pipeline::axes). model: nullopt to learn
  /// it; stories of a group then keep the design's shares.
  GapMonitor(const PipelineConfig& config, const std::vector<SensorAxis>& axes,
             const GapOptions& options, const std::optional<GapModel>& model);

  /// Replaces the model and restarts. Not bounded in time; allocates memory.
  void adopt(const GapModel& model);
  bool has_model() const { return current_.has_value(); }

  /// Takes an estimate of the main window, to learn a model and to find the stiffness that causes a
  /// gap. believed: parameters for those that windows do not show, theta order.
  void learn(const WindowEstimate& estimate, const Eigen::VectorXd& believed);
  /// Takes one calibrated instant. noise_density: of each axis, m/s^2/sqrt(Hz), or empty. Returns
  /// the gap of the last window once a second while there is one to compare, else null; valid until
  /// the next call.
  const GapWindow* push(const SampleSet& set, const std::vector<double>& noise_density);
  /// Returns the alarm that began or ended at the last push(), or null.
  const GapNews* news() const { return news_; }
  /// Returns the doubts about channels that began, changed or ended at the last push().
  const std::vector<ChannelNews>& channel_news() const { return channel_news_; }
  /// Returns true while a channel seems to misread and is not in doubt yet: windows that end now
  /// may be wrong.
  bool has_candidate() const { return check_.has_candidate(); }
  /// Returns by axis: 1 if its channel is in doubt. Such a channel does not count in the gap.
  const std::vector<std::uint8_t>& doubted() const { return check_.doubted(); }

  void archive(auto& a) {
    bool modelled = has_model();
    std::vector<double> theta;
    if (modelled) theta.assign(theta_.begin(), theta_.end());
    a(learner_, alarm_, since_gap_, named_, driving_, modelled);
    a.any_size(theta);
    if (a.kReading) {
      take_inputs();
      for (const double value : theta)
        if (!(value > 0 && value < a.kMax)) return a.refuse();
      if (modelled && !has_model() && theta.size() == static_cast<std::size_t>(table_.size()))
        adopt(model_of(Eigen::Map<const Eigen::VectorXd>(theta.data(), table_.size())));
    }
    a(theta_error_);
    if (modelled && has_model()) a(*current_);
    if (a.since(18)) a(check_);
  }

 private:
  /// One model and everything that depends on it.
  struct Current {
    Current(const GapMonitor& monitor, const GapModel& model);

    AxisCorrection correction;
    DriftControlledIntegrator filter;
    RunningModel running;
    std::optional<BaseResponse> base;  ///< if the model is linear
    NoisePath noise;
    GapMeter meter;
    SensorClock::duration delay;  ///< of the compared instant
    std::vector<double> held;     ///< ring of instants x axes: filtered, NaN where not valid
    int newest = 0;
    double settled_s = 0;
    std::int64_t expected_index = -1;

    void archive(auto& a) {
      a(correction, filter, running, noise, meter, held);
      a.within(newest, 0, RunningModel::kDelay);  // of kDelay + 1 instants
      a.finite(settled_s);
      a.within(expected_index, -1, a.kMaxCount);
    }
  };
  /// Returns the delay of every input's samples beyond that of the axes, averaged over its axes;
  /// instants.
  Eigen::VectorXd late(const std::vector<double>& rest) const;
  /// Recomputes the inputs from the present axes and restarts the running model.
  void take_inputs();
  void hold(Current& c);
  void compare(Current& c, bool settled);
  void noise_variances(const Current& c, const std::vector<double>& noise_density);
  /// Adds the parameter that has changed most significantly to the news.
  void name_place(GapNews& news) const;

  /// Returns the model of identified parameters.
  GapModel model_of(const Eigen::VectorXd& theta) const;

  Structure structure_;
  ParameterTable stories_;  ///< of the running model
  ParameterTable table_;    ///< of the identified parameters
  GroupDesign design_;
  std::vector<SensorAxis> axes_;
  DrivingAxes driving_;
  MeasuredInputs inputs_;  ///< of the present axes
  /// Motion that each axis above the base measures along x or y: degrees of freedom with weights.
  std::vector<SeenMotion> seen_;
  double rate_hz_, high_pass_hz_;
  GapOptions options_;
  ModelLearner learner_;
  GapModel model_;                   ///< valid while current_ exists
  Eigen::VectorXd theta_;            ///< in the order of table_
  std::vector<double> theta_error_;  ///< standard errors of learned parameters; 0: given
  std::vector<char> has_law_;        ///< by parameter; 1: an effect of the model acts there
  BaselineLearner since_gap_;        ///< windows since a gap appeared
  GapNews named_;                    ///< the last news
  std::optional<Current> current_;
  GapAlarm alarm_;
  ChannelCheck check_;
  std::vector<ChannelNews> channel_news_;
  std::vector<double> read_, expected_;  ///< by axis: what check_ compares now
  Eigen::VectorXd driven_;               ///< the present inputs
  std::vector<double> noise_variance_;
  const GapNews* news_ = nullptr;
};

}  // namespace framewatch::estimator
