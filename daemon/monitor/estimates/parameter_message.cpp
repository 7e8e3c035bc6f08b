// SPDX-License-Identifier: MIT
#include "daemon/monitor/estimates/parameter_message.h"

#include <cstdint>

namespace framewatch::daemon {

parameter_table_t parameter_message(const Config& config, const estimator::ParameterTable& table) {
  parameter_table_t m{};
  m.structure = config.pipeline.structure.name;
  m.config_sha256 = config.sha256;
  m.version = FRAMEWATCH_VERSION;
  m.parameters = table.size();
  for (int p = 0; p < table.size(); ++p) {
    m.name.push_back(table[p].name);
    m.unit.push_back(table[p].unit);
    m.kind.push_back(static_cast<std::int32_t>(table[p].kind));
    m.story.push_back(table[p].story);
  }
  return m;
}

}  // namespace framewatch::daemon
