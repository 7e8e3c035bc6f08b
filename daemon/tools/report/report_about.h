// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "daemon/config/keys/about_options.h"
#include "daemon/config/sections/config_problems.h"

namespace framewatch::daemon {

/// Reads a file of `report --about` with its photographs, whose `file` then holds the picture as a
/// data URL. Returns nullopt, with every problem, if a key or a photograph is wrong.
std::optional<ReportAbout> read_about(const std::string& path,
                                      std::vector<ConfigProblem>& problems);

/// Returns HTML for the head of a report: number, date, laboratory, client and author, those that
/// are given. Empty without any.
std::string about_section(const ReportAbout& about);
/// Returns HTML with the photographs. Empty without any.
std::string photograph_section(const ReportAbout& about);

}  // namespace framewatch::daemon
