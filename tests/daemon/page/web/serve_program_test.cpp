// SPDX-License-Identifier: MIT
#include <cstdlib>
#include <string>

#include <gtest/gtest.h>

#include "tests/support/child.h"
#include "tests/support/temporary.h"

namespace framewatch::daemon {
namespace serve_program_test {

TEST(ServeProgram, ReportsATooLowLimitOfOpenFiles) {
  if (const char* reason = std::getenv("FRAMEWATCH_NO_MULTICAST")) GTEST_SKIP() << reason;
  const test::TemporaryDirectory directory;
  const std::string said = directory.path("said");
  test::Child serve(
      {"/bin/sh", "-c", "ulimit -n 600 && exec \"$0\" serve \"$1\" --port 0 >\"$2\" 2>&1",
       FRAMEWATCH_PROGRAM, FRAMEWATCH_SOURCE_DIR "/configs/table_two_story.toml", said});
  EXPECT_EQ(serve.wait(), 2);
  EXPECT_NE(test::read_file(said).find("may open only 600: raise ulimit -n"), std::string::npos)
      << test::read_file(said);
}

}  // namespace serve_program_test
}  // namespace framewatch::daemon
