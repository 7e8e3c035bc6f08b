// SPDX-License-Identifier: MIT
#include "estimator/identify/groups/group_tuning.h"

#include <algorithm>
#include <cmath>

#include "estimator/identify/elements/deformations.h"
#include "estimator/identify/noise/floor_noise.h"
#include "estimator/motion/derivative_triple.h"
#include "estimator/numeric/kernels.h"

namespace framewatch::estimator {
namespace {

/// Highest corner as a share of the sampling rate: the derivative filters are accurate up to there.
constexpr double kHighestCorner = 0.2;
/// Corner over a floor's frequency with its neighbors held, for shear buildings and for buildings
/// that bend. Found by measurement (docs/partial.md).
constexpr double kShearCorner = 0.7, kBendingCorner = 0.85;
constexpr double kDecay = 3;        // periods of the high-pass in which it decays
constexpr double kForgotten = 4.6;  // decay of inner modes to a hundredth
constexpr int kImpulseRows = 128;   // instants of an impulse pushed in one step
/// Weights of parameter changes. A change of this size is as bad as a filter's corner that is off
/// by a tenth.
constexpr double kStiffnessWeight = 2, kDampingWeight = 1;

std::size_t count_of(int count) {
  return static_cast<std::size_t>(count);
}

}  // namespace

FloorRows group_rows(const EstimatorOptions& o, const GroupDesign& design,
                     const GroupEquations& equations, int unknowns) {
  const bool bends = design.bending_nmprad.any();
  const double ratio = o.corner_ratio * (bends ? kBendingCorner : kShearCorner);
  const int stride = padded(unknowns + 1);
  FloorRows out;
  out.rows = equations.rows;
  for (const double own_hz : equations.frequency_hz) {
    const double hz =
        std::max(std::min(ratio * own_hz, kHighestCorner * o.rate_hz), o.high_pass_hz);
    const OscillatorSection section(hz, o.filter_damping, o.rate_hz);
    out.frequency_hz.push_back(hz);
    out.gain.push_back(section.gain);
    out.a1.push_back(section.a1);
    out.a2.push_back(section.a2);
  }
  out.beta.assign(count_of(out.rows * stride), 0.0);
  for (int r = 0; r < out.rows; ++r)
    for (int p = 0; p <= unknowns; ++p) out.beta[count_of(r * stride + p)] = 1;
  return out;
}

GroupTuning::GroupTuning(const PipelineConfig& config, const EstimatorOptions& options,
                         const ParameterTable& table, const FloorLayout& layout,
                         const GroupDesign& design, const DerivativeTriple& triple,
                         const HighPass& high_pass)
    : config_(&config),
      options_(&options),
      layout_(&layout),
      high_pass_poles_{high_pass.a1, high_pass.a2},
      table_(table),
      configured_(design),
      design_(design),
      ratios_{group_parameters(config.structure, table, design),
              std::vector<double>(count_of(table.size()), 0.0)},
      designed_(ratios_.theta),
      theta0_(ratios_.theta),
      noise_density_(noise_densities(config.axes)),
      present_(identifying(config.axes)),
      perturbed_(layout) {
  const EstimatorOptions& o = options;
  const auto length = static_cast<std::size_t>(
      o.rate_hz * (kDecay / o.high_pass_hz + std::max(o.settle_s, kLongestSettle_s)));
  for (const std::vector<double>* taps :
       {&triple.value, &triple.first, &triple.second, &triple.held_first, &triple.held_second})
    impulse_.push_back(impulse_response(*taps, high_pass, length));
  set_axes(present_, ratios_);
  tune(0);
}

void GroupTuning::set_theta0(const Eigen::VectorXd& theta0,
                             const std::vector<double>& noise_density) {
  theta0_ = theta0;
  for (int p = 0; p < table_.size(); ++p)
    if (const int q = building_.same_as[count_of(p)]; q != p)
      theta0_[p] = designed_[p] * theta0_[q] / designed_[q];
  noise_density_ = noise_density;
  tuned_parts_ = 0;
}

void GroupTuning::set_axes(const std::vector<std::uint8_t>& present, const Known& ratios) {
  present_ = present;
  ratios_ = ratios;
  design_.theta = story_parameters(config_->structure, table_, configured_, ratios_.theta);
  designed_ = group_parameters(config_->structure, table_, design_);
  building_ = reduced_building(config_->structure, config_->axes, table_, design_, present);
  tuned_parts_ = 0;
}

int GroupTuning::impulse_rows() const {
  const EstimatorOptions& o = *options_;
  return std::min(settle_rows(0) + static_cast<int>(o.rate_hz * kDecay / o.high_pass_hz),
                  static_cast<int>(impulse_.front().size()));
}

int GroupTuning::parts_per_axis() const {
  return (impulse_rows() + kImpulseRows - 1) / kImpulseRows;
}

int GroupTuning::parts() const {
  if (tuned_parts_ == 0) return 2;  // at least; the equations determine the number
  return 2 + static_cast<int>(config_->axes.size()) * parts_per_axis();
}

void GroupTuning::tune(int part) {
  tuned_parts_ = part + 1;
  if (part == 0) return form();
  const int axes = static_cast<int>(config_->axes.size());
  if (part > axes * parts_per_axis()) return finish_noise();
  push_impulse((part - 1) / parts_per_axis(), (part - 1) % parts_per_axis());
}

/// Groups in series that merged have the flexibility of their sum. Their shares w of it are as well
/// known as their stiffnesses e were: the error of one is (1 - w) e together with the others' w e.
std::vector<double> GroupTuning::share_error() const {
  const std::vector<int>& first = building_.same_as;
  std::vector<double> flexibility(first.size(), 0.0), square(first.size(), 0.0), out(first.size());
  const auto share = [&](std::size_t p) { return 1 / designed_[static_cast<Eigen::Index>(p)]; };
  for (std::size_t p = 0; p < first.size(); ++p) flexibility[count_of(first[p])] += share(p);
  for (std::size_t p = 0; p < first.size(); ++p) {
    const double error = share(p) / flexibility[count_of(first[p])] * ratios_.std_error[p];
    square[count_of(first[p])] += error * error;
  }
  for (std::size_t p = 0; p < first.size(); ++p) {
    const double w = share(p) / flexibility[count_of(first[p])], e = ratios_.std_error[p];
    out[p] = std::sqrt(std::max(square[count_of(first[p])] + (1 - 2 * w) * e * e, 0.0));
    if (w == 1) out[p] = 0;  // the group is alone
  }
  return out;
}

void GroupTuning::form() {
  const Eigen::VectorXd x = theta0_.cwiseQuotient(designed_);
  equations_ = group_equations(building_, x, options_->rate_hz);
  rows_ = group_rows(*options_, design_, equations_, table_.size());
  rows_.same_as = building_.same_as;
  rows_.share_error = share_error();
  const int stride = padded(table_.size() + 1);
  plain_ = rows_;
  moments_.assign(count_of(rows_.rows) * count_of(stride) * count_of(stride), 0.0);
  motion_.assign(count_of(building_.measured) * AxisMotion::kSignals, 0.0);
  step_.assign(rows_.beta.size(), 0.0);
}

/// Adds the products of the rows for `part` of the impulse of an axis.
void GroupTuning::push_impulse(int axis, int part) {
  if (rows_.rows == 0 || present_[count_of(axis)] == 0) return;
  if (part == 0) chain_.start(equations_, table_.size());
  const double variance = noise_variance(noise_density_[count_of(axis)], options_->rate_hz);
  const int stride = padded(table_.size() + 1);
  const int end = std::min((part + 1) * kImpulseRows, impulse_rows());
  for (int t = part * kImpulseRows; t < end; ++t) {
    for (int c = 0; c < building_.measured; ++c)
      for (int signal = 0; signal < AxisMotion::kSignals; ++signal)
        motion_[count_of(c * AxisMotion::kSignals + signal)] =
            building_.from_axes(c, axis) * impulse_[count_of(signal)][count_of(t)];
    chain_.step(motion_.data(), plain_, step_.data());
    for (int r = 0; r < rows_.rows; ++r) {
      const double* h = &step_[count_of(r * stride)];
      double* moments = &moments_[count_of(r * stride) * count_of(stride)];
      for (int p = 0; p <= table_.size(); ++p, moments += stride) {
        const double scaled = variance * h[p];
        for (int q = 0; q < stride; ++q) moments[q] += scaled * h[q];
      }
    }
  }
}

void GroupTuning::finish_noise() {
  const int unknowns = table_.size();
  const int stride = padded(unknowns + 1);
  const auto u = count_of(unknowns);
  rows_.noise_energy.assign(u * u, 0.0);
  rows_.noise_right.assign(u, 0.0);
  rows_.noise_response = rows_.noise_residual = 0;
  for (int r = 0; r < rows_.rows; ++r) {
    const double* moments = &moments_[count_of(r * stride) * count_of(stride)];
    const auto at = [&](int p, int q) { return moments[count_of(p * stride + q)]; };
    double variance = at(unknowns, unknowns);  // variance of z - sum h
    for (int p = 0; p < unknowns; ++p) {
      variance -= 2 * at(p, unknowns);
      for (int q = 0; q < unknowns; ++q) variance += at(p, q);
    }
    const double weight = variance > 0 ? 1 / variance : 1;
    const double root = std::sqrt(weight);
    for (int p = 0; p <= unknowns; ++p) rows_.beta[count_of(r * stride + p)] = root;
    for (int p = 0; p < unknowns; ++p) {
      rows_.noise_right[count_of(p)] += weight * at(p, unknowns);
      for (int q = 0; q < unknowns; ++q)
        rows_.noise_energy[count_of(p) * u + count_of(q)] += weight * at(p, q);
    }
    rows_.noise_response += weight * at(unknowns, unknowns);
    rows_.noise_residual += weight * std::max(variance, 0.0);
  }
  for (int p = 0; p < unknowns; ++p)
    rows_.noise_diagonal.push_back(rows_.noise_energy[count_of(p) * u + count_of(p)]);
  rows_.noise_bias.assign(u * PerturbedDesigns::kCount, 0.0);
  kernels::in_use->multiply_add(rows_.noise_energy.data(), unknowns, unknowns, unknowns,
                                perturbed_.floor(0), rows_.noise_bias.data(),
                                PerturbedDesigns::kCount);
  pack_compensation(*layout_, 0, rows_, kCompensatedShare, rows_.noise_compensation);
}

void GroupTuning::restore() {
  const int parts_done = tuned_parts_;
  if (noise_density_.size() != config_->axes.size()) return;
  set_axes(present_, ratios_);
  for (int part = 0; part < parts_done && part < parts(); ++part) tune(part);
}

int GroupTuning::settle_rows(int least) const {
  const EstimatorOptions& o = *options_;
  double slowest_hz = kHighestCorner * o.rate_hz;
  for (const double hz : rows_.frequency_hz) slowest_hz = std::min(slowest_hz, hz);
  double settle_s = 3 / (o.filter_damping * 2 * M_PI * slowest_hz);
  for (const InnerChain& chain : equations_.chains)
    settle_s = std::max(settle_s, kForgotten / chain.slowest_radps);
  settle_s = std::min(settle_s, kLongestSettle_s);
  return std::max(least, static_cast<int>(std::ceil(settle_s * o.rate_hz)));
}

double GroupTuning::detuning(int, const Eigen::VectorXd& theta) {
  double worst = 0;
  for (int p = 0; p < table_.size(); ++p) {
    if (building_.same_as[count_of(p)] != p) continue;
    const double off = std::abs(std::log(theta[p] / theta0_[p]));
    const bool damping = building_.damping[count_of(p)] != 0;
    worst = std::max(worst, off * (damping ? kDampingWeight : kStiffnessWeight));
  }
  return worst;
}

std::unique_ptr<RowFilter> GroupTuning::make_filter(int settle) {
  return std::make_unique<GroupFilter>(*this, settle);
}

GroupFilter::GroupFilter(GroupTuning& tuning, int settle)
    : RowFilter(tuning.layout()),
      tuning_(&tuning),
      settle_(settle),
      past_(padded(tuning.layout().front(0)), tuning.layout().most_rows(), 0) {
  reset(settle);
}

void GroupFilter::start() {
  chain_.start(tuning_->equations(), tuning_->layout().own());
  motion_.assign(count_of(tuning_->building().measured) * AxisMotion::kSignals, 0.0);
  const FloorRows& rows = tuning_->rows(0);
  past_.end();
  starting_ = rows.rows > 0 && settle_ == 0;
  if (!starting_) return;  // settled filters carry no trace of the past
  past_.begin(rows.rows);
  for (int r = 0; r < rows.rows; ++r) {
    past_.add(r, tuning_->high_pass_poles());
    past_.add(r, {rows.a1[count_of(r)], rows.a2[count_of(r)]});
  }
  for (const InnerChain& chain : tuning_->equations().chains)
    for (const int row : chain.rows)
      for (const PolePair& poles : chain.poles) past_.add(row, poles);
}

void GroupFilter::reset(int settle) {
  settle_ = settle;
  settling_ = settle + 1;
  start();
}

void GroupFilter::push(const DeformationSet& set) {
  const ReducedBuilding& building = tuning_->building();
  const std::vector<std::uint8_t>& present = tuning_->axes();
  for (std::size_t a = 0; a < present.size(); ++a) {
    if (present[a] == 0 || set.known[a] != 0) continue;
    if (settling_ <= settle_) reset(settle_);
    return;
  }
  if (tuning_->rows(0).rows == 0) return;
  if (settling_ > 0) --settling_;
  std::fill(motion_.begin(), motion_.end(), 0.0);
  for (Eigen::Index a = 0; a < building.from_axes.cols(); ++a) {
    if (present[static_cast<std::size_t>(a)] == 0) continue;
    const double* from = &set.values[static_cast<std::size_t>(a) * AxisMotion::kSignals];
    for (int c = 0; c < building.measured; ++c) {
      const double weight = building.from_axes(c, a);
      if (weight == 0) continue;
      double* to = &motion_[count_of(c * AxisMotion::kSignals)];
      for (int signal = 0; signal < AxisMotion::kSignals; ++signal)
        to[signal] += weight * from[signal];
    }
  }
  chain_.step(motion_.data(), tuning_->rows(0), rows_.data());
  starting_ = !past_.remove(rows_.data());
}

}  // namespace framewatch::estimator
