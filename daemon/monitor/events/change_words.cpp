#include "daemon/monitor/events/change_words.h"

#include <algorithm>
#include <cmath>

#include <fmt/core.h>

#include "daemon/monitor/events/place_words.h"

namespace framewatch::daemon {
namespace {

/// "Up to" is so many standard errors more.
constexpr double kUpTo = 2;

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

double loss_of_one_story(const estimator::Parameter& p, double loss) {
  const double n = p.last_story - p.story + 1;
  return n * loss / (1 + (n - 1) * loss);
}

double loss_of_group(const estimator::Parameter& p, double loss_of_story) {
  const double n = p.last_story - p.story + 1;
  return loss_of_story / (n - (n - 1) * loss_of_story);
}

std::string change_sentence(const estimator::Parameter& p, double ratio, double std_error) {
  const bool group = p.last_story > p.story;
  std::string out =
      fmt::format("{} ({}) {} {} {} of {} stiffness, give or take {}: {}", place_words(p.name),
                  p.name, group ? "have" : "has", ratio < 0 ? "lost" : "gained",
                  percent_words(std::abs(ratio), std_error), group ? "their" : "its",
                  percent_words(std_error, std_error), sure_words(std::abs(ratio) / std_error));
  if (group && ratio < 0)
    out +=
        fmt::format("; one of stories {} to {} may have lost up to {:.0f} %", p.story, p.last_story,
                    100 * loss_of_one_story(p, std::min(std::abs(ratio) + kUpTo * std_error, 1.0)));
  return out;
}

std::string changing_sentence(const estimator::Parameter& p, double ratio) {
  const bool group = p.last_story > p.story;
  return fmt::format("{} ({}) {} changing: {} {} stiffness, how much is not known yet",
                     place_words(p.name), p.name, group ? "are" : "is", group ? "they" : "it",
                     ratio < 0 ? (group ? "lose" : "loses") : (group ? "gain" : "gains"));
}

std::string common_change_sentence(double ratio, double std_error) {
  const char* verb = ratio < 0 ? "softened" : "became stiffer";
  const std::string size = std_error > 0 ? fmt::format(" by {}, give or take {}",
                                                       percent_words(std::abs(ratio), std_error),
                                                       percent_words(std_error, std_error))
                                         : std::string(", how much is not known yet");
  return fmt::format(
      "everything {} alike{}: temperature, mass, a sensor's scale, the clock, or real. Temperature "
      "comes and goes with the day; another mass changes every damping by the same share, a wrong "
      "clock by half of it; a scale shows in one channel; what is real began with shaking and "
      "stays",
      verb, size);
}

}  // namespace framewatch::daemon
