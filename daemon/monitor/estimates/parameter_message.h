// SPDX-License-Identifier: MIT
#pragma once

#include <framewatch/parameter_table_t.hpp>

#include "daemon/config/config.h"
#include "estimator/structure/parameter_table.h"

namespace framewatch::daemon {

/// Returns a message with the parameters of a table, and with the structure, configuration and
/// program that they belong to. Time, design and windows are left to the caller.
parameter_table_t parameter_message(const Config& config, const estimator::ParameterTable& table);

}  // namespace framewatch::daemon
