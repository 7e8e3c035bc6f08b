#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "estimator/diagnose/verdict/diagnosis.h"
#include "estimator/numeric/parallel.h"

namespace framewatch::estimator {

/// Shares of the search at which a round starts to locate, starts to fit laws, and ends.
struct RoundShares {
  double where, trials, end;

  /// Returns the share at which laws start if pairs of places are tried first.
  double laws() const { return trials + 0.3 * (end - trials); }
};
inline constexpr RoundShares kRounds[] = {{0.05, 0.15, 0.5}, {0.5, 0.57, 0.7}, {0.7, 0.72, 0.75}};

/// Reports the progress of a search. Stages have fixed shares of the whole, and so does parallel
/// work within a stage. The shares assume a search through all stages, so a shorter search ends
/// early.
class SearchProgress {
 public:
  /// tell: empty: reports nothing.
  SearchProgress(TellProgress tell, Parallel parallel);
  SearchProgress(const SearchProgress&) = delete;
  SearchProgress& operator=(const SearchProgress&) = delete;

  /// Starts a stage that covers the shares `from` to `to`, but not below the share already reached.
  /// calls: shares of the stage for its calls of counted(), one after the other; each further call
  /// gets half of the rest.
  void begin(const std::string& what, double from, double to, std::vector<double> calls = {});
  /// Reports the current work of the stage.
  void say(const std::string& what);
  /// Returns `parallel` with progress reports. Must not outlive this object.
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
