// SPDX-License-Identifier: MIT
#include "drivers/lcm/message_layout.h"

#include <cstdio>
#include <cstdlib>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include <framewatch/message_layouts.hpp>

#include "tests/support/temporary.h"

// Tests cmake/lcm-layouts.awk, which the build runs over lcmtypes/*.lcm.
namespace framewatch::drivers {
namespace message_layout_test {

struct Generated {
  std::string header;  ///< empty: none was written
  std::string errors;  ///< without the folder
  int status = 0;
};

/// Runs the script on one file, a_t.lcm.
Generated generate(const std::string& lcm) {
  const test::TemporaryDirectory directory;
  test::write_file(directory.path("a_t.lcm"), lcm);
  const std::string command =
      "awk -f " FRAMEWATCH_SOURCE_DIR "/cmake/lcm-layouts.awk -v out=" + directory.path("a.hpp") +
      " " + directory.path("a_t.lcm") + " 2>" + directory.path("errors");
  Generated out;
  out.status = std::system(command.c_str());
  out.errors = test::read_file(directory.path("errors"));
  if (const auto at = out.errors.find("a_t.lcm"); at != std::string::npos) out.errors.erase(0, at);
  for (const std::string& name : directory.names())
    if (name == "a.hpp") out.header = test::read_file(directory.path(name));
  return out;
}

std::string message(const std::string& fields) {
  return "package framewatch;\n// LCM channel: A\nstruct a_t {\n" + fields + "}\n";
}

TEST(LcmLayouts, FieldsOfEveryKind) {
  const Generated made =
      generate(message("  int32_t n, m;  // [comment]\n"
                       "  int8_t small[3]; /* string s;\n"
                       "  more */ string name[n];\n"
                       "  double last[m];\n"));
  EXPECT_EQ(made.status, 0) << made.errors;
  for (const char* field :
       {R"({"n", 4, 1, -1, true})", R"({"m", 4, 1, -1, true})", R"({"small", 1, 3, -1, false})",
        R"({"name", 0, 1, 0, false})", R"({"last", 8, 1, 1, false})",
        R"({"a_t", &a_t::getHash, "A", kAFields})"})
    EXPECT_NE(made.header.find(field), std::string::npos) << field << "\n" << made.header;
}

TEST(LcmLayouts, AMalformedFileFailsWithItsLine) {
  const std::pair<std::string, const char*> cases[] = {
      {"", "a_t.lcm:1: an empty file"},
      {"package other;\n", R"(a_t.lcm:1: expected "framewatch", found "other")"},
      {message(""), "a_t.lcm:4: a message without a field"},
      {message("  int32_t n\n  double a;\n"), R"(a_t.lcm:5: expected ";", found "double")"},
      {message("  event_t e;\n"), R"(a_t.lcm:4: the type "event_t" is none of)"},
      {message("  double a[n];\n"), R"(a_t.lcm:4: the length "n" is no number)"},
      {message("  int64_t n;\n  double a[n];\n"), "a_t.lcm:5: a length must be one int32_t"},
      {message("  double a[2][2];\n"), "a_t.lcm:4: arrays have one dimension"},
      {message("  double a;\n  double a;\n"), R"(a_t.lcm:5: a second field "a")"},
      {message("  double a;\n") + "struct b_t { double b; }\n",
       R"(a_t.lcm:6: a file holds one message: "struct")"},
      {"package framewatch;\nstruct b_t { double a; }\n",
       R"(a_t.lcm:2: the struct is named "b_t")"},
      {"package framewatch;\nstruct a_t { double a; }\n", "a_t.lcm:1: no comment line"},
      {"package framewatch;\n// LCM channel: A B\nstruct a_t { double a; ",
       R"(a_t.lcm:3: expected "}")"},
  };
  for (const auto& [lcm, error] : cases) {
    const Generated made = generate(lcm);
    EXPECT_NE(made.status, 0) << lcm;
    EXPECT_EQ(made.errors.rfind(error, 0), 0u) << made.errors << "instead of " << error;
    EXPECT_TRUE(made.header.empty()) << lcm;
  }
}

TEST(LcmLayouts, OffsetsCountFromTheFingerprint) {
  static_assert(offset_of(kAccelFields, "time_us") == 8);
  static_assert(offset_of(kAccelFields, "accel_abs_mps2") == 28);
}

}  // namespace message_layout_test
}  // namespace framewatch::drivers
