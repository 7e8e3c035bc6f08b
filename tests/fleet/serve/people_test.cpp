// SPDX-License-Identifier: MIT
#include "fleet/serve/people.h"

#include <fstream>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "daemon/base/file_digest.h"
#include "tests/support/temporary.h"

namespace framewatch::fleet {
namespace people_test {

const std::string kToken = "0123456789abcdef0123456789abcdef";

class PeopleFile : public testing::Test {
 protected:
  std::string read(const std::string& text) {
    std::ofstream(path_) << text;
    return people_.read(path_);
  }
  test::TemporaryDirectory folder_;
  std::string path_ = folder_.path("people");
  People people_;
};

TEST_F(PeopleFile, ATokenBelongsToOnePerson) {
  People written;
  written.put({"alice", Role::operator_, daemon::sha256(kToken)});
  written.put({"bob@example.org", Role::viewer, daemon::sha256("other")});
  ASSERT_EQ(written.write(path_), "");
  ASSERT_EQ(people_.read(path_), "");
  ASSERT_NE(people_.of_token(kToken), nullptr);
  EXPECT_EQ(people_.of_token(kToken)->name, "alice");
  EXPECT_EQ(people_.of_token(kToken)->role, Role::operator_);
  EXPECT_EQ(people_.of_token("other")->role, Role::viewer);
  EXPECT_EQ(people_.of_token(daemon::sha256(kToken)), nullptr);
  EXPECT_EQ(people_.of_token(""), nullptr);
  std::ifstream file(path_);
  const std::string text((std::istreambuf_iterator<char>(file)), {});
  EXPECT_EQ(text.find(kToken), std::string::npos);
}

TEST_F(PeopleFile, ANewTokenReplacesTheOldOne) {
  people_.put({"alice", Role::operator_, daemon::sha256(kToken)});
  people_.put({"alice", Role::viewer, daemon::sha256("new")});
  EXPECT_EQ(people_.of_token(kToken), nullptr);
  EXPECT_EQ(people_.all().size(), 1u);
  EXPECT_TRUE(people_.remove("alice"));
  EXPECT_FALSE(people_.remove("alice"));
}

TEST_F(PeopleFile, IgnoresCommentsAndEmptyLines) {
  EXPECT_EQ(read("# people\n\n  \n"), "");
  EXPECT_TRUE(people_.all().empty());
}

TEST_F(PeopleFile, ABrokenFileAdmitsNobody) {
  const std::string digest(64, 'a'), good = "alice operator " + digest + "\n";
  for (const auto& [text, why] :
       {std::pair(good + "bob viewer\n", ":2: must be NAME ROLE SHA256"),
        std::pair(good + "bob owner " + digest + "\n", ":2: a role is viewer or operator"),
        std::pair(good + "bob viewer " + digest.substr(1) + "\n", ":2: a SHA-256"),
        std::pair(good + good, ":2: this name occurs twice"),
        std::pair(good + "<b> viewer " + digest + "\n", ":2: a name has")}) {
    EXPECT_NE(read(text).find(why), std::string::npos) << people_.read(path_);
    EXPECT_TRUE(people_.all().empty());
  }
  EXPECT_NE(people_.read(folder_.path("none")), "");
}

}  // namespace people_test
}  // namespace framewatch::fleet
