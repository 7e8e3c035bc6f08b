// SPDX-License-Identifier: MIT
#include "estimator/diagnose/trials/wrong_labels.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <utility>

#include "estimator/numeric/complex.h"

namespace framewatch::estimator {
namespace {

constexpr double kTurned = -2;  ///< relative gain error of a channel with reversed sign

/// Returns the design with the effects of the present model.
Model from_the_design(const TrialContext& c) {
  Model out = initial_model(c.fitter.plant());
  out.effects = c.now.model.effects;
  out.free_gain = c.now.model.free_gain;
  out.free_clock = c.now.model.free_clock;
  for (const int axis : out.free_gain) out.gain[axis] = c.now.model.gain[axis];
  for (const int axis : out.free_clock) out.clock_s[axis] = c.now.model.clock_s[axis];
  return out;
}

Trial turned(const Model& from, int axis) {
  Trial out;
  out.kind = EffectKind::polarity;
  out.place.kind = PlaceKind::channel;
  out.place.channel = axis;
  out.model = from;
  out.model.free_gain.push_back(axis);
  out.model.gain[axis] = kTurned;
  return out;
}

Trial exchanged(const Model& from, int axis, int other) {
  Trial out;
  out.kind = EffectKind::swapped;
  out.place.kind = PlaceKind::channel_pair;
  out.place.channel = axis;
  out.place.with_channel = other;
  ModelEffect swap;
  swap.form = LawForm::swapped;
  swap.place = out.place;
  out.model = from;
  out.model.effects.push_back(swap);
  return out;
}

std::vector<Trial> all_labels(const TrialContext& c) {
  const Model from = from_the_design(c);
  const auto axes = static_cast<int>(c.fitter.plant().axis_count());
  std::vector<Trial> out;
  for (int axis = 0; axis < axes; ++axis) {
    if (std::find(from.free_gain.begin(), from.free_gain.end(), axis) == from.free_gain.end())
      out.push_back(turned(from, axis));
    for (int other = axis + 1; other < axes; ++other) out.push_back(exchanged(from, axis, other));
  }
  std::erase_if(out, [&](const Trial& t) {
    return std::find(c.without.begin(), c.without.end(), t.kind) != c.without.end();
  });
  return out;
}

/// Sets the cost of every label to the misfit of the design with the readings relabelled, under the
/// weights of the design as it is. Much faster than a fit, and nearly its cost before the first
/// step. systems: of the design.
void estimate_costs(const std::vector<Whitened>& systems, std::vector<Trial>& labels) {
  for (Trial& t : labels) t.cost = 0;
  for (const Whitened& s : systems)
    for (Eigen::Index b = 0; b < s.bins(); ++b) {
      const Eigen::MatrixXcd operation = s.operation[static_cast<std::size_t>(b)];
      const Eigen::MatrixXcd metric = operation.adjoint() * (s.weights->metric(b) * operation);
      for (Trial& t : labels) {
        // The spectrum of one or two readings changes.
        const Eigen::Index i = t.place.channel, j = t.place.with_channel;
        const bool two = t.kind == EffectKind::swapped;
        const Complex y = s.calibrated(i, b), change = two ? s.calibrated(j, b) - y : -2.0 * y;
        t.cost += 2 * (std::conj(change) * s.by_readings(i, b)).real() +
                  std::norm(change) * metric(i, i).real();
        if (two)
          t.cost += -2 * (std::conj(change) * s.by_readings(j, b)).real() +
                    std::norm(change) * (metric(j, j).real() - 2 * metric(i, j).real());
      }
    }
}

void sort_by_cost(std::vector<Trial>& trials) {
  std::stable_sort(trials.begin(), trials.end(),
                   [](const Trial& a, const Trial& b) { return a.cost < b.cost; });
}

/// Continues the fit of every trial, at most `steps`. Trials that cannot be fitted get infinite
/// cost.
void continue_fits(const TrialContext& c, int steps, std::vector<Trial>& trials) {
  run_all(c.parallel, static_cast<int>(trials.size()), [&](int i) {
    Trial& t = trials[static_cast<std::size_t>(i)];
    FitOptions options;
    options.max_steps = steps;
    const FitResult fit = c.fitter.fit(t.model, {}, options);
    t.cost = fit.good ? fit.cost : std::numeric_limits<double>::infinity();
    if (!fit.good) return;
    t.misfit = fit.misfit;
    t.model = fit.model;
  });
  sort_by_cost(trials);
}

}  // namespace

std::vector<Trial> wrong_labels(const TrialContext& c) {
  const Plant& plant = c.fitter.plant();
  const SearchSettings& settings = c.settings();
  const double expected = c.fitter.expected(c.now.model);
  if (plant.is_large() || plant.equations() == 1 || plant.prescribed ||
      c.now.total_misfit() < settings.far_off * expected)
    return {};
  std::vector<Trial> trials = all_labels(c);
  // Motions that no axis reads would change too.
  if (trials.size() > settings.labels && plant.unread.cols() == 0) {
    estimate_costs(c.fitter.systems(from_the_design(c), {}, Forcing::measured), trials);
    sort_by_cost(trials);
    trials.resize(settings.labels);
  }
  continue_fits(c, 0, trials);
  if (trials.size() > settings.laws) trials.resize(settings.laws);
  continue_fits(c, settings.long_steps, trials);
  std::erase_if(trials, [](const Trial& t) { return !(t.cost < 1e300); });
  if (trials.empty() || trials.front().cost > settings.leaves_little * c.now.cost) return {};
  for (Trial& t : trials) t.fraction = (c.now.cost - t.cost) / std::max(c.now.cost - expected, 1.0);
  return trials;
}

}  // namespace framewatch::estimator
