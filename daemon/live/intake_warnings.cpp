#include "daemon/live/intake_warnings.h"

#include <fmt/core.h>

#include "daemon/base/log.h"

namespace framewatch::daemon {
void IntakeWarnings::look(const Estimation& estimation, const LiveState& state,
                          std::int64_t now_us) {
  if (!second_.due(now_us)) return;
  const estimator::PipelineCounters pipeline = estimation.pipeline().counters();
  const drivers::IntakeCounters& intake = estimation.intake().counters();
  std::int64_t late = 0, rejected = 0;
  for (const estimator::AxisCounters& axis : pipeline.axes) {
    late += axis.late;
    rejected += axis.rejected;
  }
  std::string news;
  add(news, seen_[0], intake.malformed, "undecodable messages");
  add(news, seen_[1], intake.duplicate, "duplicate messages");
  add(news, seen_[2], estimation.intake().lost(), "messages lost");
  add(news, seen_[3], state.queue_dropped, "of them dropped by the full queue");
  add(news, seen_[4], late, "samples late");
  add(news, seen_[5], rejected, "samples rejected");
  add(news, seen_[6], estimation.intake().backwards(), "steps back in time");
  add(news, seen_[7], pipeline.interruptions, "gaps that restarted the window");
  if (!news.empty()) log(LogLevel::warning, news);
  for (const std::string& name : estimation.intake().binding().unbound())
    if (!said_unbound_) log(LogLevel::warning, fmt::format("no message carries {} yet", name));
  said_unbound_ = true;
}

void IntakeWarnings::add(std::string& news, std::int64_t& seen, std::int64_t now,
                         const char* what) {
  if (now > seen) news += fmt::format("{}{} {}", news.empty() ? "" : ", ", now - seen, what);
  seen = now;
}

}  // namespace framewatch::daemon
