#include "daemon/config/keys/section.h"
#include "daemon/config/sections/sections.h"

namespace framewatch::daemon {

std::optional<EventReportSettings> read_event_report(const TomlValue& document,
                                                     std::vector<TextProblem>& problems) {
  const TomlEntry* entry = document.find("event_report");
  if (entry == nullptr) return std::nullopt;
  ConfigSection section("event_report", "event_report", &entry->value, {1, 1}, problems);
  EventReportSettings out;
  section.read_into(out);
  if (section.given("directory") && out.directory.empty())
    section.problem("directory", "must not be empty");
  if (out.red_drift_ratio < out.yellow_drift_ratio)
    section.problem("red_drift_ratio", "must not be below yellow_drift_ratio");
  if (out.red_loss_ratio < out.yellow_loss_ratio)
    section.problem("red_loss_ratio", "must not be below yellow_loss_ratio");
  return out;
}

}  // namespace framewatch::daemon
