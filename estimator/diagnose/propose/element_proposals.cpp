// SPDX-License-Identifier: MIT
#include "estimator/diagnose/propose/element_proposals.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

#include "estimator/diagnose/propose/law_starts.h"
#include "estimator/diagnose/propose/needed_signal.h"

namespace framewatch::estimator {
namespace {

using Eigen::Index;
using Eigen::VectorXcd;

constexpr double kSudden_s = 0.05;
constexpr double kSlownesses[] = {0.3, 0.6, 1.0};  ///< of the record
constexpr double kCoarse = 0.025, kFine = 0.0025;  ///< steps of an onset, of the record
constexpr int kRounds = 6;

/// Times of a change in one record, with the resulting normal equations.
struct Timed {
  std::vector<LawParameter> parameters;
  ScalarSums sums;
};

/// The index of a time in every record.
struct Choice {
  std::vector<std::size_t> at;
  double misfit = 0;
};

class Timing {
 public:
  Timing(const Fitter& fitter, const std::vector<NeededSignal>& needed, ModelEffect& effect,
         bool sudden)
      : fitter_(fitter), needed_(needed), effect_(effect), sudden_(sudden) {}

  void run() {
    effect_.record_parameters.assign(needed_.size(), parameters(0, 0, kSudden_s));
    std::vector<std::vector<Timed>> times;
    for (std::size_t r = 0; r < needed_.size(); ++r) times.push_back(coarse(r));
    agree(times);
    for (std::size_t r = 0; r < needed_.size(); ++r) times[r] = finer(r);
    agree(times);
  }

 private:
  std::vector<LawParameter> parameters(std::size_t record, double from_s, double length_s) const {
    const double seconds = fitter_.segments()[record].seconds();
    std::vector<LawParameter> out{bounded_parameter(from_s, 0.1, -0.2 * seconds, seconds),
                                  logarithmic_parameter(length_s, 0.02, 2 * seconds)};
    out[1].free = !sudden_;
    return out;
  }

  void add(std::size_t record, double from_s, double length_s, std::vector<Timed>& out) {
    effect_.record_parameters[record] = parameters(record, from_s, length_s);
    out.push_back({effect_.record_parameters[record],
                   scalar_sums(needed_[record], columns_with(effect_, fitter_, needed_, record))});
  }

  std::vector<Timed> coarse(std::size_t record) {
    const double seconds = fitter_.segments()[record].seconds();
    std::vector<double> lengths{kSudden_s};
    if (!sudden_) {
      lengths.clear();
      for (const double share : kSlownesses) lengths.push_back(share * seconds);
    }
    std::vector<Timed> out;
    for (const double length : lengths)
      for (double from = 0; from < seconds - 0.5 * length; from += kCoarse * seconds)
        add(record, from, length, out);
    return out;
  }

  std::vector<Timed> finer(std::size_t record) {
    const double seconds = fitter_.segments()[record].seconds();
    const std::vector<LawParameter> middle = effect_.record_parameters[record];
    std::vector<Timed> out;
    for (int i = -10; i <= 10; ++i)
      add(record, middle[0].plain() + kFine * seconds * i, middle[1].plain(), out);
    return out;
  }

  /// Chooses the times that together fit all records best. One record cannot distinguish a change
  /// from the opposite change of another stiffness before it.
  void agree(const std::vector<std::vector<Timed>>& times) {
    double least = 1e300;
    for (std::size_t begin = 0; begin < times.front().size(); ++begin) {
      const Choice choice = descend(times, begin);
      if (choice.misfit >= least) continue;
      least = choice.misfit;
      for (std::size_t r = 0; r < times.size(); ++r)
        effect_.record_parameters[r] = times[r][choice.at[r]].parameters;
    }
  }

  /// Descends from one time of the first record: chooses the times of the other records one after
  /// another, then repeats until none changes.
  static Choice descend(const std::vector<std::vector<Timed>>& times, std::size_t begin) {
    Choice out{{begin}, times[0][begin].sums.fit().misfit};
    ScalarSums sums = times[0][begin].sums;
    for (std::size_t r = 1; r < times.size(); ++r) {
      out.at.push_back(best_beside(times[r], sums, out.misfit));
      sums += times[r][out.at[r]].sums;
    }
    bool moved = times.size() > 1;
    for (int round = 0; round < kRounds && moved; ++round) {
      moved = false;
      for (std::size_t r = 0; r < times.size(); ++r) {
        const std::size_t before = out.at[r];
        out.at[r] = best_beside(times[r], others(times, out.at, r), out.misfit);
        moved = moved || out.at[r] != before;
      }
    }
    return out;
  }

  static ScalarSums others(const std::vector<std::vector<Timed>>& times,
                           const std::vector<std::size_t>& at, std::size_t without) {
    const std::size_t first = without == 0 ? 1 : 0;
    ScalarSums out = times[first][at[first]].sums;
    for (std::size_t r = first + 1; r < times.size(); ++r)
      if (r != without) out += times[r][at[r]].sums;
    return out;
  }

  static std::size_t best_beside(const std::vector<Timed>& list, const ScalarSums& others,
                                 double& misfit) {
    std::size_t out = 0;
    misfit = 1e300;
    for (std::size_t i = 0; i < list.size(); ++i) {
      ScalarSums sums = list[i].sums;
      const double with = (sums += others).fit().misfit;
      if (with >= misfit) continue;
      misfit = with;
      out = i;
    }
    return out;
  }

  const Fitter& fitter_;
  const std::vector<NeededSignal>& needed_;
  ModelEffect& effect_;
  bool sudden_;
};

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

ModelEffect timed_change(const Fitter& fitter, const std::vector<NeededSignal>& needed,
                         ModelEffect effect, bool sudden) {
  Timing(fitter, needed, effect, sudden).run();
  return effect;
}

std::vector<Proposal> element_proposals(const Fitter& fitter, const Localisation& place,
                                        const std::vector<NeededSignal>& needed, int element) {
  return ElementProposals(fitter, place, needed, element).all();
}

}  // namespace framewatch::estimator
