// SPDX-License-Identifier: MIT
#include "daemon/monitor/event_report/report_words.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include <fmt/core.h>

#include "daemon/base/numbers.h"
#include "daemon/base/utc_time.h"

namespace framewatch::daemon {
namespace {

using estimator::UnheardWhy;

double seconds_of(const estimator::Unheard& u) {
  return 1e-6 * static_cast<double>(to_microseconds(u.to) - to_microseconds(u.from));
}

/// Returns "28 s", "1.4 s", "2 h 5 min".
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

std::string force_words(double newton) {
  constexpr const char* kUnits[] = {"N", "kN", "MN", "GN"};
  double value = newton;
  std::size_t unit = 0;
  for (; std::abs(value) >= 999.5 && unit + 1 < std::size(kUnits); ++unit) value /= 1000;
  return fmt::format("{:.3g} {}", value, kUnits[unit]);
}

std::string drift_words(double ratio) {
  const double percent = 100 * ratio;
  const int before = percent > 0 ? static_cast<int>(std::floor(std::log10(percent))) + 1 : 1;
  return fmt::format("{:.{}f} %", percent, std::clamp(3 - before, 0, 9));
}

std::string base_shear_words(const estimator::PeakResponse& peak,
                             const estimator::Structure& structure) {
  std::string out;
  for (std::size_t d = 0; d < 2; ++d) {
    if ((d == 0 ? structure.n() : structure.m()) == 0) continue;
    const double shear = peak.base_shear_n[d];
    out += fmt::format("{}{} along {}", out.empty() ? "" : ", ",
                       std::isfinite(shear) ? force_words(shear) : "not known", d == 0 ? "x" : "y");
  }
  return out;
}

const char* state_word(estimator::DamageState state) {
  constexpr const char* kWords[] = {"slight", "moderate", "extensive", "complete"};
  return kWords[static_cast<std::size_t>(state)];
}

std::string probability_words(double probability) {
  if (!std::isfinite(probability)) return "-";
  if (probability < 0.01) return "less than 1 %";
  if (probability > 0.99) return "more than 99 %";
  return fmt::format("{:.0f} %", 100 * probability);
}

std::string capitalized(std::string text) {
  if (!text.empty() && text[0] >= 'a' && text[0] <= 'z')
    text[0] = static_cast<char>(text[0] - 'a' + 'A');
  return text;
}

std::string placard_words(const estimator::PlacardChoice& choice) {
  if (choice.placard == estimator::Placard::unsafe) return "unsafe";
  if (choice.placard == estimator::Placard::inspected) return "inspected";
  const bool by_damage = choice.reason == estimator::PlacardReason::damage ||
                         choice.reason == estimator::PlacardReason::no_damage;
  return by_damage ? "restricted use" : "restricted use (not judged)";
}

const char* placard_caution() {
  return "This is an indication for the engineer who inspects the building. It does not replace "
         "the inspection: look at the building before you post a placard.";
}

std::string drift_with_error(const estimator::StoryDrift& drift) {
  if (!drift.known()) return "not known";
  if (!std::isfinite(drift.std_error)) return drift_words(drift.ratio) + " or more";
  // At most two digits of the error, and no more of the value.
  const double percent = 100 * drift.std_error;
  const int digits =
      percent > 0 ? std::clamp(1 - static_cast<int>(std::floor(std::log10(percent))), 0, 6) : 3;
  return fmt::format("{:.{}f} % ± {:.{}f} %", 100 * drift.ratio, digits, percent, digits);
}

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
  constexpr const char* kWords[] = {"no_samples", "restart", "restart_without_raw_samples"};
  return kWords[static_cast<std::size_t>(why)];
}

}  // namespace framewatch::daemon
