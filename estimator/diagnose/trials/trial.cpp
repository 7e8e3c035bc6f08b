// SPDX-License-Identifier: MIT
#include "estimator/diagnose/trials/trial.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace framewatch::estimator {
namespace {

bool is_same(const Trial& a, const Trial& b) {
  return a.kind == b.kind && a.place == b.place && a.second == b.second;
}

/// Turns a floor against the ground into the floor.
EffectPlace as_node(EffectPlace place) {
  if (place.kind == PlaceKind::node_pair && place.to_story == 0) place.kind = PlaceKind::node;
  return place;
}

}  // namespace

void append(std::vector<Trial>& list, std::vector<Trial> more) {
  list.insert(list.end(), std::make_move_iterator(more.begin()),
              std::make_move_iterator(more.end()));
}

bool is_axis_error(EffectKind kind) {
  return kind == EffectKind::gain_error || kind == EffectKind::polarity ||
         kind == EffectKind::time_shift;
}

double removed_misfit(const Fitter& fitter, const Model& model) {
  double directions = 0, bins = 0;
  for (const ModelEffect& e : model.effects)
    directions += e.form == LawForm::clipped || e.form == LawForm::broadband;
  for (const RecordSegment& s : fitter.segments()) bins += static_cast<double>(s.bins());
  return directions * bins;
}

bool same_spot(const EffectPlace& first, const EffectPlace& second) {
  const EffectPlace a = as_node(first), b = as_node(second);
  if (a == b) return true;
  for (const auto& [whole, part] : {std::pair(a, b), std::pair(b, a)})
    if (whole.kind == PlaceKind::whole_frame && part.kind == PlaceKind::frame)
      return whole.frame == part.frame;
  const auto element_or_node = [](const EffectPlace& p) {
    return p.kind == PlaceKind::frame || p.kind == PlaceKind::node;
  };
  const bool alike = a.kind == b.kind || (a.story == 1 && b.story == 1);
  return element_or_node(a) && element_or_node(b) && alike && a.story == b.story &&
         a.frame == b.frame;
}

std::vector<Trial> without_duplicates(const std::vector<Trial>& trials) {
  std::vector<Trial> out;
  for (const Trial& t : trials)
    if (std::none_of(out.begin(), out.end(), [&](const Trial& o) { return is_same(o, t); }))
      out.push_back(t);
  return out;
}

bool is_rival(const Trial& t, const Trial& best) {
  const bool arbitrary =
      !t.model.effects.empty() && t.model.effects.back().form == LawForm::broadband;
  const bool first = t.kind == best.kind && t.place == best.place;
  const bool second = t.second == std::pair(best.kind, best.place);
  return t.outcome == TrialOutcome::fitted && !arbitrary &&
         !(best.second ? is_same(t, best) : first || second);
}

int common_frame(const Trial& trial) {
  const auto in_frame = [](const EffectPlace& p) { return p.kind == PlaceKind::frame; };
  return trial.second && in_frame(trial.place) && in_frame(trial.second->second) &&
                 trial.place.frame == trial.second->second.frame
             ? trial.place.frame
             : -1;
}

}  // namespace framewatch::estimator
