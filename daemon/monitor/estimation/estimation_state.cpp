// SPDX-License-Identifier: MIT
// Saves and loads the state of an estimation, and takes it over from another one.
#include <algorithm>
#include <iterator>
#include <limits>
#include <utility>

#include "daemon/monitor/estimation/estimation.h"

namespace framewatch::daemon {
namespace {

/// Archives the tuning of the filters, if it is known: `parameters` values, and noise of `axes`
/// channels.
template <typename Archive>
void archive_tuning(Archive& a, int parameters, std::size_t axes,
                    std::optional<estimator::Tuning>& tuning) {
  bool known = tuning.has_value();
  a(known);
  if (!known) return tuning.reset();
  if (!tuning) tuning.emplace(estimator::Tuning{Eigen::VectorXd(parameters), {}});
  tuning->noise_density.resize(axes);
  for (double& value : tuning->theta0) a.within(value, std::numeric_limits<double>::min(), a.kMax);
  for (double& value : tuning->noise_density)
    a.within(value, std::numeric_limits<double>::min(), a.kMax);
  a(tuning->found_right);
}

template <typename Archive>
void archive_pipeline(Archive& a, estimator::Pipeline& pipeline) {
  if constexpr (!Archive::kReading)
    pipeline.save(a);
  else if (!pipeline.load(a))
    a.refuse();
}

/// Returns the kinds of events that only the owner of a section can clear.
std::vector<std::string> kinds_of(const std::string& section) {
  if (section == "lcm")
    return {"two_senders", "sequence_leap", "duplicates", "losses", "channel_table"};
  if (section == "can")
    return {"bus_off", "interface_gone", "emergency", "sequence_leap", "duplicates", "losses"};
  if (section == "counts") return {"clock_step"};
  if (section == "window")
    return {"absurd_samples", "channel_silent", "channel_stuck", "channel_rate", "channel_clock"};
  if (section == "weather") return {"weather"};
  if (section == "watch") return {"stiffness_change"};
  if (section == "gap") return {"gap", "channel_doubted"};
  return {};
}

}  // namespace

/// Calls `visit` with every section's name and a function that archives it, in an order in which
/// each section needs only earlier ones.
template <typename Visit>
void Estimation::each_section(const Visit& visit) {
  visit("counts", [this](auto& a) {
    a(seconds_);
    if (a.since(18)) a(clock_events_);
    for (std::int64_t* count : {&windows_, &absurd_temperatures_}) a.within(*count, 0, a.kMaxCount);
  });
  visit("events", [this](auto& a) { a(raised_); });
  if (weather_.any()) visit("weather", [this](auto& a) { a(weather_); });
  visit("lcm", [this](auto& a) { a(intake_); });
  visit("can", [this](auto& a) { a(can_, can_events_); });
  visit("tuning", [this](auto& a) {
    if (!std::decay_t<decltype(a)>::kReading) tuning_ = pipeline_.tuning();
    archive_tuning(a, pipeline_.parameters().size(), config_.pipeline.axes.size(), tuning_);
  });
  // The events of channels compare the pipeline's counters with earlier ones, so both are one
  // section.
  visit("window", [this](auto& a) {
    a(channel_events_);
    if (a.since(18)) a(stamp_events_);
    a(newest_us_);
    archive_pipeline(a, pipeline_);
  });
  if (watch_) {
    visit("baseline", [this](auto& a) {
      const estimator::Baseline* const now = baseline();
      const std::optional<estimator::Baseline> given =
          now == nullptr ? std::nullopt : std::optional(*now);
      watch_->archive_learned(a);
      const bool another = given && (baseline() == nullptr || !baseline()->holds(*given));
      if (std::decay_t<decltype(a)>::kReading && another) a.refuse();
    });
    visit("watch", [this](auto& a) {
      watch_->archive_detection(a);
      a(strong_, *recovery_);
    });
  }
  if (gap_)
    visit("gap", [this](auto& a) {
      a(*gap_);
      a.any_size(noise_density_);
      if (!noise_density_.empty() && noise_density_.size() != config_.pipeline.axes.size())
        a.refuse();
    });
  if (shaking_)
    visit("event_report", [this](auto& a) {
      a(*shaking_, counted_before_);
      findings_.resize(a.count(findings_.size()));
      for (event_t& e : findings_) archive_event(a, e);
    });
}

std::vector<StateSection> Estimation::save() {
  std::vector<StateSection> sections;
  each_section([&](const char* name, const auto& archive) {
    estimator::StateWriter writer;
    archive(writer);
    sections.push_back({name, writer.bytes()});
  });
  return sections;
}

std::vector<std::string> Estimation::section_names() {
  std::vector<std::string> names;
  each_section([&](const char* name, const auto&) { names.emplace_back(name); });
  return names;
}

std::string Estimation::load(const std::vector<StateSection>& sections) {
  std::string spoilt;
  each_section([&](const char* name, const auto& archive) {
    const auto section = std::ranges::find(sections, name, &StateSection::name);
    if (section == sections.end() || !spoilt.empty()) return;
    estimator::StateReader reader(section->bytes, section->format);
    archive(reader);
    if (!reader.whole()) spoilt = name;
  });
  return spoilt;
}

void Estimation::went_without(const std::vector<std::string>& lost) {
  const auto is_lost = [&](const char* name) {
    return std::find(lost.begin(), lost.end(), name) != lost.end();
  };
  if (watch_) watch_->resumed();
  if (is_lost("window")) {
    if (tuning_ && !is_lost("tuning")) pipeline_.start_tuned(*tuning_);
    std::fill(counted_before_.begin(), counted_before_.end(), estimator::AxisCounters{});
  }
  for (const std::string& section : lost)
    for (const std::string& kind : kinds_of(section)) {
      std::vector<event_t> gone = raised_.take(kind);
      std::move(gone.begin(), gone.end(), std::back_inserter(to_withdraw_));
    }
}

void Estimation::take_over(Estimation& before, bool keep_window) {
  // Both have the same structure, so a part can fail to fit only because of its settings.
  const auto copy = [](auto& from, auto& to) {
    estimator::StateWriter writer;
    writer(from);
    estimator::StateReader reader(writer.bytes());
    reader(to);
    return reader.whole();
  };
  copy(before.seconds_, seconds_);
  copy(before.intake_, intake_);
  copy(before.can_, can_);
  copy(before.can_events_, can_events_);
  copy(before.channel_events_, channel_events_);
  copy(before.stamp_events_, stamp_events_);
  copy(before.clock_events_, clock_events_);
  copy(before.raised_, raised_);
  copy(before.weather_, weather_);
  windows_ = before.windows_;
  absurd_temperatures_ = before.absurd_temperatures_;
  newest_us_ = before.newest_us_;
  live_ = before.live_;
  if (keep_window) {
    estimator::StateWriter writer;
    before.pipeline_.save(writer);
    estimator::StateReader reader(writer.bytes());
    (void)pipeline_.load(reader);
    noise_density_ = before.noise_density_;
  }
  const estimator::Baseline* given = baseline();
  const bool same_baseline =
      given == nullptr || (before.baseline() != nullptr && before.baseline()->holds(*given));
  const bool watch_goes_on = watch_ && before.watch_ && same_baseline &&
                             copy(*before.watch_, *watch_) && copy(before.strong_, strong_) &&
                             copy(*before.recovery_, *recovery_);
  if (!watch_goes_on) {
    begin_watch();
    withdraw("stiffness_change");
  } else if (!keep_window && config_.watch->options.amplitude) {
    watch_->forget_quiet();  // amplitudes are relative to the noise, which has changed
  }
  if (shaking_ && before.shaking_ && copy(*before.shaking_, *shaking_)) {
    counted_before_ = before.counted_before_;
    findings_ = before.findings_;
  }
  const bool gap_goes_on = gap_ && before.gap_ && copy(*before.gap_, *gap_);
  if (!gap_goes_on) {
    begin_gap();
    withdraw("gap");
  }
}

}  // namespace framewatch::daemon
