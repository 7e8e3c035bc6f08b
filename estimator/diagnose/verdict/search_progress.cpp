#include "estimator/diagnose/verdict/search_progress.h"

#include <algorithm>
#include <utility>

namespace framewatch::estimator {

SearchProgress::SearchProgress(TellProgress tell, Parallel parallel)
    : tell_(std::move(tell)), parallel_(std::move(parallel)) {}

void SearchProgress::begin(const std::string& what, double from, double to,
                           std::vector<double> calls) {
  from_ = done_ = std::max(from, done_);
  to_ = std::max(to, from_);
  calls_ = std::move(calls);
  call_ = 0;
  say(what);
}

void SearchProgress::say(const std::string& what) {
  what_ = what;
  tell(done_);
}

Parallel SearchProgress::counted() {
  return [this](int count, const std::function<void(int)>& work) { run(count, work); };
}

void SearchProgress::run(int count, const std::function<void(int)>& work) {
  const double left = to_ - done_;
  const double part =
      call_ < calls_.size() ? std::min(calls_[call_] * (to_ - from_), left) : left / 2;
  ++call_;
  tell(done_ + part);
  run_all(parallel_, count, work);
  done_ += part;
  tell(done_);
}

void SearchProgress::tell(double then) const {
  if (tell_) tell_(what_, done_, then);
}

}  // namespace framewatch::estimator
