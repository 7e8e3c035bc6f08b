// SPDX-License-Identifier: MIT
// session.json of a recorded session, as page and report read it.
#include "daemon/tools/report/session_file.h"
#include "tests/fuzz/targets.h"

namespace framewatch::test {
namespace {

daemon::SessionFile good_session() {
  daemon::SessionFile s;
  s.state = "finished";
  s.request = {"sweep", "me", "none", 60, 0.25, 5};
  s.config_path = "c.toml";
  s.config_sha256 = "00ff";
  s.version = "0.1.0";
  s.began_us = s.trigger_us = 1'700'000'000'000'000;
  s.end_us = s.began_us + 60'000'000;
  s.triggered_by = "base-x";
  s.ended_by = "length";
  s.messages = 1;
  s.check.resize(1);
  s.run.resize(1);
  s.stages.resize(1);
  s.files = {"raw.lcmlog"};
  s.problems = {"one"};
  return s;
}

void read_session(Bytes input) {
  const InputFile file(input);
  std::string error;
  const auto session = daemon::read_session_file(file.path(), error);
  require(session.has_value() == error.empty(), "a session or the reason");
  if (session) (void)daemon::session_json(*session);
}

std::vector<std::string> session_seeds() {
  return {daemon::session_json(good_session()), daemon::session_json({}), "{}"};
}

}  // namespace

const FuzzTarget kSessionTarget{"session", &read_session, &session_seeds};

}  // namespace framewatch::test
