#pragma once

#include <optional>

#include <framewatch/parameter_table_t.hpp>
#include <framewatch/summary_t.hpp>

#include "daemon/base/sqlite_file.h"
#include "fleet/message/key.h"

namespace framewatch::fleet {

/// A period of a history as a message. Parameters are in the order of `table` where that is of the
/// configuration of the period's time, else in that of the history. Empty when the period is not
/// there or cannot be read.
std::optional<summary_t> summary_message(daemon::SqliteFile& history, const SummaryKey& key,
                                         const std::optional<parameter_table_t>& table);

}  // namespace framewatch::fleet
