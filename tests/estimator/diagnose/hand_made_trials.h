// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "estimator/diagnose/fit/unknowns.h"
#include "estimator/diagnose/trials/trial.h"
#include "tests/estimator/diagnose/hidden_effect.h"

namespace framewatch::test {

/// A model fitted to a record, and trials with chosen costs.
struct HandMade {
  Recorded recorded;
  estimator::FitResult now;
  std::vector<estimator::EffectKind> without;
  estimator::Parallel one_after_another;

  /// By default nothing is hidden.
  explicit HandMade(const std::vector<Eigen::MatrixXd>& records = records_with({}),
                    const estimator::Tolerances& tolerances = {})
      : recorded(records, tolerances), now(recorded.linear()) {}

  estimator::TrialContext context() const {
    return {recorded.fitter, now, without, one_after_another, [](const std::string&) {}};
  }

  /// Returns a complete trial, `cheaper` than the model, with no effect in it yet.
  estimator::Trial trial(estimator::EffectKind kind, double cheaper) const {
    estimator::Trial out;
    out.kind = kind;
    out.model = now.model;
    out.cost = now.cost - cheaper;
    out.misfit = now.misfit;
    return out;
  }
};

}  // namespace framewatch::test
