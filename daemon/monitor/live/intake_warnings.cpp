#include "daemon/monitor/live/intake_warnings.h"

#include <utility>

#include <fmt/core.h>

#include "daemon/base/log.h"

namespace framewatch::daemon {
void IntakeWarnings::look(const LiveEstimation& live, std::int64_t now_us) {
  if (!second_.due(now_us)) return;
  const Estimation& estimation = live.estimation();
  const drivers::ReceiverCounters dropped = live.dropped();
  const estimator::PipelineCounters pipeline = estimation.pipeline().counters();
  const drivers::IntakeCounters& intake = estimation.intake().counters();
  const std::vector<estimator::AxisCounters> axes = estimation.axis_counters();
  std::int64_t late = 0, rejected = 0;
  std::string rejected_of;
  rejected_.resize(axes.size());
  for (std::size_t a = 0; a < axes.size(); ++a) {
    late += axes[a].late;
    rejected += axes[a].rejected;
    if (axes[a].rejected > std::exchange(rejected_[a], axes[a].rejected))
      rejected_of += (rejected_of.empty() ? "" : " ") + estimation.pipeline().axes()[a].name;
  }
  std::string news;
  add(news, seen_[0], intake.malformed, "undecodable messages");
  add(news, seen_[1], intake.duplicate, "duplicate messages");
  add(news, seen_[2], estimation.intake().lost(), "messages lost");
  add(news, seen_[3], live.state().queue_dropped, "messages dropped by a full queue");
  add(news, seen_[4], late, "samples late");
  add(news, seen_[5], rejected, "samples rejected", rejected_of);
  add(news, seen_[6], estimation.intake().backwards(), "steps back in time");
  add(news, seen_[12], intake.other_sender, "messages of a second sender");
  add(news, seen_[7], pipeline.interruptions, "gaps that restarted the window");
  add(news, seen_[8], dropped.from_elsewhere, "datagrams from elsewhere dropped");
  add(news, seen_[9], dropped.malformed, "datagrams that are no LCM");
  add(news, seen_[10], dropped.unfinished, "messages of which a part never came");
  add(news, seen_[11], dropped.overflowed, "datagrams dropped by the kernel's full buffer");
  if (!news.empty()) log(LogLevel::warning, news);
  for (const std::string& name : estimation.intake().binding().unbound())
    if (!said_unbound_) log(LogLevel::warning, fmt::format("no message carries {} yet", name));
  said_unbound_ = true;
}

void IntakeWarnings::add(std::string& news, std::int64_t& seen, std::int64_t now, const char* what,
                         const std::string& of) {
  if (now > seen)
    news += fmt::format("{}{} {}{}", news.empty() ? "" : ", ", now - seen, what,
                        of.empty() ? "" : " (" + of + ")");
  seen = now;
}

}  // namespace framewatch::daemon
