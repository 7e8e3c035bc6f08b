#include "daemon/events/change_words.h"

#include <algorithm>
#include <cmath>

#include <fmt/core.h>

#include "daemon/events/place_words.h"

namespace framewatch::daemon {
namespace {

std::string sure_words(double errors) {
  return errors > 100 ? "more than 100 times its uncertainty"
                      : fmt::format("{:.0f} times its uncertainty", errors);
}

}  // namespace

std::string percent_words(double ratio, double std_error) {
  const double error = 100 * std::abs(std_error);
  const int digits =
      error > 0 ? std::clamp(static_cast<int>(std::ceil(-std::log10(error))), 0, 2) : 1;
  return fmt::format("{:.{}f} %", 100 * ratio, digits);
}

std::string change_sentence(const estimator::Parameter& p, double ratio, double std_error) {
  return fmt::format("{} ({}) {} {} of its stiffness, give or take {}: {}", place_words(p.name),
                     p.name, ratio < 0 ? "has lost" : "has gained",
                     percent_words(std::abs(ratio), std_error), percent_words(std_error, std_error),
                     sure_words(std::abs(ratio) / std_error));
}

}  // namespace framewatch::daemon
