// SPDX-License-Identifier: MIT
#include "daemon/page/findings/finding.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/core.h>

#include "daemon/monitor/events/change_words.h"
#include "daemon/monitor/events/event_messages.h"
#include "estimator/structure/parameter_table.h"

namespace framewatch::daemon {
namespace {

/// Kinds of events whose place is a channel with wrong or missing samples.
constexpr std::array kOfChannels = {"channel_silent", "channel_stuck",   "channel_rate",
                                    "channel_clock",  "channel_doubted", "absurd_samples",
                                    "two_senders",    "losses",          "channel_table"};

bool is_channel(const Config& config, const std::string& place) {
  const auto& axes = config.pipeline.axes;
  return std::any_of(axes.begin(), axes.end(), [&](const auto& a) { return a.name == place; });
}

/// Removes ", since ..." from a message, because the finding has the time.
std::string without_time(const std::string& message) {
  const std::size_t at = message.rfind(", since ");
  return (at == std::string::npos ? message : message.substr(0, at)) + ".";
}

void describe_change(Finding& f, const Config& config) {
  const estimator::ParameterTable table = config.pipeline.parameters();
  const auto at = table.find(f.place);
  f.kind = FindingKind::change;
  if (f.place == kWholeBuilding) {
    f.text = without_time(f.text);
    f.advice =
        "Check temperature, load, and the scale and clock of the sensors. If none "
        "explains the change, have a structural engineer inspect the building.";
    return;
  }
  f.advice = fmt::format(
      "Have a structural engineer inspect {} before normal use continues; then acknowledge "
      "the finding.",
      at ? place_words(f.place, frame_labels(config.pipeline.structure)) : f.place);
  const std::size_t at_recovery = f.text.find(kAfterStrongMotion);
  const std::string recovery =
      at_recovery == std::string::npos
          ? ""
          : " After strong motion: " + f.text.substr(at_recovery + kAfterStrongMotion.size()) + ".";
  f.text = f.text.substr(0, at_recovery);
  if (!at || !std::isfinite(f.change_ratio) || !(f.std_error > 0)) {
    f.text = without_time(f.text) + recovery;  // its message says it
    return;
  }
  f.text = change_sentence(table[*at], f.change_ratio, f.std_error,
                           frame_labels(config.pipeline.structure)) +
           "." + recovery;
}

void describe_strong_motion(Finding& f) {
  f.kind = FindingKind::shake;
  f.text = f.text.substr(0, f.text.find("; report ")) + ".";
  f.advice = f.severity == severity::alarm
                 ? "Have a structural engineer inspect the building before normal use continues. "
                   "The report of the strong motion lists where."
                 : "Have a structural engineer read the report of the strong motion. It lists what "
                   "to inspect.";
}

void describe_channel(Finding& f, const std::string& kind) {
  f.kind = FindingKind::belief;
  f.of_channel = true;
  if (kind == "channel_silent" || kind == "channel_stuck")
    f.advice = fmt::format("Check the power, cable and mounting of sensor {}.", f.place);
  else if (kind == "channel_rate" || kind == "channel_clock")
    f.advice = fmt::format("Check the {} of the node that sends {}.",
                           kind == "channel_rate" ? "rate" : "clock", f.place);
  else if (kind == "channel_doubted")
    f.advice = fmt::format(
        "Check sensor {}: its mounting, scale, wiring and clock. The building itself moves as "
        "before.",
        f.place);
  else if (kind == "absurd_samples")
    f.advice = fmt::format("Check sensor {}: its values are impossible.", f.place);
  else if (kind == "two_senders" || kind == "channel_table")
    f.advice = fmt::format(
        "Find the other node that sends as {}: two nodes may have the same number.", f.place);
  else
    f.advice = fmt::format("Check the network of {}: samples are lost.", f.place);
}

constexpr int kIdentifies = 1;  // window_estimate_t::status

}  // namespace

std::string place_name(const std::string& place, const Config& config) {
  return config.pipeline.parameters().find(place)
             ? named_place(place, frame_labels(config.pipeline.structure))
             : place;
}

Finding finding_of(const event_t& e, const Config& config) {
  Finding f;
  f.id = e.id;
  f.severity = e.severity;
  f.place = e.place;
  f.since_us = e.since_us;
  f.text = e.message;
  if (e.kind == "stiffness_change") {
    f.change_ratio = e.value / 100;
    f.std_error = e.std_error / 100;
    describe_change(f, config);
  } else if (e.kind == "lasting_loss") {
    f.kind = FindingKind::change;
    f.change_ratio = e.value / 100;
    f.std_error = e.std_error / 100;
    f.text += ".";
    f.advice =
        e.place == kWholeBuilding
            ? "Check mass, use, and the scale and clock of the sensors. If none explains the "
              "loss, have a structural engineer inspect the building."
            : fmt::format(
                  "Have a structural engineer inspect {}; then acknowledge the "
                  "finding. docs/years.md says how it was found.",
                  place_name(e.place, config));
  } else if (e.kind == "lasting_damping") {
    f.kind = FindingKind::change;
    f.text += ".";
    f.advice =
        fmt::format("Look at {} for friction, loose parts or cracks; then acknowledge the finding.",
                    e.place == kWholeBuilding ? "the building" : place_name(e.place, config));
  } else if (e.kind == "weather") {
    f.kind = FindingKind::belief;
    f.text += ".";
    f.advice = fmt::format("Check the sensor and gateway of {}.", e.place);
  } else if (e.kind == "strong_motion") {
    describe_strong_motion(f);
  } else if (e.kind == "gap") {
    f.kind = FindingKind::belief;
    f.text = fmt::format("The model does not fit: {}.", e.message);
    f.advice = fmt::format("Find out what the model lacks near {}: framewatch diagnose.",
                           place_name(e.place, config));
  } else if (std::find(kOfChannels.begin(), kOfChannels.end(), e.kind) != kOfChannels.end() &&
             is_channel(config, e.place)) {
    describe_channel(f, e.kind);
  } else if (e.kind == "sequence_leap") {
    f.advice =
        "Nothing if sensor nodes restarted; otherwise find out which other node sends with their "
        "numbers.";
  } else {
    f.advice = fmt::format("Check {} {}. Run `framewatch status` for details.", e.kind, e.place);
  }
  return f;
}

void ModelFit::push(const window_estimate_t& e) {
  const double step_s =
      std::clamp(1e-6 * static_cast<double>(e.window_end_us - last_us_), 0.0, 1.0);
  last_us_ = e.window_end_us;
  const bool shown = e.status == kIdentifies && std::isfinite(e.residual_ratio) &&
                     std::find(e.reason.begin(), e.reason.end(), 0) != e.reason.end();
  if (!shown) return;
  const double square = e.residual_ratio * e.residual_ratio;
  seconds_ = std::min(seconds_ + step_s, kMean_s);
  mean_ += (seconds_ > 0 ? std::min(1.0, step_s / seconds_) : 1) * (square - mean_);
  if (seconds_ < kMean_s) return;
  const double residual = std::sqrt(mean_);
  if (fits_ && residual > kMax) {
    fits_ = false;
    since_us_ = e.window_end_us - static_cast<std::int64_t>(1e6 * kMean_s);
  } else if (!fits_ && residual < kAgain) {
    fits_ = true;
  }
}

std::optional<double> ModelFit::residual() const {
  if (seconds_ <= 0) return std::nullopt;
  return std::sqrt(mean_);
}

std::optional<Finding> ModelFit::finding() const {
  if (fits_) return std::nullopt;
  Finding f;
  f.kind = FindingKind::belief;
  f.severity = severity::warning;
  f.since_us = since_us_;
  f.text = fmt::format("The model does not fit: it leaves {:.0f} % of the motion unexplained.",
                       100 * std::sqrt(mean_));
  f.advice = "Find out what the model lacks: framewatch diagnose, with a record of this motion.";
  return f;
}

}  // namespace framewatch::daemon
