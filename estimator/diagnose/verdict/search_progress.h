#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "estimator/diagnose/verdict/diagnosis.h"
#include "estimator/numeric/parallel.h"

namespace framewatch::estimator {

/// Shares of the search at which a round looks for places, tries laws, and is over.
struct RoundShares {
  double where, trials, end;

  /// Where pairs of places are tried before.
  double laws() const { return trials + 0.3 * (end - trials); }
};
inline constexpr RoundShares kRounds[] = {{0.05, 0.15, 0.5}, {0.5, 0.57, 0.7}, {0.7, 0.72, 0.75}};

/// How much of a search is done: its stages have shares of the whole, and so has the work within a
/// stage that runs in parallel. What comes after a stage is not known before it ends, so shares are
/// those of a search that goes all its way: a shorter one ends early.
class SearchProgress {
 public:
  /// tell: empty: nobody is told.
  SearchProgress(TellProgress tell, Parallel parallel);
  SearchProgress(const SearchProgress&) = delete;
  SearchProgress& operator=(const SearchProgress&) = delete;

  /// A stage begins, from one share of the whole to another, not before where the last one got.
  /// calls: shares of the stage that its calls of counted() take, one after the other; each
  /// beyond takes half of what is left.
  void begin(const std::string& what, double from, double to, std::vector<double> calls = {});
  /// What the stage is at now.
  void say(const std::string& what);
  /// Does the work as `parallel` and tells of it; must not outlive this.
  Parallel counted();

 private:
  void run(int count, const std::function<void(int)>& work);
  void tell(double then) const;

  TellProgress tell_;
  Parallel parallel_;
  std::string what_;
  double from_ = 0, to_ = 0, done_ = 0;
  std::vector<double> calls_;
  std::size_t call_ = 0;
};

}  // namespace framewatch::estimator
