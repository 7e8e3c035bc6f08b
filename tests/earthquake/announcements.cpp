// SPDX-License-Identifier: MIT
#include "tests/earthquake/announcements.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace framewatch::earthquake {
namespace {

constexpr const char* kKind = "stiffness_change";

daemon::Config watched_config(const estimator::PipelineConfig& pipeline,
                              const estimator::WatchOptions& options) {
  daemon::Config out;
  out.pipeline = pipeline;
  out.pipeline.options.long_window_s = 0;
  out.watch.emplace();
  out.watch->options = options;
  out.watch->options.quiet_window_s = 0;
  return out;
}

}  // namespace

Announcer::Announcer(const estimator::PipelineConfig& config,
                     const estimator::WatchOptions& options)
    : config_(watched_config(config, options)),
      table_(config_.pipeline.parameters()),
      estimation_(config_, {}, this) {
  for (const estimator::Watched& w : watched_parameters(table_, options))
    watched_.push_back(w.least_change > 0);
}

void Announcer::push(const estimator::AccelSample& sample) {
  now_s_ = std::max(now_s_, 1e-6 * static_cast<double>(to_microseconds(sample.time)));
  estimation_.sample(sample);
}

void Announcer::finish() {
  estimation_.finish();
}

bool Announcer::knows(int parameter) const {
  const estimator::Baseline* baseline = estimation_.baseline();
  return baseline != nullptr && baseline->knows(static_cast<std::size_t>(parameter));
}

/// Reads an event: one element in `place`, its change in percent. Several elements would be
/// separated by commas. A place that is not an element means the whole building. An event without
/// a standard error has no size yet.
void Announcer::on_event(const event_t& e) {
  if (e.kind != kKind) return;
  Announcement out;
  out.at_s = std::max(now_s_, 1e-6 * static_cast<double>(e.time_us));
  out.id = e.id;
  out.state = static_cast<AnnouncementState>(e.state);
  out.ratio = 0.01 * e.value, out.std_error = 0.01 * e.std_error;
  out.sized = out.std_error > 0;  // false for NaN
  std::istringstream places(e.place.empty() ? "building" : e.place);
  for (std::string place; std::getline(places, place, ',');) {
    place.erase(0, place.find_first_not_of(' '));
    out.parameter = table_.find(place).value_or(-1);
    said_.push_back(out);
  }
}

}  // namespace framewatch::earthquake
