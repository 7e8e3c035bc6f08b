#include "daemon/monitor/event_report/drift_words.h"

#include <algorithm>
#include <cmath>

#include <fmt/core.h>

#include "daemon/base/numbers.h"

namespace framewatch::daemon {

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

std::string capitalised(std::string text) {
  if (!text.empty() && text[0] >= 'a' && text[0] <= 'z')
    text[0] = static_cast<char>(text[0] - 'a' + 'A');
  return text;
}

std::string placard_words(const estimator::PlacardChoice& choice) {
  switch (choice.placard) {
    case estimator::Placard::unsafe:
      return "unsafe";
    case estimator::Placard::inspected:
      return "inspected";
    case estimator::Placard::restricted:
      break;
  }
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
  // Two digits of the error at most, of the value no more than that.
  const double percent = 100 * drift.std_error;
  const int digits =
      percent > 0 ? std::clamp(1 - static_cast<int>(std::floor(std::log10(percent))), 0, 6) : 3;
  return fmt::format("{:.{}f} % ± {:.{}f} %", 100 * drift.ratio, digits, percent, digits);
}

}  // namespace framewatch::daemon
