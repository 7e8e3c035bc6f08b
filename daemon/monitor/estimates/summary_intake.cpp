#include "daemon/monitor/estimates/summary_intake.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include <framewatch/status_t.hpp>
#include <framewatch/window_estimate_t.hpp>

#include "daemon/base/clocks.h"
#include "drivers/lcm/message_check.h"

namespace framewatch::daemon {

SummaryIntake::SummaryIntake(const std::string& prefix, std::int64_t shortest_s,
                             std::function<void()> before_other_names)
    : estimate_(prefix + "ESTIMATE"),
      late_(prefix + "ESTIMATE_LATE"),
      table_(prefix + "PARAMETERS"),
      status_(prefix + "STATUS"),
      event_(prefix + "EVENT"),
      acknowledged_(prefix + "ACKNOWLEDGED"),
      before_other_names_(std::move(before_other_names)),
      collector_(kSecond_us * shortest_s) {}

std::optional<SummaryIntake::Kind> SummaryIntake::kind_of(const std::string& channel) const {
  return channel == estimate_       ? Kind::estimate
         : channel == late_         ? Kind::late
         : channel == table_        ? Kind::table
         : channel == status_       ? Kind::status
         : channel == event_        ? Kind::event
         : channel == acknowledged_ ? Kind::acknowledged
                                    : std::optional<Kind>();
}

SummaryIntake::Taken SummaryIntake::take(Kind kind, std::span<const std::uint8_t> bytes) {
  Taken out;
  switch (kind) {
    case Kind::estimate:
      if (const auto e = drivers::decoded<window_estimate_t>(bytes)) {
        out.period = collector_.ends_before(*e) && end_period();
        collector_.add(*e);
        newest_us_ = std::max(newest_us_, e->window_end_us);
      }
      break;
    case Kind::late:
      if (const auto e = drivers::decoded<window_estimate_t>(bytes)) collector_.add_late(*e);
      break;
    case Kind::table:
      if (const auto t = drivers::decoded<parameter_table_t>(bytes)) {
        if (collector_.ends_before(*t)) {
          out.period = end_period();
          before_other_names_();
          batch_.periods.clear();
        }
        collector_.add(*t);
      }
      break;
    case Kind::status:
      if (const auto s = drivers::decoded<status_t>(bytes)) {
        out.period = collector_.ends_before(*s) && end_period();
        collector_.add(*s);
      }
      break;
    case Kind::event:
      if (auto e = drivers::decoded<event_t>(bytes)) {
        batch_.events.push_back(std::move(*e));
        out.news = true;
      }
      break;
    case Kind::acknowledged:
      if (auto a = drivers::decoded<acknowledged_t>(bytes)) {
        batch_.acknowledged.push_back(std::move(*a));
        out.news = true;
      }
      break;
  }
  return out;
}

bool SummaryIntake::end_period() {
  std::vector<PeriodData> periods = collector_.take_late();
  if (!collector_.empty()) periods.push_back(collector_.take());
  if (periods.empty()) return false;
  batch_.parameters = collector_.parameters();
  batch_.channels = collector_.channels();
  std::move(periods.begin(), periods.end(), std::back_inserter(batch_.periods));
  return true;
}

}  // namespace framewatch::daemon
