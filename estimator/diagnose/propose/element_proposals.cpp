#include "estimator/diagnose/propose/element_proposals.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

#include "estimator/diagnose/propose/law_starts.h"
#include "estimator/diagnose/propose/scalar_fit.h"
#include "estimator/diagnose/propose/timed_change.h"

namespace framewatch::estimator {
namespace {

using Eigen::Index;
using Eigen::VectorXcd;

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

  std::vector<Proposal> all() const {
    const double k = fitter_.plant().design[element_];
    const LawScale scale{k, peak_, rate_};
    const bool frame = fitter_.plant().table[element_].frame >= 0;
    std::vector<LawStarts> families = plain_starts(scale);
    for (LawStarts& family : hysteretic_starts(scale, frame)) families.push_back(std::move(family));
    std::vector<std::optional<Proposal>> found(families.size() + 2);
    run_all(fitter_.within(), static_cast<int>(found.size()), [&](int i) {
      const auto at = static_cast<std::size_t>(i);
      found[at] = at < families.size() ? best(families[at]) : changing(k, at == families.size());
    });
    std::vector<Proposal> out;
    for (std::optional<Proposal>& one : found)
      if (one) out.push_back(std::move(*one));
    return out;
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

  Proposal proposal(ModelEffect effect, EffectKind kind, const ScalarFit& fit) const {
    set_amplitude(effect, fit.coefficients[2]);
    Proposal p{place_.model, kind, effect.place, fit.misfit};
    const Index elements = fitter_.plant().element_count();
    const double least = 0.05 * fitter_.plant().design[element_];
    p.model.theta[element_] = std::max(place_.model.theta[element_] + fit.coefficients[0], least);
    p.model.theta[element_ + elements] += fit.coefficients[1];
    p.model.effects.push_back(std::move(effect));
    return p;
  }

  /// Returns the family with the best of its starts, or nullopt if none has an admissible
  /// amplitude.
  std::optional<Proposal> best(const LawStarts& family) const {
    ScalarFit least;
    ModelEffect chosen;
    for (const std::vector<LawParameter>& shape : family.shapes) {
      const ModelEffect effect = effect_of(family.form, shape);
      const ScalarFit fit = fit_of(effect);
      if (!has_amplitude(effect, fit.coefficients[2])) continue;
      if (fit.misfit < least.misfit) {
        least = fit;
        chosen = effect;
      }
    }
    if (!(least.misfit < 1e299)) return std::nullopt;
    return proposal(std::move(chosen), family.kind, least);
  }

  Proposal changing(double k, bool sudden) const {
    const ModelEffect start = effect_of(LawForm::changing, {linear_parameter(1, 0.01 * k)});
    const ModelEffect effect = timed_change(fitter_, needed_, start, sudden);
    return proposal(effect, sudden ? EffectKind::stiffness_drop : EffectKind::stiffness_drift,
                    fit_of(effect));
  }

  const Fitter& fitter_;
  const Localisation& place_;
  const std::vector<NeededSignal>& needed_;
  int element_;
  double peak_ = 0, rate_ = 0;
};

}  // namespace

std::vector<Proposal> element_proposals(const Fitter& fitter, const Localisation& place,
                                        const std::vector<NeededSignal>& needed, int element) {
  return ElementProposals(fitter, place, needed, element).all();
}

}  // namespace framewatch::estimator
