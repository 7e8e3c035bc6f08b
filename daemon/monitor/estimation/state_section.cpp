#include "daemon/monitor/estimation/state_section.h"

#include <algorithm>
#include <array>

namespace framewatch::daemon {
namespace {

struct Description {
  std::string_view name, without;
  std::vector<std::string> grounds;
};

/// In the order of the file.
const std::array<Description, 10>& descriptions() {
  static const std::array<Description, 10> all{{
      {"counts", "counters of windows begin at 0", {}},
      {"events", "raised findings and their acknowledgements are forgotten", {}},
      {"lcm", "nodes are heard as for the first time", {"channel", "lcm"}},
      {"can", "CAN buses are heard as for the first time", {"channel", "can", "estimator"}},
      {"tuning", "filters are tuned anew", {"structure", "channel", "parameters"}},
      {"window", "the window begins anew", {"structure", "channel", "estimator", "long window"}},
      {"baseline",
       "baselines and their dependence on amplitude and temperature are learned anew",
       {"structure", "parameters"}},
      {"watch",
       "evidence for changes is collected anew, and changes that last are announced again",
       {"structure", "parameters", "estimator", "long window", "watch"}},
      {"gap",
       "the model that runs beside the building is learned anew",
       {"structure", "channel", "estimator", "gap"}},
      {"event_report",
       "a strong motion under way is reported from here on",
       {"structure", "channel", "estimator"}},
  }};
  return all;
}

const Description* find(std::string_view name) {
  const auto& all = descriptions();
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const Description& d) { return d.name == name; });
  return found == all.end() ? nullptr : &*found;
}

}  // namespace

std::string_view without_section(std::string_view name) {
  const Description* found = find(name);
  return found == nullptr ? std::string_view{} : found->without;
}

const std::vector<std::string>& grounds_of_section(std::string_view name) {
  static const std::vector<std::string> none;
  const Description* found = find(name);
  return found == nullptr ? none : found->grounds;
}

}  // namespace framewatch::daemon
