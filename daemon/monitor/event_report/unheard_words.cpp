#include "daemon/monitor/event_report/unheard_words.h"

#include <cmath>

#include <fmt/core.h>

#include "daemon/base/utc_time.h"

namespace framewatch::daemon {
namespace {

using estimator::UnheardWhy;

double seconds_of(const estimator::Unheard& u) {
  return 1e-6 * static_cast<double>(to_microseconds(u.to) - to_microseconds(u.from));
}

/// "28 s", "1.4 s", "2 h 5 min".
std::string length_words(double seconds) {
  if (seconds < 9.95) return fmt::format("{:.1f} s", seconds);
  const long whole = std::lround(seconds);
  if (whole < 600) return fmt::format("{} s", whole);
  if (whole < 3600) return fmt::format("{} min", std::lround(seconds / 60));
  return fmt::format("{} h {} min", whole / 3600, whole % 3600 / 60);
}

std::string sentence(const estimator::Unheard& u, double drift_settles_s) {
  const std::string to = sensor_clock_text(to_microseconds(u.to));
  const std::string settled =
      sensor_clock_text(to_microseconds(u.to) + static_cast<std::int64_t>(1e6 * drift_settles_s));
  const std::string drifts = "; drifts are known again from " + settled + " on";
  if (!u.from_known)
    return fmt::format(
        "Nobody listened before {}: the motion may have begun earlier, and peaks before that are "
        "not known{}",
        to, drifts);
  const std::string times =
      fmt::format("from {} to {} ({})", sensor_clock_text(to_microseconds(u.from)), to,
                  length_words(seconds_of(u)));
  switch (u.why) {
    case UnheardWhy::no_samples:
      return fmt::format("No samples came {}: peaks in that time are not known{}", times, drifts);
    case UnheardWhy::restart:
      return fmt::format("Nobody listened {}: peaks in that time are not known{}", times, drifts);
    case UnheardWhy::restart_no_raw:
      break;
  }
  return fmt::format(
      "Nobody listened {}, or what was heard is lost because no raw samples of it are stored "
      "([history] stores them): peaks in that time are not known{}",
      times, drifts);
}

}  // namespace

std::vector<std::string> unheard_sentences(const estimator::Shaking& shaking) {
  std::vector<std::string> out;
  for (const estimator::Unheard& u : shaking.unheard)
    out.push_back(sentence(u, shaking.drift_settles_s));
  return out;
}

std::string unheard_words(const estimator::Shaking& shaking) {
  double seconds = 0;
  bool beginning = false;
  for (const estimator::Unheard& u : shaking.unheard) {
    if (u.from_known)
      seconds += seconds_of(u);
    else
      beginning = true;
  }
  if (seconds == 0) return beginning ? "its beginning was not heard" : "";
  return length_words(seconds) +
         (beginning ? " of it and its beginning were not heard" : " of it were not heard");
}

const char* unheard_why(UnheardWhy why) {
  switch (why) {
    case UnheardWhy::restart:
      return "restart";
    case UnheardWhy::restart_no_raw:
      return "restart_without_raw_samples";
    case UnheardWhy::no_samples:
      break;
  }
  return "no_samples";
}

}  // namespace framewatch::daemon
