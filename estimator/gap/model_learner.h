#pragma once

#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include "estimator/watch/change_point.h"
#include "estimator/watch/watched.h"

namespace framewatch::estimator {

/// Learns a model from main windows that do not overlap, and never across a change of a stiffness:
/// what was learned before it is the model when it is at least a third of learn_s, and otherwise
/// learning begins again behind it. The last two windows learned from only confirm that nothing has
/// changed before them.
class ModelLearner {
 public:
  /// elements: the first parameters, which are stiffnesses. learn_s: total length of the windows.
  ModelLearner(int parameters, int elements, double learn_s);

  /// True when the model is learned; further windows are ignored.
  bool push(const WindowEstimate& estimate);
  /// Means of the parameters of which at least half of the windows have a value, theta order, SI;
  /// NaN: of the others.
  std::vector<WindowMean> learned() const;

  template <typename Archive>
  void archive(Archive& a) {
    a(windows_, joined_);
    a.within(count_, 0, kMax);
    a(complete_);
  }

 private:
  static constexpr std::size_t kMax = 64, kConfirming = 2;
  /// A window, or neighbors joined to make room.
  struct JoinedWindow {
    Time start{}, end{};
    double length_s = 0;  ///< without the time between joined windows
    std::vector<double> value, std_error;

    template <typename Archive>
    void archive(Archive& a) {
      a(start, end, value, std_error);
      a.within(length_s, 0, a.kMaxCount);
      if constexpr (Archive::kReading)
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
  std::size_t count_ = 0;  ///< of those in use
  bool complete_ = false;
};

}  // namespace framewatch::estimator
