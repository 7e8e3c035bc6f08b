#pragma once

#include <cstddef>
#include <vector>

#include "estimator/motion/sample.h"

namespace framewatch::estimator {

/// What the newest kMax windows of one length say of every parameter: its deviation from the
/// baseline. In order of time, whatever the order they came in. Bounded.
class WindowHistory {
 public:
  static constexpr std::size_t kMax = 40;

  explicit WindowHistory(std::size_t parameters);

  /// A parameter in a window, relative to the baseline. std_error: > 0, independent between windows
  /// that do not overlap. common_error: >= 0, the same in all windows.
  struct Value {
    double off, std_error, common_error;
  };

  /// Adds a window without values, and gives its place; the oldest one is dropped when there are
  /// kMax. A window that is older than all of kMax others is not added: gives kMax.
  std::size_t add(Time start, Time end);
  void put(std::size_t place, std::size_t parameter, const Value& value);
  void clear() { count_ = 0; }

  std::size_t size() const { return count_; }
  Time start(std::size_t place) const { return start_[place]; }
  Time end(std::size_t place) const { return end_[place]; }
  bool has(std::size_t place, std::size_t parameter) const {
    return std_error_[place * parameters_ + parameter] > 0;
  }
  Value value(std::size_t place, std::size_t parameter) const {
    const std::size_t i = place * parameters_ + parameter;
    return {off_[i], std_error_[i], common_error_[i]};
  }
  /// The first place from which on windows begin at `from` or later and have the parameter;
  /// size(): there is none.
  std::size_t first(std::size_t parameter, Time from) const;

  template <typename Archive>
  void archive(Archive& a) {
    a.within(count_, 0, static_cast<double>(kMax));
    a(start_, end_);
    a.finite(off_, std_error_, common_error_);
  }

 private:
  void move(std::size_t from, std::size_t to);

  std::size_t parameters_, count_ = 0;
  std::vector<Time> start_, end_;
  std::vector<float> off_, std_error_, common_error_;  ///< kMax x parameters; error 0: no value
};

}  // namespace framewatch::estimator
