#include "estimator/watch/window_history.h"

#include <algorithm>
#include <utility>

namespace framewatch::estimator {

WindowHistory::WindowHistory(std::size_t parameters)
    : parameters_(parameters),
      start_(kMax),
      end_(kMax),
      off_(kMax * parameters, 0.0F),
      std_error_(kMax * parameters, 0.0F),
      common_error_(kMax * parameters, 0.0F) {}

/// Moves the windows from `from` on to `to`: by one place either way.
void WindowHistory::move(std::size_t from, std::size_t to) {
  const auto shift = [&](auto& values, std::size_t width) {
    const auto at = [&](std::size_t i) {
      return values.begin() + static_cast<std::ptrdiff_t>(i * width);
    };
    if (from > to)
      std::copy(at(from), at(count_), at(to));
    else
      std::copy_backward(at(from), at(count_), at(count_ + 1));
  };
  shift(start_, 1);
  shift(end_, 1);
  for (std::vector<float>* of : {&off_, &std_error_, &common_error_}) shift(*of, parameters_);
}

std::size_t WindowHistory::add(Time start, Time end) {
  if (count_ == kMax) {
    if (end < end_[0]) return kMax;
    move(1, 0);
    --count_;
  }
  const auto last = end_.begin() + static_cast<std::ptrdiff_t>(count_);
  const auto at =
      static_cast<std::size_t>(std::upper_bound(end_.begin(), last, end) - end_.begin());
  if (at < count_) move(at, at + 1);
  ++count_;
  start_[at] = start;
  end_[at] = end;
  const auto from = static_cast<std::ptrdiff_t>(at * parameters_);
  const auto width = static_cast<std::ptrdiff_t>(parameters_);
  for (std::vector<float>* of : {&off_, &std_error_, &common_error_})
    std::fill(of->begin() + from, of->begin() + from + width, 0.0F);
  return at;
}

void WindowHistory::put(std::size_t place, std::size_t parameter, const Value& value) {
  const std::size_t i = place * parameters_ + parameter;
  off_[i] = static_cast<float>(value.off);
  std_error_[i] = static_cast<float>(value.std_error);
  common_error_[i] = static_cast<float>(value.common_error);
}

std::size_t WindowHistory::first(std::size_t parameter, Time from) const {
  std::size_t place = 0;
  while (place < count_ && (start_[place] < from || !has(place, parameter))) ++place;
  return place;
}

}  // namespace framewatch::estimator
