// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

namespace framewatch::test {

/// Returns the path of a file below FRAMEWATCH_DATA (default: ../shared/data); empty if it does
/// not exist.
std::optional<std::string> data_path(const std::string& relative);

}  // namespace framewatch::test

/// Skips the test and names the missing file if the real data are not on this machine.
#define FRAMEWATCH_DATA_OR_SKIP(variable, relative)                                       \
  const auto variable##_found = framewatch::test::data_path(relative);                    \
  if (!variable##_found) GTEST_SKIP() << "no " << (relative) << " under FRAMEWATCH_DATA"; \
  const std::string variable = *variable##_found
