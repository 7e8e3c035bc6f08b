#include "estimator/diagnose/trials/trial_context.h"

#include <iterator>

namespace framewatch::estimator {

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

}  // namespace framewatch::estimator
