#pragma once

#include <deque>
#include <vector>

#include "estimator/identify/machine.h"
#include "estimator/identify/window_solution.h"

namespace framewatch {

/// Windows of other lengths than the main one, of whole blocks, from the same block sums
/// (WindowSums' spans). The work is spread over the next block's instants, one window after the
/// other, so an estimate comes up to a block after its window's end.
class OtherWindows {
 public:
  /// blocks: their lengths, the sums' spans.
  OtherWindows(const Structure& structure, const FloorLayout& layout, const ParameterTable& table,
               const EstimatorOptions& options, const std::vector<int>& blocks, int block_rows);

  void restart();
  /// The tuning changes: what is under way belonged to the old one.
  void retuned();
  /// A block has closed at `time`, the end of its last instant. `main` fits the sums' own window.
  void block_closed(const WindowSums& sums, Time time);

  struct Context {
    Machine* machine;
    const WindowSolution* main;
    const std::vector<std::uint8_t>* known;
    WindowSolution::Trust trust;
    bool tuned;
  };
  /// One instant's share of the work; the estimate of a window that it completed, or null.
  const WindowEstimate* advance(const Context& context);

  /// machine: the one in service.
  template <typename Archive>
  void archive(Archive& a, Machine& machine) {
    for (Window& window : windows_) {
      window.solution.archive(a, machine.rows(), machine.sums());
      a(window.estimate);
    }
    a(current_, solved_, rows_, end_);
  }

 private:
  int count() const { return static_cast<int>(windows_.size()); }
  void next(const WindowSums& sums);
  const WindowEstimate* give(const Context& context);

  struct Window {
    WindowSolution solution;
    WindowEstimate estimate;
  };
  std::deque<Window> windows_;
  double rate_hz_;
  int steps_per_instant_ = 1;
  int current_;          ///< window being worked on; count() when there is nothing to do
  bool solved_ = false;  ///< the current one
  int rows_ = 0;         ///< of the current one
  Time end_{};
};

}  // namespace framewatch
