#include <cmath>

#include "daemon/config/keys/section.h"
#include "daemon/config/sections/sections.h"

namespace framewatch::daemon {
namespace {

constexpr double kLongestFirst_s = 60;
constexpr std::size_t kMaxPeriods = 6;

/// Rule that the periods break; empty when they are good.
std::string problem_of(const std::vector<double>& periods_s) {
  if (periods_s.empty() || periods_s.size() > kMaxPeriods) return "must be 1 to 6 periods";
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
  section.read_into(out);
  if (section.given("directory") && out.directory.empty())
    section.problem("directory", "must not be empty");
  if (section.given("summary_s"))
    if (const std::string rule = problem_of(section.list("summary_s"));
        section.good("summary_s") && !rule.empty())
      section.problem("summary_s", rule);
  return out;
}

}  // namespace framewatch::daemon
