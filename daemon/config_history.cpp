#include <cmath>
#include <filesystem>

#include "daemon/config_parts.h"
#include "daemon/config_section.h"

namespace framewatch::daemon {
namespace {

constexpr double kLongestFirst_s = 60;
constexpr std::size_t kMostPeriods = 6;

/// Rule that the periods break; empty when they are good.
std::string problem_of(const std::vector<double>& periods_s) {
  if (periods_s.empty() || periods_s.size() > kMostPeriods) return "must be 1 to 6 periods";
  if (periods_s.front() > kLongestFirst_s) return "must begin with at most 60 s";
  for (std::size_t i = 0; i < periods_s.size(); ++i) {
    if (periods_s[i] != std::floor(periods_s[i])) return "must be whole seconds";
    if (i > 0 &&
        (periods_s[i] <= periods_s[i - 1] || std::fmod(periods_s[i], periods_s[i - 1]) > 0))
      return "must ascend, each a multiple of the one before";
  }
  return {};
}

}  // namespace

std::optional<HistorySettings> read_history(const TomlValue& document,
                                            std::vector<TextProblem>& problems) {
  const TomlEntry* entry = document.find("history");
  if (entry == nullptr) return std::nullopt;
  ConfigSection section("history", "history", &entry->value, {1, 1}, problems);
  HistorySettings out;
  out.directory = section.text("directory");
  if (section.given("directory") && out.directory.empty())
    section.problem("directory", "must not be empty");
  out.rotate_s = section.number("rotate_s");
  out.rotate_mb = section.number("rotate_mb");
  out.compress = section.boolean("compress");
  out.keep_days = section.number("keep_days");
  out.keep_gb = section.number("keep_gb");
  out.event_before_s = section.number("event_before_s");
  out.event_after_s = section.number("event_after_s");
  out.resolution_mps2 = section.number("resolution_mps2");
  out.keep_summary_days = section.number("keep_summary_days");
  if (!section.given("summary_s")) return out;
  const TomlValue& given = *section.value("summary_s");
  const auto count = given.kind == TomlKind::array ? given.items.size() : 1;
  const std::vector<double> periods_s = section.grid("summary_s", {static_cast<int>(count)});
  if (!section.good("summary_s")) return out;
  if (const std::string rule = problem_of(periods_s); !rule.empty()) {
    section.problem("summary_s", rule);
    return out;
  }
  out.summary_s.assign(periods_s.begin(), periods_s.end());
  return out;
}

void place_history(Config& config) {
  if (!config.history) return;
  const std::filesystem::path beside = std::filesystem::path(config.path).parent_path();
  config.history->directory = (beside / config.history->directory).string();
}

}  // namespace framewatch::daemon
