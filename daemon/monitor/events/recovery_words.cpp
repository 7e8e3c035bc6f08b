#include "daemon/monitor/events/recovery_words.h"

#include <algorithm>
#include <cmath>

#include <fmt/core.h>

#include "daemon/monitor/events/change_words.h"

namespace framewatch::daemon {
namespace {

using estimator::RecoveryReason, estimator::RecoveryVerdict;

/// "40 s", "10 minutes", "1 hour", "3 days": rounded to the unit.
std::string time_words(double seconds) {
  const auto words = [](double count, const char* unit) {
    const long whole = std::max(std::lround(count), 1L);
    return fmt::format("{} {}{}", whole, unit, whole == 1 ? "" : "s");
  };
  constexpr double kMinute = 60, kHour = 3600, kDay = 86400, kYear = 365.25 * kDay;
  if (seconds < 1.5 * kMinute) return fmt::format("{} s", std::lround(seconds));
  if (seconds < 0.95 * kHour) return words(seconds / kMinute, "minute");
  if (seconds < 0.95 * kDay) return words(seconds / kHour, "hour");
  if (seconds < 0.95 * kYear) return words(seconds / kDay, "day");
  return words(seconds / kYear, "year");
}

/// "6 %", "6.2 %", by the error; a gain is no loss.
std::string loss_words(double loss, double std_error) {
  return percent_words(std::max(loss, 0.0), std_error);
}

std::string with_error(double loss, double std_error) {
  return fmt::format("{} (+-{})", loss_words(loss, std_error), percent_words(std_error, std_error));
}

const char* reason_words(RecoveryReason reason) {
  switch (reason) {
    case RecoveryReason::few_windows:
      return "too few windows have come";
    case RecoveryReason::short_time:
      return "too little time has passed";
    case RecoveryReason::inexact:
      return "the windows scatter too much";
    case RecoveryReason::amplitude:
      return "how it follows the amplitude of the motion is not known well enough";
    case RecoveryReason::baseline:
      return "its stiffness before is not known well enough";
    case RecoveryReason::none:
      break;
  }
  return "";
}

}  // namespace

std::string recovery_words(const estimator::RecoveryLaw& law) {
  std::string out;
  const bool two = law.time_s > 2 * law.first_s;
  if (law.first_error > 0)
    out = fmt::format("lost {} at the earthquake", loss_words(law.first_loss, law.first_error));
  if (two && law.std_error > 0)
    out +=
        fmt::format(", {} after {}",
                    law.verdict == RecoveryVerdict::recovered ? with_error(law.loss, law.std_error)
                                                              : loss_words(law.loss, law.std_error),
                    time_words(law.time_s));
  if (!out.empty()) out += ", ";
  switch (law.verdict) {
    case RecoveryVerdict::recovering:
      return out + fmt::format("recovering: {} expected after {}",
                               with_error(law.later_loss, law.later_error),
                               time_words(law.later_s));
    case RecoveryVerdict::lasting:
      return out + fmt::format("lasting: full recovery is excluded, at least {} stays",
                               loss_words(law.stays, law.std_error));
    case RecoveryVerdict::recovered:
      return out + "recovered";
    case RecoveryVerdict::not_known:
      break;
  }
  return out + fmt::format("not known yet whether that lasts: {}", reason_words(law.reason));
}

}  // namespace framewatch::daemon
