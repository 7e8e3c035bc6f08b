#include "estimator/diagnose/propose/timed_change.h"

#include <utility>

#include "estimator/diagnose/propose/scalar_fit.h"

namespace framewatch::estimator {
namespace {

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

}  // namespace

ModelEffect timed_change(const Fitter& fitter, const std::vector<NeededSignal>& needed,
                         ModelEffect effect, bool sudden) {
  Timing(fitter, needed, effect, sudden).run();
  return effect;
}

}  // namespace framewatch::estimator
