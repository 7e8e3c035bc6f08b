#include "daemon/monitor/history/history_report.h"

#include <csignal>
#include <string>
#include <vector>

#include <framewatch/event_t.hpp>
#include <framewatch/history_status_t.hpp>

#include "daemon/base/clocks.h"
#include "daemon/base/log.h"
#include "daemon/monitor/events/event_words.h"
#include "drivers/files/encoded.h"

namespace framewatch::daemon {
HistoryReport::HistoryReport(const Config& config, lcm::LCM& lcm) : config_(config), lcm_(lcm) {
  if (!config.history) return;
  std::signal(SIGXFSZ, SIG_IGN);  // a file that may not grow is an error like a disk that is full
  history_.emplace(config);
}

std::vector<event_t> HistoryReport::check(std::int64_t now_us) {
  if (!history_) return {};
  history_->tick(steady_clock_us());
  if (!second_.due(now_us)) return {};
  const history_status_t status = history_->status();
  lcm_.publish(config_.lcm.prefix + "HISTORY", &status);
  const std::string channel = config_.lcm.prefix + "EVENT";
  std::vector<event_t> news = monitor_.look(now_us, status, history_->set_aside());
  for (const event_t& event : news) {
    log(event.state != event_state::cleared ? LogLevel::error : LogLevel::notice,
        "history: " + event.message);
    const std::vector<std::uint8_t> bytes = drivers::encoded(event);
    lcm_.publish(channel, bytes.data(), static_cast<unsigned>(bytes.size()));
    history_->message(channel, bytes);
    raised_.note(event);
  }
  return news;
}

}  // namespace framewatch::daemon
