// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include "estimator/watch/change_point.h"
#include "estimator/watch/watched.h"

namespace framewatch::estimator {

/// Learns a model from main windows that do not overlap, never across a change of a stiffness. At a
/// change, the windows before it are the model if they cover at least a third of learn_s; otherwise
/// learning restarts behind it. The last two windows only confirm that nothing changed before them.
class ModelLearner {
 public:
  /// elements: number of stiffnesses, which come first. learn_s: total length of the windows.
  ModelLearner(int parameters, int elements, double learn_s);

  /// Takes a window. Returns true when the model is learned; further windows are ignored.
  bool push(const WindowEstimate& estimate);
  /// Returns the means of the parameters that have a value in at least half of the windows, theta
  /// order, SI; NaN for the others.
  std::vector<WindowMean> learned() const;

  void archive(auto& a) {
    a(windows_, joined_);
    a.within(count_, 0, kMax);
    a(complete_);
  }

 private:
  static constexpr std::size_t kMax = 64, kConfirming = 2;
  /// A window, or neighbors joined to free a place.
  struct JoinedWindow {
    Time start{}, end{};
    double length_s = 0;  ///< without the time between joined windows
    std::vector<double> value, std_error;

    void archive(auto& a) {
      a(start, end, value, std_error);
      a.within(length_s, 0, a.kMaxCount);
      if (a.kReading)
        for (const std::vector<double>* of : {&value, &std_error})
          for (const double v : *of)
            if (!std::isnan(v) && !(std::abs(v) <= a.kMax)) return a.refuse();
    }
  };
  std::vector<WindowValue> values(std::size_t parameter) const;
  void add(const WindowEstimate& estimate);
  void join_neighbors();
  void keep(std::size_t from, std::size_t to);
  std::optional<ChangePoint> change() const;
  double length_s(std::size_t from, std::size_t to) const;

  std::size_t elements_;
  double learn_s_;
  SeparateWindows windows_;
  std::vector<JoinedWindow> joined_;
  std::size_t count_ = 0;  ///< number in use
  bool complete_ = false;
};

}  // namespace framewatch::estimator
