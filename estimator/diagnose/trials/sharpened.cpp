#include "estimator/diagnose/trials/sharpened.h"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "estimator/diagnose/fit/free_run_start.h"
#include "estimator/diagnose/propose/law_starts.h"
#include "estimator/diagnose/trials/trial_names.h"

namespace framewatch::estimator {
namespace {

constexpr int kSharpSteps = 12;
constexpr int kWeakestSteps = 6;  ///< to the weakest record, which gives only a start

}  // namespace

void free_shapes(Model& model) {
  for (ModelEffect& e : model.effects) free_shape(e);
}

Model fitted_to_the_weakest(const TrialContext& c, const Model& model) {
  const bool of_records =
      std::any_of(model.effects.begin(), model.effects.end(),
                  [](const ModelEffect& e) { return !e.record_parameters.empty(); });
  const std::vector<RecordSegment>& all = c.fitter.segments();
  if (all.size() < 2 || of_records) return model;
  const auto strength = [&](std::size_t r) {
    return c.now.misfit[r] / c.fitter.expected(r, c.now.model);
  };
  std::size_t weakest = 0;
  for (std::size_t r = 1; r < all.size(); ++r)
    if (strength(r) < strength(weakest)) weakest = r;
  const std::vector<RecordSegment> one{all[weakest]};
  const Fitter alone = c.fitter.with(one);
  const FitResult run = alone.fit(model, {}, thorough(model, kWeakestSteps));
  return run.good ? run.model : model;
}

Trial sharpened(const TrialContext& c, const Trial& trial, const Model& from) {
  Model start = from;
  free_shapes(start);
  FitResult run = c.fitter.fit(start, {}, thorough(start, kSharpSteps));
  if (!run.good) return trial;
  if (ends_with_harmonic(run.model)) run = with_onsets(c.fitter, std::move(run));
  Trial out = trial;
  set_fit(c, run, out);
  return out.cost < trial.cost && may_be_named(c, out) ? out : trial;
}

}  // namespace framewatch::estimator
