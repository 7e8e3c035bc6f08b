// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace framewatch::daemon {

struct ReportPhotograph {
  std::string file, caption;
};

/// Content of the file of `report --about`: what a client's report says of people and place. Texts
/// may be empty.
struct ReportAbout {
  std::string date, laboratory, client, author, number;
  std::vector<ReportPhotograph> photographs;
};

}  // namespace framewatch::daemon
