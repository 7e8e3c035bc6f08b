#include "estimator/diagnose/propose/element_proposals.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "estimator/diagnose/propose/scalar_fit.h"
#include "estimator/diagnose/propose/timed_change.h"

namespace framewatch::estimator {
namespace {

using Eigen::Index;
using Eigen::VectorXcd;

constexpr double kBilinear = 40;  ///< exponent of hysteresis with a corner

class ElementProposals {
 public:
  ElementProposals(const Fitter& fitter, const Localisation& place,
                   const std::vector<NeededSignal>& needed, int element)
      : fitter_(fitter), place_(place), needed_(needed), element_(element) {
    for (const NeededSignal& n : needed) {
      peak_ = std::max(peak_, n.d_t.cwiseAbs().maxCoeff());
      rate_ = std::max(rate_, n.v_t.cwiseAbs().maxCoeff());
    }
  }

  std::vector<Proposal> all() {
    const double k = fitter_.plant().design[element_];
    const double force = k * peak_;
    using F = LawForm;
    best(F::power, EffectKind::cubic_stiffness, {1.5, 2, 3, 5}, [&](double p) {
      return std::vector<LawParameter>{linear_parameter(1, 0.01 * force),
                                       bounded_parameter(p, 0.02, 1.2, 9)};
    });
    std::vector<double> yields;
    for (double y = 0.9; y > 0.004; y *= 0.7) yields.push_back(y);
    for (const double n : {1.0, 2.0, kBilinear})
      best(F::hysteresis, n > 20 ? EffectKind::bilinear_hysteresis : EffectKind::bouc_wen, yields,
           [&](double y) {
             return std::vector<LawParameter>{
                 linear_parameter(1, 0.01 * k),
                 logarithmic_parameter(y * peak_, 1e-4 * peak_, 3 * peak_),
                 bounded_parameter(n, 0.05, 0.5, 60, false),
                 bounded_parameter(0.5, 0.02, 0.1, 1.0, false)};
           });
    if (fitter_.plant().table[element_].frame >= 0)
      for (const double slip : {0.7, 0.9})
        best(F::pinched, EffectKind::pinching, yields, [&](double y) {
          return std::vector<LawParameter>{
              linear_parameter(1, 0.01 * k),
              logarithmic_parameter(y * peak_, 1e-3 * peak_, 3 * peak_),
              bounded_parameter(2, 0.05, 0.5, 60, false),
              bounded_parameter(0.5, 0.02, 0.1, 1.0, false),
              bounded_parameter(slip, 0.02, 0.3, 0.99),
              logarithmic_parameter(0.2, 0.05, 1.0)};
        });
    best(F::friction, EffectKind::coulomb_friction, {0.1, 0.03, 0.01, 0.003}, [&](double v0) {
      return std::vector<LawParameter>{
          linear_parameter(1, 0.01 * force),
          logarithmic_parameter(v0 * rate_, 1e-4 * rate_, 0.3 * rate_)};
    });
    best(F::power_damping, EffectKind::quadratic_damping, {0.4, 1.5, 2, 3}, [&](double p) {
      return std::vector<LawParameter>{linear_parameter(1, 0.01 * force),
                                       bounded_parameter(p, 0.02, 0.15, 5)};
    });
    std::vector<double> gaps;
    for (double g = 0.03; g < 0.97; g += g < 0.1 ? 0.03 : 0.07) gaps.push_back(g);
    for (const F form : {F::gap_positive, F::gap_negative, F::gap_both})
      best(form, form == F::gap_both ? EffectKind::two_sided_gap : EffectKind::one_sided_gap, gaps,
           [&](double g) {
             return std::vector<LawParameter>{
                 linear_parameter(1, 0.01 * k),
                 logarithmic_parameter(g * peak_, 1e-3 * peak_, peak_)};
           });
    changing(k);
    return std::move(out_);
  }

 private:
  ScalarFit fit_of(const ModelEffect& effect) const {
    std::vector<std::vector<VectorXcd>> columns;
    for (std::size_t r = 0; r < needed_.size(); ++r)
      columns.push_back(columns_with(effect, fitter_, needed_, r));
    return scalar_fit(needed_, columns);
  }

  ModelEffect effect_of(LawForm form, std::vector<LawParameter> parameters) const {
    ModelEffect out;
    out.form = form;
    out.place = place_.candidate_places.front().place;
    out.parameters = std::move(parameters);
    out.deformation = peak_;
    out.rate = rate_;
    return out;
  }

  void add(ModelEffect effect, EffectKind kind, const ScalarFit& fit) {
    effect.parameters[0].value = fit.coefficients[2];
    Proposal p{place_.model, kind, effect.place, fit.misfit};
    const Index elements = fitter_.plant().element_count();
    const double least = 0.05 * fitter_.plant().design[element_];
    p.model.theta[element_] = std::max(place_.model.theta[element_] + fit.coefficients[0], least);
    p.model.theta[element_ + elements] += fit.coefficients[1];
    p.model.effects.push_back(std::move(effect));
    out_.push_back(std::move(p));
  }

  void best(LawForm form, EffectKind kind, const std::vector<double>& grid,
            const std::function<std::vector<LawParameter>(double)>& parameters) {
    ScalarFit least;
    ModelEffect chosen;
    for (const double value : grid) {
      const ModelEffect effect = effect_of(form, parameters(value));
      const ScalarFit fit = fit_of(effect);
      const bool dissipates = form == LawForm::friction || form == LawForm::power_damping ||
                              form == LawForm::hysteresis || form == LawForm::pinched;
      if (dissipates && fit.coefficients[2] < 0) continue;
      if (fit.misfit < least.misfit) {
        least = fit;
        chosen = effect;
      }
    }
    if (least.misfit < 1e299) add(std::move(chosen), kind, least);
  }

  void changing(double k) {
    for (const bool sudden : {true, false}) {
      const ModelEffect start = effect_of(LawForm::changing, {linear_parameter(1, 0.01 * k)});
      const ModelEffect effect = timed_change(fitter_, needed_, start, sudden);
      add(effect, sudden ? EffectKind::stiffness_drop : EffectKind::stiffness_drift,
          fit_of(effect));
    }
  }

  const Fitter& fitter_;
  const Localisation& place_;
  const std::vector<NeededSignal>& needed_;
  int element_;
  double peak_ = 0, rate_ = 0;
  std::vector<Proposal> out_;
};

}  // namespace

std::vector<Proposal> element_proposals(const Fitter& fitter, const Localisation& place,
                                        const std::vector<NeededSignal>& needed, int element) {
  return ElementProposals(fitter, place, needed, element).all();
}

}  // namespace framewatch::estimator
