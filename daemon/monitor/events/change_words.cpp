// SPDX-License-Identifier: MIT
#include "daemon/monitor/events/change_words.h"

#include <algorithm>
#include <cmath>

#include <fmt/core.h>

namespace framewatch::daemon {
namespace {

struct PlaceOfName {
  char quantity = 'k', direction = 'x';
  std::string stories;  ///< "story 1", "stories 6 to 12", "floor 2"; empty: the whole building
  std::string where;    ///< frames or panel; empty: all frames of a direction
};

PlaceOfName place_of(const std::string& name) {
  PlaceOfName out;
  const std::size_t at = name.find('_');
  out.quantity = name.empty() ? 'k' : name.front();
  out.direction =
      at == 0 || name.empty() ? 'x' : name[at == std::string::npos ? name.size() - 1 : at - 1];
  if (at == std::string::npos) return out;
  const std::size_t next = name.find('_', at + 1);
  const std::string stories = name.substr(at + 1, next == std::string::npos ? next : next - at - 1);
  const std::size_t to = stories.find("to");
  out.stories = to != std::string::npos
                    ? fmt::format("stories {} to {}", stories.substr(0, to), stories.substr(to + 2))
                    : (out.quantity == 'G' ? "floor " : "story ") + stories;
  if (next != std::string::npos) out.where = name.substr(next + 1);
  return out;
}

const char* frame_word(const PlaceOfName& place) {
  return place.where.find('+') == std::string::npos ? "frame" : "frames";
}

/// Returns the label of the one frame of a place; "" without one.
std::string label_of(const PlaceOfName& place, const FrameLabels& labels) {
  const auto found = place.quantity == 'G' ? labels.end() : labels.find(place.where);
  return found == labels.end() ? "" : found->second;
}

/// "Up to" adds this many standard errors.
constexpr double kUpTo = 2;

std::string sure_words(double errors) {
  return errors > 100 ? "more than 100 times its uncertainty"
                      : fmt::format("{:.0f} times its uncertainty", errors);
}

using estimator::RecoveryReason, estimator::RecoveryVerdict;

/// Returns a duration rounded to its unit: "40 s", "10 minutes", "1 hour", "3 days".
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

/// Returns a loss in percent, rounded by its error: "6 %", "6.2 %". A gain counts as 0.
std::string loss_words(double loss, double std_error) {
  return percent_words(std::max(loss, 0.0), std_error);
}

std::string with_error(double loss, double std_error) {
  return fmt::format("{} (+-{})", loss_words(loss, std_error), percent_words(std_error, std_error));
}

const char* reason_words(RecoveryReason reason) {
  constexpr const char* kWords[] = {
      "",
      "too few windows have come",
      "too little time has passed",
      "the windows scatter too much",
      "how it follows the amplitude of the motion is not known well enough",
      "its stiffness before is not known well enough"};
  return kWords[static_cast<std::size_t>(reason)];
}

}  // namespace

FrameLabels frame_labels(const estimator::Structure& s) {
  FrameLabels out;
  for (std::size_t f = 0; f < s.labels_x.size(); ++f) out[s.frames_x[f]] = s.labels_x[f];
  for (std::size_t f = 0; f < s.labels_y.size(); ++f) out[s.frames_y[f]] = s.labels_y[f];
  return out;
}

std::string place_words(const std::string& parameter, const FrameLabels& labels) {
  const PlaceOfName p = place_of(parameter);
  if (p.stories.empty()) return fmt::format("frames along {}", p.direction);
  if (p.where.empty()) return fmt::format("{}, along {}", p.stories, p.direction);
  const std::string label = label_of(p, labels);
  if (!label.empty()) return fmt::format("{}, {}", p.stories, label);
  return fmt::format("{}, {} {}", p.stories, p.quantity == 'G' ? "panel" : frame_word(p), p.where);
}

std::string named_place(const std::string& parameter, const FrameLabels& labels) {
  return fmt::format("{} ({})", place_words(parameter, labels), parameter);
}

std::string frame_words(const std::string& frame, const FrameLabels& labels) {
  const auto found = labels.find(frame);
  return found == labels.end() ? "frame " + frame : found->second;
}

std::string element_words(const std::string& parameter, const FrameLabels& labels) {
  const PlaceOfName p = place_of(parameter);
  if (p.stories.empty()) return fmt::format("bending of frames along {}", p.direction);
  if (p.where.empty()) return fmt::format("{} along {}", p.stories, p.direction);
  const std::string label = label_of(p, labels);
  if (!label.empty()) return fmt::format("{} ({}) of {}", label, p.where, p.stories);
  return fmt::format("{} {} of {}", p.quantity == 'G' ? "floor panel" : frame_word(p), p.where,
                     p.stories);
}

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

std::string change_sentence(const estimator::Parameter& p, double ratio, double std_error,
                            const FrameLabels& labels) {
  const bool group = p.last_story > p.story;
  std::string out =
      fmt::format("{} {} {} {} of {} stiffness, give or take {}: {}", named_place(p.name, labels),
                  group ? "have" : "has", ratio < 0 ? "lost" : "gained",
                  percent_words(std::abs(ratio), std_error), group ? "their" : "its",
                  percent_words(std_error, std_error), sure_words(std::abs(ratio) / std_error));
  if (group && ratio < 0)
    out +=
        fmt::format("; one of stories {} to {} may have lost up to {:.0f} %", p.story, p.last_story,
                    100 * loss_of_one_story(p, std::min(std::abs(ratio) + kUpTo * std_error, 1.0)));
  return out;
}

std::string changing_sentence(const estimator::Parameter& p, double ratio,
                              const FrameLabels& labels) {
  const bool group = p.last_story > p.story;
  return fmt::format("{} {} changing: {} {} stiffness, how much is not known yet",
                     named_place(p.name, labels), group ? "are" : "is", group ? "they" : "it",
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
