// SPDX-License-Identifier: MIT
#include "estimator/gap/gap_monitor.h"

#include <algorithm>
#include <cmath>

#include "estimator/identify/elements/story_design.h"
#include "estimator/numeric/nan.h"
#include "estimator/structure/story_groups.h"

namespace framewatch::estimator {
namespace {

constexpr int kHeld = RunningModel::kDelay + 1;
/// Share of the settling time from which channels are checked: what remains of the start is then
/// small beside a fault, and counts as usual.
constexpr double kCheckFrom = 0.5;

std::vector<DerivativeTriple> triples(const AxisCorrection& correction, double rate_hz) {
  std::vector<DerivativeTriple> out;
  for (const double rest : correction.rest()) out.push_back(matched_triple(rate_hz, rest));
  return out;
}

std::vector<char> compared(const std::vector<SeenMotion>& seen) {
  std::vector<char> out;
  for (const auto& of_axis : seen) out.push_back(!of_axis.empty());
  return out;
}

BendingStiffness bending_of(const std::vector<Effect>& effects) {
  BendingStiffness out{};
  for (const Effect& e : effects)
    if (e.kind == EffectKind::frame_bending)
      out.base_nmprad[e.place.direction == Direction::x ? 0 : 1] = e.value("kr_nmprad");
  return out;
}

}  // namespace

GapMonitor::Current::Current(const GapMonitor& m, const GapModel& model)
    : correction(m.axes_, model.effects, m.rate_hz_),
      filter(triples(correction, m.rate_hz_), HighPass(m.high_pass_hz_, m.rate_hz_)),
      running(m.structure_, m.stories_, model, m.inputs_.inputs, m.rate_hz_, m.high_pass_hz_,
              m.late(correction.rest())),
      noise(m.structure_, m.stories_, model, m.inputs_, m.rate_hz_, m.high_pass_hz_),
      meter(compared(m.seen_), m.rate_hz_, static_cast<int>(m.options_.window_s)),
      delay(std::llround(
          1e6 / m.rate_hz_ *
          (matched_triple(m.rate_hz_).delay + RunningModel::kDelay + correction.held_back()))),
      held(m.axes_.size() * kHeld, kNaN) {
  if (model.effects.empty())
    base.emplace(m.structure_, m.stories_, model.theta, m.inputs_, m.seen_, m.rate_hz_);
}

GapMonitor::GapMonitor(const PipelineConfig& config, const std::vector<SensorAxis>& axes,
                       const GapOptions& options, const std::optional<GapModel>& model)
    : structure_(config.structure),
      stories_(structure_),
      table_(config.parameters()),
      design_(story_design(config)),
      axes_(axes),
      driving_(axes_, config.options.rate_hz),
      inputs_(measured_inputs(structure_, axes_, driving_.present())),
      rate_hz_(config.options.rate_hz),
      high_pass_hz_(config.options.high_pass_hz),
      options_(options),
      learner_(table_.size(), table_.elements(), options.learn_s),
      theta_error_(static_cast<std::size_t>(table_.size())),
      has_law_(static_cast<std::size_t>(table_.size())),
      since_gap_(BaselineLearner::of_any_windows(theta_error_.size())),
      alarm_(options),
      check_(structure_, axes, rate_hz_),
      read_(axes.size()),
      expected_(axes.size()),
      driven_(inputs_.from_axes.rows()),
      noise_variance_(axes.size()) {
  for (const SensorAxis& axis : axes) {
    seen_.emplace_back();
    if (axis.story == 0 || !axis.horizontal()) continue;
    const std::vector<double> weights = frame_weights(structure_, axis);
    for (int f = 0; f < structure_.frames(); ++f)
      if (const double w = weights[static_cast<std::size_t>(f)]; w != 0)
        seen_.back().emplace_back(structure_.dof(axis.story, f), w);
  }
  if (model) adopt(*model);
}

GapModel GapMonitor::model_of(const Eigen::VectorXd& theta) const {
  if (!table_.grouped()) return {theta, {}};
  GapModel model{story_parameters(structure_, table_, design_, theta), {}};
  for (int p = 0; p < table_.size(); ++p) {
    if (table_[p].kind != ParameterKind::bending_stiffness) continue;
    EffectPlace place;
    place.kind = PlaceKind::building;
    place.direction = table_[p].direction;
    model.effects.push_back(make_effect(EffectKind::frame_bending, place));
    model.effects.back().set("kr_nmprad", theta[p]);
  }
  return model;
}

void GapMonitor::adopt(const GapModel& model) {
  theta_ = table_.grouped()
               ? group_parameters(structure_, table_, {model.theta, bending_of(model.effects)})
               : model.theta;
  std::fill(theta_error_.begin(), theta_error_.end(), 0);
  std::fill(has_law_.begin(), has_law_.end(), char{0});
  for (const Effect& e : model.effects) {
    if (e.place.kind == PlaceKind::frame)
      if (const int p = table_.frame_stiffness(e.place.story, e.place.frame); p >= 0)
        has_law_[static_cast<std::size_t>(p)] = 1;
    if (e.place.kind == PlaceKind::panel && !table_.grouped())
      has_law_[static_cast<std::size_t>(table_.panel_stiffness(e.place.story, e.place.panel))] = 1;
  }
  model_ = model;
  current_.emplace(*this, model_);
  check_.forget();
}

void GapMonitor::take_inputs() {
  inputs_ = measured_inputs(structure_, axes_, driving_.present());
  driven_.resize(inputs_.from_axes.rows());
  if (current_) current_.emplace(*this, model_);
}

void GapMonitor::learn(const WindowEstimate& estimate, const Eigen::VectorXd& believed) {
  if (current_) {
    const auto showing = alarm_.showing();
    if (!showing)
      since_gap_ = BaselineLearner::of_any_windows(theta_error_.size());
    else if (estimate.start >= *showing)
      (void)since_gap_.push(estimate);
    return;
  }
  if (!learner_.push(estimate)) return;
  Eigen::VectorXd theta = believed;
  std::vector<double> error(theta_error_.size(), kNaN);
  const std::vector<WindowMean> learned = learner_.learned();
  for (std::size_t p = 0; p < learned.size(); ++p) {
    if (!(learned[p].value > 0)) continue;
    theta[static_cast<Eigen::Index>(p)] = learned[p].value;
    error[p] = learned[p].std_error;
  }
  adopt(model_of(theta));
  theta_error_ = error;
}

void GapMonitor::name_place(GapNews& news) const {
  constexpr double kErrors = 3, kMin = 0.03;
  news.parameter = -1;
  const Baseline seen = since_gap_.so_far();
  double most = kErrors;
  for (int p = 0; p < table_.elements(); ++p) {
    const auto at = static_cast<std::size_t>(p);
    if (!seen.knows(at) || has_law_[at]) continue;
    const double ratio = seen.value[at] / theta_[p] - 1;
    const double error = std::hypot(seen.std_error[at], theta_error_[at]) / theta_[p];
    if (std::abs(ratio) < kMin || !(std::abs(ratio) > most * error)) continue;
    most = std::abs(ratio) / error;
    news.parameter = p;
    news.ratio = ratio;
    news.std_error = error;
  }
}

Eigen::VectorXd GapMonitor::late(const std::vector<double>& rest) const {
  const Eigen::MatrixXd share = inputs_.from_axes.cwiseAbs();
  const Eigen::Map<const Eigen::VectorXd> of_axes(rest.data(), share.cols());
  return (share * of_axes).cwiseQuotient(share.rowwise().sum());
}

void GapMonitor::hold(Current& c) {
  c.newest = c.newest == 0 ? kHeld - 1 : c.newest - 1;
  for (std::size_t a = 0; a < axes_.size(); ++a)
    c.held[static_cast<std::size_t>(c.newest) * axes_.size() + a] =
        c.filter.valid(static_cast<int>(a)) ? c.filter.value(static_cast<int>(a)) : kNaN;
}

void GapMonitor::compare(Current& c, bool settled) {
  const int then = (c.newest + RunningModel::kDelay) % kHeld;
  for (std::size_t a = 0; a < axes_.size(); ++a) {
    read_[a] = c.held[static_cast<std::size_t>(then) * axes_.size() + a];
    expected_[a] = seen_[a].empty() ? kNaN : 0;
    for (const auto& [dof, weight] : seen_[a]) expected_[a] += weight * c.running.accel_abs(dof);
    if (settled && std::isfinite(read_[a]) && !seen_[a].empty() && doubted()[a] == 0)
      c.meter.add(a, read_[a], expected_[a]);
  }
}

void GapMonitor::noise_variances(const Current& c, const std::vector<double>& noise_density) {
  const auto variance = [&](std::size_t a) {
    return c.noise.known() && a < noise_density.size()
               ? noise_density[a] * noise_density[a] * rate_hz_ / 2
               : kNaN;
  };
  Eigen::VectorXd driving = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(axes_.size()));
  for (const Eigen::Index a : inputs_.used) driving[a] = variance(static_cast<std::size_t>(a));
  for (std::size_t a = 0; a < axes_.size(); ++a) {
    noise_variance_[a] = variance(a) * c.noise.own();
    for (const auto& [dof, weight] : seen_[a])
      noise_variance_[a] += std::abs(weight) * c.noise.inputs().row(dof).dot(driving);
  }
}

