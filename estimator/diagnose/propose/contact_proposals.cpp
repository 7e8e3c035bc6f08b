// SPDX-License-Identifier: MIT
#include "estimator/diagnose/propose/contact_proposals.h"

#include <algorithm>
#include <utility>

#include "estimator/diagnose/fit/measured_deformation.h"
#include "estimator/diagnose/model/law_port.h"
#include "estimator/diagnose/propose/law_starts.h"
#include "estimator/diagnose/propose/needed_signal.h"

namespace framewatch::estimator {
namespace {

using Eigen::VectorXcd;

constexpr std::size_t kMaxFrames = 4;  ///< whole frames to try in one direction
constexpr double kFirstShare = 0.05;   ///< of the stiffness that a start takes at the peak
constexpr double kSoftens = 2;         ///< exponent of the deformation at the start
constexpr double kLevelsOff = 1;       ///< saturation at the start, of the largest deformation

MeasuredDeformation motion_of(const Fitter& fitter, const Localisation& place, const LawPort& port,
                              std::size_t record) {
  return measured_deformation(fitter.plant(), fitter.segments()[record], port.sense,
                              place.motion[record], fitter.ratio(record));
}

void set_scales(const Fitter& fitter, const Localisation& place, ModelEffect& effect) {
  effect.deformation = effect.rate = 1e-12;
  for (const LawPort& port : law_ports(fitter.plant(), place.model, effect))
    for (std::size_t r = 0; r < fitter.segments().size(); ++r) {
      const MeasuredDeformation motion = motion_of(fitter, place, port, r);
      effect.deformation = std::max(effect.deformation, motion.d.cwiseAbs().maxCoeff());
      effect.rate = std::max(effect.rate, motion.v.cwiseAbs().maxCoeff());
    }
}

}  // namespace

void add_contact_proposals(const Fitter& fitter, const Localisation& place,
                           const std::vector<NeededSignal>& needed, const EffectPlace& pair,
                           std::vector<Proposal>& out) {
  const Plant& plant = fitter.plant();
  ModelEffect effect;
  effect.form = LawForm::gap_both;
  effect.place = pair;
  set_scales(fitter, place, effect);
  const LawPort port = law_ports(plant, place.model, effect).front();
  std::vector<MeasuredDeformation> motion;
  for (std::size_t r = 0; r < needed.size(); ++r)
    motion.push_back(motion_of(fitter, place, port, r));
  const double k = plant.design[plant.table.frame_stiffness(pair.story, pair.frame)];
  for (const LawStarts& family : contact_starts({k, effect.deformation, effect.rate})) {
    ScalarFit least;
    ModelEffect chosen;
    effect.form = family.form;
    for (const std::vector<LawParameter>& shape : family.shapes) {
      effect.parameters = shape;
      std::vector<std::vector<VectorXcd>> columns(needed.size());
      for (std::size_t r = 0; r < needed.size(); ++r) {
        const RecordSegment& s = fitter.segments()[r];
        const int ratio = fitter.ratio(r);
        columns[r].push_back(band_of(
            law_force(effect.law(r), motion[r].d, motion[r].v, 1 / (s.rate_hz * ratio)), s, ratio));
      }
      const ScalarFit fit = scalar_fit(needed, columns);
      if (fit.coefficients[0] <= 0 || fit.misfit >= least.misfit) continue;
      least = fit;
      chosen = effect;
    }
    if (least.misfit > 1e299) continue;
    set_amplitude(chosen, least.coefficients[0]);
    out.push_back(proposal_of(place, std::move(chosen), family.kind, least.misfit));
  }
}

std::vector<Proposal> amplitude_proposals(const Fitter& fitter, const Localisation& place,
                                          const EffectPlace& frames) {
  ModelEffect effect;
  effect.form = LawForm::amplitude;
  effect.place = frames;
  set_scales(fitter, place, effect);
  double k = 0;
  for (const LawPort& port : law_ports(fitter.plant(), place.model, effect))
    k = std::max(k, place.model.theta[port.element]);
  const double force = kFirstShare * k * effect.deformation;
  ModelEffect softening = effect;
  softening.parameters = {
      linear_parameter(-force, 0.2 * force), bounded_parameter(kSoftens, 0.02, 1.02, 6, false),
      linear_parameter(0.2 * force, 0.2 * force), bounded_parameter(2, 0.02, 1, 5, false)};
  ModelEffect saturating = softening;  // from hyperbolic
  saturating.parameters[AmplitudeIndex::exponent].low = 1.3;
  saturating.parameters.push_back(fixed_parameter(0));
  saturating.parameters.push_back(logarithmic_parameter(kLevelsOff, 0.05, 5));
  saturating.parameters.back().free = false;
  ModelEffect slipping = effect;
  slipping.parameters = {bounded_parameter(-force, 0.2 * force, -1e300, 0),
                         bounded_parameter(1.5, 0.02, 1.02, 6, false), fixed_parameter(0),
                         fixed_parameter(2), fixed_parameter(1)};
  const EffectKind kind = EffectKind::amplitude_dependence;
  return {proposal_of(place, std::move(softening), kind, 0),
          proposal_of(place, std::move(saturating), kind, 0),
          proposal_of(place, std::move(slipping), kind, 0)};
}

void add_amplitude_proposals(const Fitter& fitter, const Localisation& place,
                             std::vector<Proposal>& out) {
  const Structure& s = fitter.plant().structure;
  if (s.stories < 2) return;
  const EffectPlace& building = place.candidate_places.front().place;
  std::vector<EffectPlace> places{building};
  const int count = building.direction == Direction::x ? s.n() : s.m();
  for (int f = 0; f < s.frames() && count > 1; ++f) {
    if (s.direction(f) != building.direction || places.size() > kMaxFrames) continue;
    EffectPlace frame;
    frame.kind = PlaceKind::whole_frame;
    frame.frame = f;
    places.push_back(frame);
  }
  for (const EffectPlace& one : places)
    for (Proposal& p : amplitude_proposals(fitter, place, one)) out.push_back(std::move(p));
}

}  // namespace framewatch::estimator
