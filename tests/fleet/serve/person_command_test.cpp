// SPDX-License-Identifier: MIT
#include "fleet/serve/person_command.h"

#include <string>

#include <gtest/gtest.h>

#include "fleet/sds/export_command.h"
#include "fleet/serve/people.h"
#include "tests/fleet/support/own_postgres.h"
#include "tests/support/temporary.h"

namespace framewatch::fleet {
namespace person_command_test {

TEST(PersonCommand, CreatesAndRemovesAToken) {
  const test::TemporaryDirectory folder;
  const std::string file = folder.path("people");
  testing::internal::CaptureStdout();
  ASSERT_EQ(person_command({"alice", "operator", file, false}), 0);
  std::string token = testing::internal::GetCapturedStdout();
  token.pop_back();
  People people;
  ASSERT_EQ(people.read(file), "");
  ASSERT_NE(people.of_token(token), nullptr);
  EXPECT_EQ(people.of_token(token)->role, Role::operator_);
  EXPECT_EQ(person_command({"alice", "viewer", file, true}), 0);
  EXPECT_EQ(person_command({"alice", "viewer", file, true}), 2);
  EXPECT_EQ(person_command({"a b", "viewer", file, false}), 2);
}

class DescribeCommand : public OnPostgres {
 protected:
  std::string row() {
    const auto rows = look_.query(
        "SELECT concat_ws('|', title, place, latitude, network, station, retired) FROM building");
    return rows && rows->size() == 1 ? rows->front().front().value_or("") : look_.error();
  }
};

TEST_F(DescribeCommand, ChangesGivenValuesAndKeepsTheRest) {
  DescribeArguments a;
  a.building = "kobe-03";
  a.database = where_;
  a.title = "Tower";
  a.latitude = 34.5;
  a.station = "KOBE3";
  ASSERT_EQ(describe_command(a), 0);
  EXPECT_EQ(row(), "Tower||34.5|XX|KOBE3|f");
  DescribeArguments more;
  more.building = a.building;
  more.database = where_;
  more.place = "Kobe";
  more.retired = true;
  ASSERT_EQ(describe_command(more), 0);
  EXPECT_EQ(row(), "Tower|Kobe|34.5|XX|KOBE3|t");
  more.network = "x/";
  EXPECT_EQ(describe_command(more), 2);
  more.building = "../..";
  EXPECT_EQ(describe_command(more), 2);
  EXPECT_EQ(export_command({where_, "/nowhere", "", ""}), 2);  // nothing was fetched
}

}  // namespace person_command_test
}  // namespace framewatch::fleet
