#pragma once

#include <string>
#include <vector>

namespace framewatch::daemon {

/// A test of one part instead of a building: one story, one frame. A base that the records do not
/// have is at rest.
struct ComponentTest {
  std::string force;          ///< column of the records: force at floor 1, N; "" when there is none
  bool displacement = false;  ///< floor 1 measures displacement relative to the base, m
  bool prescribed = false;    ///< the motion is prescribed, the force measured

  bool any() const { return !force.empty() || displacement; }
};

struct DiagnoseArguments {
  std::string config;
  std::vector<std::string> train, holdout;  ///< record files and LCM event logs
  std::string event;                 ///< id of a gap event: its stored samples instead of those
  std::string out;                   ///< directory of diagnosis.json, report.html, model.toml
  std::vector<std::string> without;  ///< names of effects that are not looked for
  ComponentTest component;
  int threads = 0;  ///< 0: as many as the machine has
  bool quiet = false;
};

/// framewatch diagnose. Exit code: 0 adequate or explained, 1 a gap remains, 2 bad usage or input.
int diagnose_command(const DiagnoseArguments& arguments);

}  // namespace framewatch::daemon
