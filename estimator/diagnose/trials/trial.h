// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "estimator/diagnose/fit/fit.h"
#include "estimator/diagnose/model/model.h"
#include "estimator/numeric/parallel.h"
#include "estimator/structure/effect.h"

namespace framewatch::estimator {

/// How the trial of a candidate ended.
enum class TrialOutcome {
  fitted,        ///< completely, with free runs
  screened_out,  ///< no free run: others at its place fitted better under the measured motion
  diverged,      ///< its free run diverged
  other_law,     ///< its fitted values are those of another law, or its name is excluded
};

/// A candidate model being fitted: the present model with one effect (or two) added. Only `fitted`
/// trials are ever chosen. The cost of `screened_out` and `diverged` trials is that under the
/// measured motion.
struct Trial {
  TrialOutcome outcome = TrialOutcome::fitted;
  EffectKind kind = EffectKind::cubic_stiffness;
  EffectPlace place;
  double cost = 0;  ///< misfit of the free run over all records, with the prior
  double fraction =
      0;  ///< share of the misfit beyond noise that it explains; NaN: only together with others
  std::vector<double> misfit;  ///< of each record
  Model model;
  /// A second effect that was fitted together with the first.
  std::optional<std::pair<EffectKind, EffectPlace>> second;
  bool refined = false, approached = false;  ///< select_trial() refines a trial once in each way
};

/// Shared by all trials of a round.
struct TrialContext {
  const Fitter& fitter;
  const FitResult& now;                    ///< the model that is extended
  const std::vector<EffectKind>& without;  ///< excluded names
  const Parallel& parallel;
  std::function<void(const std::string&)>
      progress;  ///< called with a description of the current work
  /// Gets every trial that has a fit, also those whose comparison the end of the search interrupts;
  /// nullptr: nothing is kept.
  std::vector<Trial>* fitted = nullptr;

  const SearchSettings& settings() const { return fitter.settings(); }
};

/// Returns true if an effect is an axis' freed gain or clock instead of one of the model's effects.
bool is_axis_error(EffectKind kind);

void append(std::vector<Trial>& list, std::vector<Trial> more);

/// Returns the expected misfit of the equations that a model's arbitrary signals (broadband forces,
/// clipped axes) remove from the sum.
double removed_misfit(const Fitter& fitter, const Model& model);

/// Returns true if the equations cannot distinguish two places. A force on the lowest story of a
/// frame equals one at its floor, a force between a floor and the ground equals one at that floor,
/// and a story of a frame is part of the whole frame.
bool same_spot(const EffectPlace& a, const EffectPlace& b);

/// Returns the first trial of every name and place. The others had other start values.
std::vector<Trial> without_duplicates(const std::vector<Trial>& trials);

/// Returns true if a trial contradicts the best one: it has other effects, not just one more. An
/// arbitrary force does as well as any law and is not a rival.
bool is_rival(const Trial& trial, const Trial& best);

/// Returns the frame whose stories contain both effects of a trial; -1 if they share no frame.
int common_frame(const Trial& trial);

}  // namespace framewatch::estimator
