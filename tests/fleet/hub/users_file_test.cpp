// SPDX-License-Identifier: MIT
#include "fleet/hub/users_file.h"

#include <gtest/gtest.h>

#include "tests/support/temporary.h"

namespace framewatch::fleet {
namespace users_file_test {

TEST(UsersFile, ABuildingMayUseOnlyItsOwnSubjects) {
  const std::string text = users_text({"kobe-03"});
  for (const char* line :
       {R"(user: "CN=kobe-03")", R"(publish: [ "fw.up.kobe-03.>" ])",
        R"(subscribe: [ "_INBOX_kobe-03.>", "fw.down.kobe-03.>", "fw.down.all.>" ])"})
    EXPECT_NE(text.find(line), std::string::npos) << line;
}

TEST(UsersFile, KeepsAdmittedUsers) {
  const test::TemporaryDirectory folder;
  UsersFile users(folder.path("."));
  ASSERT_EQ(users.read(), "");
  users.add("b");
  users.add("a");
  users.add("b");
  ASSERT_EQ(users.write(), "");
  UsersFile again(folder.path("."));
  ASSERT_EQ(again.read(), "");
  EXPECT_EQ(again.buildings(), (std::vector<std::string>{"a", "b"}));
  again.remove("a");
  ASSERT_EQ(again.write(), "");
  const std::string text = test::read_file(again.users_path());
  EXPECT_EQ(text.find("CN=a\""), std::string::npos);
  EXPECT_NE(text.find("CN=b\""), std::string::npos);
}

TEST(UsersFile, RefusesAConflictingNameWithItsLine) {
  for (const char* bad : {"operator", "worker", "page", "admin", "all", "A", "a b", "a\" }", "*"}) {
    const test::TemporaryDirectory folder;
    test::write_file(folder.path("buildings"), std::string("good\n") + bad + "\n");
    UsersFile users(folder.path("."));
    EXPECT_NE(users.read().find("buildings:2:"), std::string::npos) << bad;
  }
}

}  // namespace users_file_test
}  // namespace framewatch::fleet