const GapWindow* GapMonitor::push(const SampleSet& set, const std::vector<double>& noise_density) {
  news_ = nullptr;
  channel_news_.clear();
  if (driving_.push(set.accel)) take_inputs();
  if (!current_) return nullptr;
  Current& c = *current_;
  const bool interrupted = set.index != c.expected_index;
  c.expected_index = set.index + 1;
  if (interrupted) {
    c.filter.reset();
    c.settled_s = 0;
  }
  const std::vector<double>& accel = c.correction.apply(set.accel);
  c.filter.push(accel);
  hold(c);
  c.noise.advance();
  driven_.setZero();
  for (const Eigen::Index a : inputs_.used)
    driven_ += inputs_.from_axes.col(a) * accel[static_cast<std::size_t>(a)];
  if (!driven_.allFinite()) {
    c.settled_s = 0;
    return nullptr;
  }
  if (c.settled_s == 0) {
    c.running.restart();
    c.meter.restart();
    check_.restart();
  }
  c.running.push(driven_);
  c.settled_s += 1 / rate_hz_;
  if (c.settled_s < kCheckFrom * c.running.settle_s()) return nullptr;
  const bool settled = c.settled_s >= c.running.settle_s();
  compare(c, settled);
  if (settled ? c.meter.ends_second() : check_.ends_second()) noise_variances(c, noise_density);
  const double start = c.running.remains(c.settled_s - ChannelCheck::kWindow_s);
  channel_news_ =
      check_.push(set.time - c.delay,
                  {read_, expected_, c.base ? &*c.base : nullptr, start * start}, noise_variance_);
  if (!settled) return nullptr;
  if (!channel_news_.empty()) c.meter.restart();
  if (!c.meter.close(set.time - c.delay, noise_variance_)) return nullptr;
  if (check_.base_doubted()) return &c.meter.gap();
  news_ = alarm_.push(c.meter.gap());
  if (news_ == nullptr) return &c.meter.gap();
  const GapNews before = named_;
  named_ = *news_;
  if (named_.state == AlarmState::raised)
    name_place(named_);
  else if (before.id == named_.id)
    named_.parameter = before.parameter;
  news_ = &named_;
  return &c.meter.gap();
}

}  // namespace framewatch::estimator
