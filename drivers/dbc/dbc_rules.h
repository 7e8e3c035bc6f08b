// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "drivers/dbc/dbc.h"

namespace framewatch::drivers {

/// A rule that a message breaks; `line` is that of the signal or message.
struct DbcRule {
  std::int64_t line;
  std::string message;
};
/// Returns the rules that a message breaks, apart from its syntax.
std::vector<DbcRule> broken_rules(const DbcMessage& message);

}  // namespace framewatch::drivers
