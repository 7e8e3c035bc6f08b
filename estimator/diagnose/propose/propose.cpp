// SPDX-License-Identifier: MIT
#include "estimator/diagnose/propose/propose.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <vector>

#include "estimator/diagnose/locate/localise.h"
#include "estimator/diagnose/model/model.h"
#include "estimator/diagnose/propose/contact_proposals.h"
#include "estimator/diagnose/propose/element_proposals.h"
#include "estimator/diagnose/propose/needed_signal.h"
#include "estimator/diagnose/propose/node_proposals.h"
#include "estimator/numeric/complex.h"
#include "estimator/numeric/solve.h"

namespace framewatch::estimator {
namespace {

using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXcd;
using Eigen::VectorXd;

int flat_samples(const RecordSegment& s, Index axis, double& level) {
  const VectorXd a = s.accel.col(axis);
  const double top = a.maxCoeff(), bottom = a.minCoeff();
  const double width = 1e-3 * (top - bottom);
  level = 0.5 * (top - bottom);
  int high = 0, low = 0;
  for (Index i = 0; i < a.size(); ++i) {
    high += a[i] > top - width;
    low += a[i] < bottom + width;
  }
  return std::max(high, low);
}

/// Adds the possible errors of the axis of a localization: gain or polarity, delay, misalignment,
/// clipping.
void add_axis_proposals(const Fitter& fitter, const Localisation& place,
                        std::vector<Proposal>& out) {
  const Plant& plant = fitter.plant();
  const int axis = place.candidate_places.front().axis;
  const EffectPlace here = place.candidate_places.front().place;
  // Estimates the reading that the axis should have from all other axes.
  double own = 0, cross = 0, late = 0, late_weight = 0;
  std::vector<MatrixXcd> truth(place.motion.size());
  for (std::size_t r = 0; r < place.motion.size(); ++r) {
    const RecordSegment& s = fitter.segments()[r];
    Model neutral = place.model;
    const Whitened system =
        whiten(plant, neutral, s, r, Forcing::measured, place.motion[r], fitter.ratio(r));
    truth[r] = system.calibrated.row(axis);
    const Index n = plant.equations();
    for (Index b = 0; b < s.bins(); ++b) {
      const auto at = static_cast<std::size_t>(b);
      VectorXcd u = system.weights->whitener(b).times(system.operation[at].col(axis));
      const VectorXcd rest = rows_of_bin(system.rest, b, n);
      if (place.candidate_places.size() > 1) {
        const MatrixXcd basis = candidate_basis(
            system, b, {place.candidate_places.begin() + 1, place.candidate_places.end()});
        u -= (basis * (basis.adjoint() * u)).eval();
      }
      const double weight = std::max(u.squaredNorm(), 1e-300);
      const Complex read = truth[r](0, b);
      const Complex should = read - u.dot(rest) / weight;
      truth[r](0, b) = should;
      own += weight * std::norm(should);
      cross += weight * (std::conj(should) * read).real();
      const Complex turn = std::conj(should) * read;
      late += -weight * turn.imag() * s.w[b];
      late_weight += weight * turn.real() * s.w[b] * s.w[b];
    }
  }
  const double gain = own > 0 ? cross / own - 1 : 0;
  {
    Proposal p{place.model, gain < -1.5 ? EffectKind::polarity : EffectKind::gain_error, here, 0};
    p.model.free_gain.push_back(axis);
    p.model.gain[axis] += gain;
    out.push_back(p);
  }
  {
    Proposal p{place.model, EffectKind::time_shift, here, 0};
    p.model.free_clock.push_back(axis);
    if (late_weight > 0) p.model.clock_s[axis] += late / late_weight;
    out.push_back(p);
  }
  const SensorAxis& a = plant.axes[static_cast<std::size_t>(axis)];
  for (std::size_t other = 0; other < plant.axes.size(); ++other) {
    const SensorAxis& b = plant.axes[other];
    if (b.story != a.story || b.direction == a.direction) continue;
    if (!a.horizontal() || !b.horizontal()) continue;
    ModelEffect e;
    e.form = LawForm::misaligned;
    e.place = here;
    e.place.kind = PlaceKind::channel_pair;
    e.place.with_channel = static_cast<int>(other);
    e.parameters = {bounded_parameter(0.0, 1e-3, -1.5, 1.5)};
    out.push_back(proposal_of(place, std::move(e), EffectKind::misalignment));
  }
  for (std::size_t r = 0; r < fitter.segments().size(); ++r) {
    double level = 0;
    if (flat_samples(fitter.segments()[r], axis, level) < 8) continue;
    ModelEffect e;
    e.form = LawForm::clipped;
    e.place = here;
    out.push_back(proposal_of(place, std::move(e), EffectKind::clipping));
    break;
  }
}

void add_masses(const Plant& plant, const Localisation& place, std::vector<Proposal>& out) {
  const double typical = plant.structure.node_mass[0];
  ModelEffect e;
  e.form = LawForm::mass;
  e.place = place.candidate_places.front().place;
  e.parameters = {bounded_parameter(0.05 * typical, 0.01 * typical, -typical, 1e15)};
  out.push_back(proposal_of(place, e, EffectKind::extra_mass));
}

/// Returns a flexibility of rotations that stores a twentieth of the elements' energy under the
/// floors' inertia.
double small_flexibility(const Plant& plant, const Model& model, const ModelEffect& effect) {
  constexpr double kShare = 0.05;
  const Structure& s = plant.structure;
  const Eigen::MatrixXd& act = plant.building.act;
  const Eigen::VectorXd k = model.theta.head(plant.element_count());
  Eigen::VectorXd along = Eigen::VectorXd::Zero(s.degrees_of_freedom());
  for (int story = 1; story <= s.stories; ++story)
    for (int f = 0; f < s.frames(); ++f)
      if (s.direction(f) == effect.place.direction) along[s.dof(story, f)] = s.frame_mass(story, f);
  const Eigen::VectorXd load = plant.constraint.transpose() * along;
  const Eigen::MatrixXd stiffness = act * k.asDiagonal() * act.transpose();
  const Eigen::VectorXd d = act.transpose() * Ldlt(stiffness).solve(load);
  const Eigen::VectorXd force = k.cwiseProduct(d);
  return kShare * force.dot(d) / (hinges(plant, effect) * force).squaredNorm();
}

void add_rotations(const Plant& plant, const Localisation& place, std::vector<Proposal>& out) {
  for (const LawForm form : {LawForm::rocking, LawForm::bending}) {
    ModelEffect e;
    e.form = form;
    e.place = place.candidate_places.front().place;
    const double flexibility = small_flexibility(plant, place.model, e);
    e.parameters = {bounded_parameter(flexibility, 0.1 * flexibility, 0, 1e15)};
    out.push_back(proposal_of(
        place, e, form == LawForm::rocking ? EffectKind::base_rocking : EffectKind::frame_bending));
  }
}

void add_floors(const Plant& plant, const Localisation& place, std::vector<Proposal>& out) {
  const double k = plant.design.head(plant.table.panel_stiffness(1, 0)).mean();
  for (const double share : {0.1, 1.0, 10.0}) {
    ModelEffect e;
    e.form = LawForm::panels;
    e.place = place.candidate_places.front().place;
    e.parameters = {logarithmic_parameter(share * k, 1e-3 * k, 1e3 * k),
                    bounded_parameter(1e-3 * share * k, 1e-4 * share * k, 0, 1e15)};
    out.push_back(proposal_of(place, e, EffectKind::floor_flexibility));
  }
}

/// Fits the size of a linear effect to the needed force.
ScalarFit fit_of(const Fitter& fitter, const Localisation& place,
                 const std::vector<NeededSignal>& needed, ModelEffect effect) {
  effect.parameters[0].value = 1;
  const Eigen::VectorXcd along =
      place.candidate_places.front().directions.col(0).cast<std::complex<double>>();
  const LinearOperation operation(fitter.plant(), place.model, effect);
  std::vector<std::vector<Eigen::VectorXcd>> columns(needed.size());
  for (std::size_t r = 0; r < needed.size(); ++r) {
    const RecordSegment& s = fitter.segments()[r];
    Eigen::VectorXcd force(s.bins());
    for (Index b = 0; b < s.bins(); ++b)
      force[b] = along.dot(operation.at(s.w[b]) * place.motion[r].col(b));
    columns[r].push_back(force / along.squaredNorm());
  }
  return scalar_fit(needed, columns);
}

/// Returns a spring or damper at the place with a twentieth of a frame's size.
ModelEffect link_at(const Plant& plant, const EffectPlace& place, bool spring) {
  ModelEffect e;
  e.form = spring ? LawForm::spring : LawForm::damper;
  e.place = place;
  e.place.kind = PlaceKind::node_pair;
  const Index element = plant.table.frame_stiffness(1, place.frame);
  const double size = plant.design[spring ? element : element + plant.element_count()];
  e.parameters = {bounded_parameter(0.05 * size, 0.02 * size, spring ? -10 * size : 0, 1e15)};
  return e;
}

EffectKind kind_of_link(const ModelEffect& link) {
  return link.form == LawForm::spring ? EffectKind::added_spring : EffectKind::added_damper;
}

void add_links(const Fitter& fitter, const Localisation& place,
               const std::vector<NeededSignal>& needed, std::vector<Proposal>& out) {
  for (const bool spring : {true, false}) {
    ModelEffect e = link_at(fitter.plant(), place.candidate_places.front().place, spring);
    const ScalarFit fit = fit_of(fitter, place, needed, e);
    if (spring || fit.coefficients[0] > 0) e.parameters[0].value = fit.coefficients[0];
    out.push_back(proposal_of(place, e, kind_of_link(e)));
    out.back().misfit = fit.misfit;
  }
}

}  // namespace

std::vector<Proposal> propose(const Fitter& fitter, const Localisation& all, std::size_t which) {
  const Plant& plant = fitter.plant();
  Localisation place = all;
  std::swap(place.candidate_places[0], place.candidate_places[which]);
  const CandidatePlace& candidate = place.candidate_places.front();
  std::vector<Proposal> out;
  switch (candidate.kind) {
    case CandidatePlace::Kind::axis:
      add_axis_proposals(fitter, place, out);
      return out;
    case CandidatePlace::Kind::crossing:
      add_masses(plant, place, out);
      return out;
    case CandidatePlace::Kind::rocking:
      add_rotations(plant, place, out);
      add_amplitude_proposals(fitter, place, out);
      return out;
    case CandidatePlace::Kind::floor:
      add_floors(plant, place, out);
      return out;
    case CandidatePlace::Kind::element:
    case CandidatePlace::Kind::node:
    case CandidatePlace::Kind::link:
      break;
  }
  const std::vector<NeededSignal> needed = needed_signals(fitter, place);
  const bool element = candidate.kind == CandidatePlace::Kind::element;
  if (element) out = element_proposals(fitter, place, needed, candidate.element);
  if (candidate.kind == CandidatePlace::Kind::node ||
      (element && plant.equations() > 1 && candidate.place.story == 1 &&
       candidate.place.frame >= 0)) {
    EffectPlace node = candidate.place;
    node.kind = PlaceKind::node;
    add_node_proposals(fitter, place, needed, node, out);
  }
  if (candidate.kind == CandidatePlace::Kind::link ||
      (candidate.kind == CandidatePlace::Kind::node && candidate.place.story >= 2)) {
    add_links(fitter, place, needed, out);
    EffectPlace pair = candidate.place;
    pair.kind = PlaceKind::node_pair;
    add_contact_proposals(fitter, place, needed, pair, out);
  }
  std::stable_sort(out.begin(), out.end(),
                   [](const Proposal& x, const Proposal& y) { return x.misfit < y.misfit; });
  return out;
}

std::vector<Proposal> propose_linear(const Plant& plant, const Localisation& place) {
  const CandidatePlace& candidate = place.candidate_places.front();
  std::vector<Proposal> out;
  if (candidate.kind == CandidatePlace::Kind::crossing) add_masses(plant, place, out);
  if (candidate.kind == CandidatePlace::Kind::rocking) add_rotations(plant, place, out);
  const bool above = candidate.kind == CandidatePlace::Kind::node && candidate.place.story >= 2;
  if (candidate.kind == CandidatePlace::Kind::link || above)
    for (const bool spring : {true, false}) {
      const ModelEffect e = link_at(plant, candidate.place, spring);
      out.push_back(proposal_of(place, e, kind_of_link(e)));
    }
  return out;
}

}  // namespace framewatch::estimator
