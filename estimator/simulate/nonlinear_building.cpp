// SPDX-License-Identifier: MIT
#include "estimator/simulate/nonlinear_building.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <span>
#include <utility>

#include "estimator/numeric/eigenvalues.h"
#include "estimator/numeric/solve.h"

namespace framewatch::estimator {
namespace {

constexpr double kLongestPart_s = 5e-4;
/// Largest angles, rad, that the fastest mode and a law's frequency turn in a part. Modes above
/// kFastestMode_hz do not count.
constexpr double kFastestMode_hz = 300;
constexpr double kModeAngle = 0.2;
constexpr double kLawAngle = 0.05;
/// Largest share of its velocity that a law's damping removes in a part.
constexpr double kLawDecay = 0.1;

double dot(const double* a, const double* b, Eigen::Index size) {
  double sum = 0;
  for (Eigen::Index i = 0; i < size; ++i) sum += a[i] * b[i];
  return sum;
}

void add(double factor, const Eigen::VectorXd& from, double* to) {
  for (Eigen::Index i = 0; i < from.size(); ++i) to[i] += factor * from[i];
}

}  // namespace

NonlinearBuilding::NonlinearBuilding(const Structure& structure, const ParameterTable& table,
                                     const Eigen::VectorXd& theta,
                                     const std::vector<Effect>& effects, double step_s,
                                     int refinement)
    : NonlinearBuilding(structure, table, theta, effects, ground_inputs(structure), step_s,
                        refinement) {}

NonlinearBuilding::NonlinearBuilding(const Structure& structure, const ParameterTable& table,
                                     const Eigen::VectorXd& theta,
                                     const std::vector<Effect>& effects, Inputs inputs,
                                     double step_s, int refinement)
    : NonlinearBuilding(structure, table, theta, effects, {}, std::move(inputs), step_s,
                        refinement) {}

NonlinearBuilding::NonlinearBuilding(const Structure& structure, const ParameterTable& table,
                                     const Eigen::VectorXd& theta,
                                     const std::vector<Effect>& effects,
                                     std::vector<PlacedLaw> more_laws, Inputs inputs, double step_s,
                                     int refinement)
    : structure_(structure),
      table_(table),
      effects_(effects),
      laws_(placed_laws(structure, table, theta, effects)),
      forces_(placed_forces(structure, effects)),
      inputs_(std::move(inputs)),
      step_s_(step_s),
      refinement_(refinement) {
  assert(step_s > 0 && refinement >= 1);
  std::move(more_laws.begin(), more_laws.end(), std::back_inserter(laws_));
  int states = 0;
  for (const PlacedLaw& p : laws_) states += p.law->states();
  z_ = Eigen::VectorXd::Zero(states);
  accel_abs_ = Eigen::VectorXd::Zero(structure.degrees_of_freedom());
  set_theta(theta);
}

void NonlinearBuilding::set_theta(const Eigen::VectorXd& theta) {
  assert(theta.size() == table_.size());
  const LinearModel model = linear_model(structure_, table_, theta, effects_, inputs_.influence);
  constraint_ = model.constraint;
  const Eigen::Index q = constraint_.cols();
  const Eigen::MatrixXd constraint_mass = constraint_.transpose() * model.mass.asDiagonal();
  const Ldlt mass(constraint_mass * constraint_);
  const Eigen::MatrixXd mass_inverse = mass.solve(Eigen::MatrixXd(Eigen::MatrixXd::Identity(q, q)));
  const Eigen::MatrixXd stiffness =
      mass.solve(Eigen::MatrixXd(constraint_.transpose() * model.stiffness() * constraint_));
  const Eigen::MatrixXd damping =
      mass.solve(Eigen::MatrixXd(constraint_.transpose() * model.damping() * constraint_));

  const Eigen::Index n = inputs_.influence.cols();
  if (state_.size() == 0) state_ = Eigen::VectorXd::Zero(2 * q + 2 * n);
  const double scale_before = velocity_scale_;
  velocity_scale_ = std::sqrt(stiffness.diagonal().maxCoeff());
  if (!(velocity_scale_ > 0)) velocity_scale_ = 1;
  state_.head(q) *= velocity_scale_ / scale_before;

  placed_.clear();
  int first_state = 0;
  for (const PlacedLaw& p : laws_) {
    const Eigen::VectorXd b = constraint_.transpose() * p.deformation(model);
    placed_.push_back({b, -mass_inverse * b, first_state});
    first_state += p.law->states();
  }
  force_push_.clear();
  for (const PlacedForce& p : forces_)
    force_push_.push_back(mass_inverse * constraint_.row(p.dof).transpose());
  choose_parts(model, mass_inverse);

  Eigen::MatrixXd generator = Eigen::MatrixXd::Zero(2 * q + 2 * n, 2 * q + 2 * n);
  generator.block(0, q, q, q).diagonal().setConstant(velocity_scale_);
  generator.block(q, 0, q, q) = -stiffness / velocity_scale_;
  generator.block(q, q, q, q) = -damping;
  const Eigen::MatrixXd pushed = mass.solve(
      Eigen::MatrixXd(constraint_.topRows(inputs_.force.rows()).transpose() * inputs_.force));
  generator.block(q, 2 * q, q, n) =
      pushed - mass.solve(Eigen::MatrixXd(constraint_mass * model.influence));
  generator.block(2 * q, 2 * q + n, n, n).setIdentity();
  const Eigen::MatrixXd scaled = generator * (step_s_ / parts_ / 2);
  const Eigen::MatrixXd exponential = matrix_exponential(scaled);
  half_ = exponential.topRows(2 * q);

  const Eigen::Index nd = accel_abs_.size();
  output_.resize(nd, 2 * q);
  output_.leftCols(q) = -constraint_.topRows(nd) * stiffness / velocity_scale_;
  output_.rightCols(q) = -constraint_.topRows(nd) * damping;
  output_push_ = constraint_.topRows(nd);
  direct_ = inputs_.force.isZero(0) ? RowMatrix(0, n) : RowMatrix(constraint_.topRows(nd) * pushed);
  force_now_ = force_middle_ = force_end_ =
      Eigen::VectorXd::Zero(static_cast<Eigen::Index>(forces_.size()));
  for (Slope* k : {&k1_, &k2_, &k3_, &k4_})
    *k = {Eigen::VectorXd::Zero(q), Eigen::VectorXd::Zero(z_.size())};
  middle_ = stage_ = end_ = Eigen::VectorXd::Zero(2 * q + 2 * n);
  carried_ = Eigen::VectorXd::Zero(2 * q);
  stage_z_ = z_;
  update_accel();
}

void NonlinearBuilding::choose_parts(const LinearModel& model,
                                     const Eigen::MatrixXd& mass_inverse) {
  const Eigen::MatrixXd dynamic =
      mass_inverse * constraint_.transpose() * model.stiffness() * constraint_;
  const Eigen::VectorXcd modes = general_eigenvalues(dynamic);
  const double fastest =
      std::min(std::sqrt(modes.real().cwiseAbs().maxCoeff()), 2 * M_PI * kFastestMode_hz);
  double part_s = std::min(kLongestPart_s, kModeAngle / std::max(fastest, 1e-9));
  for (std::size_t i = 0; i < laws_.size(); ++i) {
    const double per_newton = -placed_[i].b.dot(placed_[i].push);
    const double omega = std::sqrt(per_newton * laws_[i].law->stiffness_bound());
    const double decay = per_newton * laws_[i].law->damping_bound();
    if (omega > 0) part_s = std::min(part_s, kLawAngle / omega);
    if (decay > 0) part_s = std::min(part_s, kLawDecay / decay);
  }
  if (laws_.empty() && forces_.empty()) part_s = step_s_;
  parts_ = refinement_ * std::max(1, static_cast<int>(std::ceil(step_s_ / part_s - 1e-9)));
}

void NonlinearBuilding::set_state(const Eigen::VectorXd& disp_rel, const Eigen::VectorXd& vel_rel) {
  const Eigen::Index q = constraint_.cols();
  const auto hidden = constraint_.rows() - disp_rel.size();
  const Eigen::VectorXd rest = Eigen::VectorXd::Zero(hidden);
  Eigen::VectorXd full(constraint_.rows());
  const LeastSquares decomposition(constraint_);
  full << disp_rel, rest;
  state_.head(q) = velocity_scale_ * decomposition.solve(full);
  full << vel_rel, rest;
  state_.segment(q, q) = decomposition.solve(full);
  update_accel();
}

std::vector<double> NonlinearBuilding::motion() const {
  std::vector<double> out(state_.begin(), state_.end());
  out.insert(out.end(), z_.begin(), z_.end());
  for (const PlacedLaw& p : laws_) {
    const std::vector<double> memory = p.law->memory();
    out.insert(out.end(), memory.begin(), memory.end());
  }
  return out;
}

bool NonlinearBuilding::resume(const std::vector<double>& motion) {
  const auto states = static_cast<std::size_t>(state_.size());
  const auto inner = static_cast<std::size_t>(z_.size());
  if (motion.size() != this->motion().size()) return false;
  std::copy_n(motion.begin(), states, state_.begin());
  std::copy_n(motion.begin() + static_cast<std::ptrdiff_t>(states), inner, z_.begin());
  std::span<const double> left = std::span(motion).subspan(states + inner);
  for (const PlacedLaw& p : laws_) {
    const std::size_t size = p.law->memory().size();
    p.law->remember(left.first(size));
    left = left.subspan(size);
  }
  update_accel();
  return true;
}

void NonlinearBuilding::drive(const Eigen::Ref<const Eigen::VectorXd>& before,
                              const Eigen::Ref<const Eigen::VectorXd>& after) {
  const double part_s = step_s_ / parts_;
  const Eigen::Index n = inputs_.influence.cols();
  auto now = state_.segment(state_.size() - 2 * n, n);
  auto slope = state_.tail(n);
  const double start_s = time_s_;
  for (int part = 0; part < parts_; ++part) {
    part_start_s_ = start_s + part * part_s;
    slope = (after - before) / step_s_;
    now = before + slope * (part * part_s);
    advance_part(part_s);
  }
  now = after;
  time_s_ = start_s + step_s_;
  part_start_s_ = time_s_;
  update_accel();
}

void NonlinearBuilding::advance_part(double h) {
  const Eigen::Index q = constraint_.cols();
  const double now_s = part_start_s_;
  for (std::size_t i = 0; i < laws_.size(); ++i)
    laws_[i].law->begin_step(now_s, dot(placed_[i].b.data(), state_.data(), q) / velocity_scale_);
  forces_at(now_s, force_now_);
  forces_at(now_s + h / 2, force_middle_);
  forces_at(now_s + h, force_end_);

  evaluate(now_s, state_, z_, force_now_, k1_);
  flow(state_, middle_);
  stage_ = middle_;
  carry(k1_.accel, carried_);
  add(h / 2, carried_, stage_.data());
  stage_z_ = z_ + h / 2 * k1_.states;
  evaluate(now_s + h / 2, stage_, stage_z_, force_middle_, k2_);

  stage_ = middle_;
  add(h / 2, k2_.accel, stage_.data() + q);
  stage_z_ = z_ + h / 2 * k2_.states;
  evaluate(now_s + h / 2, stage_, stage_z_, force_middle_, k3_);

  flow(middle_, end_);
  stage_ = end_;
  carry(k3_.accel, carried_);
  add(h, carried_, stage_.data());
  stage_z_ = z_ + h * k3_.states;
  evaluate(now_s + h, stage_, stage_z_, force_end_, k4_);

  // e^{Lh} k1 + 2 e^{Lh/2} (k2 + k3) = e^{Lh/2} (e^{Lh/2} k1 + 2 (k2 + k3))
  middle_.setZero();
  carry(k1_.accel, carried_);
  middle_.head(2 * q) = carried_;
  add(2, k2_.accel, middle_.data() + q);
  add(2, k3_.accel, middle_.data() + q);
  flow(middle_, stage_);
  add(1, k4_.accel, stage_.data() + q);
  for (Eigen::Index i = 0; i < 2 * q; ++i) state_[i] = end_[i] + h / 6 * stage_[i];
  z_ += h / 6 * (k1_.states + 2 * (k2_.states + k3_.states) + k4_.states);
}

void NonlinearBuilding::flow(const Eigen::VectorXd& state, Eigen::VectorXd& out) const {
  multiply(half_, state.data(), out.data(), 0, half_.cols());
  const double half_s = step_s_ / parts_ / 2;
  const Eigen::Index n = inputs_.influence.cols();
  for (Eigen::Index i = state.size() - 2 * n; i < state.size() - n; ++i) {
    out[i] = state[i] + half_s * state[i + n];
    out[i + n] = state[i + n];
  }
}

void NonlinearBuilding::carry(const Eigen::VectorXd& accel, Eigen::VectorXd& out) const {
  multiply(half_, accel.data(), out.data(), accel.size(), accel.size());
}

void NonlinearBuilding::evaluate(double time_s, const Eigen::VectorXd& state,
                                 const Eigen::VectorXd& z, const Eigen::VectorXd& forces,
                                 Slope& out) const {
  const Eigen::Index q = constraint_.cols();
  out.accel.setZero();
  for (std::size_t i = 0; i < laws_.size(); ++i) {
    const Law& law = placed_[i];
    const ElementLaw& element = *laws_[i].law;
    const auto count = static_cast<std::size_t>(element.states());
    const std::span<const double> own(z.data() + law.first_state, count);
    const double d = dot(law.b.data(), state.data(), q) / velocity_scale_;
    const double v = dot(law.b.data(), state.data() + q, q);
    add(element.force(time_s, d, v, own), law.push, out.accel.data());
    if (count > 0) element.rates(d, v, own, {out.states.data() + law.first_state, count});
  }
  for (std::size_t i = 0; i < forces_.size(); ++i)
    add(forces[static_cast<Eigen::Index>(i)], force_push_[i], out.accel.data());
}

void NonlinearBuilding::forces_at(double time_s, Eigen::VectorXd& out) const {
  constexpr double kRounding_s = 1e-9;
  for (std::size_t i = 0; i < forces_.size(); ++i) {
    const AppliedForce& force = forces_[i].force;
    const bool acts = part_start_s_ >= force.from_s() - kRounding_s;
    out[static_cast<Eigen::Index>(i)] = acts ? force.at(time_s) : 0;
  }
}

void NonlinearBuilding::update_accel() {
  const Eigen::Index q = constraint_.cols();
  forces_at(time_s_, force_now_);
  applied_n_.setZero(forces_.empty() ? 0 : accel_abs_.size());
  for (std::size_t i = 0; i < forces_.size(); ++i)
    applied_n_[forces_[i].dof] += force_now_[static_cast<Eigen::Index>(i)];
  evaluate(time_s_, state_, z_, force_now_, k1_);
  multiply(output_, state_.data(), accel_abs_.data(), 0, 2 * q);
  for (Eigen::Index r = 0; r < accel_abs_.size(); ++r)
    accel_abs_[r] += dot(output_push_.data() + r * q, k1_.accel.data(), q);
  if (direct_.rows() > 0) accel_abs_ += direct_ * state_.segment(2 * q, direct_.cols());
}

Eigen::VectorXd NonlinearBuilding::disp_rel() const {
  const Eigen::Index q = constraint_.cols();
  return constraint_.topRows(accel_abs_.size()) * state_.head(q) / velocity_scale_;
}

Eigen::VectorXd NonlinearBuilding::vel_rel() const {
  const Eigen::Index q = constraint_.cols();
  return constraint_.topRows(accel_abs_.size()) * state_.segment(q, q);
}

}  // namespace framewatch::estimator
