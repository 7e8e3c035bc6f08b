// SPDX-License-Identifier: MIT
#include "fleet/uplink/newest_messages.h"

#include <algorithm>

#include <framewatch/acknowledged_t.hpp>

#include "drivers/files/encoded.h"
#include "tests/fleet/uplink/uplink_fixture.h"

namespace framewatch::fleet {
namespace newest_messages_test {

class NewestRules : public test::UplinkTest {};

TEST_F(NewestRules, ReportsChangesOfLocalAcknowledgements) {
  const auto said = [&] {
    return std::count_if(hub_.published.begin(), hub_.published.end(),
                         [](const Message& m) { return m.subject == "fw.up.a.acknowledged"; });
  };
  acknowledged_t none{};
  acknowledged_t one{};
  one.events = 1;
  one.id = {7};
  one.kind = {"gap"};
  one.place = {""};
  one.since_us = {1};
  one.who = {"alice"};
  one.comment = {""};
  begin();
  const auto hear = [&](const acknowledged_t& message) {
    uplink_->heard("ACKNOWLEDGED", drivers::encoded(message));
    run(1);
  };
  hear(none);
  hear(none);
  EXPECT_EQ(said(), 1);
  hear(one);
  hear(one);
  EXPECT_EQ(said(), 2);
}

}  // namespace newest_messages_test
}  // namespace framewatch::fleet
