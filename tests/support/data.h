// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

namespace framewatch::test {

/// Path of a file below FRAMEWATCH_DATA (default: ../shared/data); empty when it is not there.
std::optional<std::string> data_path(const std::string& relative);

}  // namespace framewatch::test

/// Skips the test, saying which file is missing, when the real data are not on this machine.
#define FRAMEWATCH_DATA_OR_SKIP(variable, relative)                                       \
  const auto variable##_found = framewatch::test::data_path(relative);                    \
  if (!variable##_found) GTEST_SKIP() << "no " << (relative) << " under FRAMEWATCH_DATA"; \
  const std::string variable = *variable##_found
