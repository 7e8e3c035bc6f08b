// SPDX-License-Identifier: MIT
#include "daemon/monitor/service/latest_messages.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "drivers/files/encoded.h"

namespace framewatch::daemon {
namespace latest_messages_test {

status_t status(std::int64_t windows) {
  status_t m{};
  m.windows = windows;
  return m;
}

TEST(LatestMessages, KeepTheLatestOfEachChannelAndReturnTheChangedOne) {
  LatestMessages latest("A_");
  EXPECT_EQ(latest.update("A_STATUS", drivers::encoded(status(1))), DaemonMessage::status);
  EXPECT_EQ(latest.update("A_STATUS", drivers::encoded(status(2))), DaemonMessage::status);
  EXPECT_EQ(latest.update("A_EVENT", drivers::encoded(event_t{})), DaemonMessage::event);
  ASSERT_TRUE(latest.status);
  EXPECT_EQ(latest.status->windows, 2);
  EXPECT_TRUE(latest.event);
  EXPECT_FALSE(latest.service);
  latest.forget(DaemonMessage::status);
  EXPECT_FALSE(latest.status);
  EXPECT_TRUE(latest.event);
}

TEST(LatestMessages, IgnoreForeignAndMalformedMessages) {
  LatestMessages latest("A_");
  std::vector<std::uint8_t> payload = drivers::encoded(status(1));
  EXPECT_TRUE(latest.update("A_STATUS", payload));
  EXPECT_FALSE(latest.update("STATUS", drivers::encoded(status(2))));
  EXPECT_FALSE(latest.update("A_ESTIMATE_10S", drivers::encoded(window_estimate_t{})));
  EXPECT_FALSE(latest.update("A_SERVICE", payload));
  payload.pop_back();
  EXPECT_FALSE(latest.update("A_STATUS", payload));
  EXPECT_FALSE(latest.update("A_STATUS", {}));
  EXPECT_EQ(latest.status->windows, 1);
  EXPECT_FALSE(latest.service);
}

TEST(LatestMessages, NameChannelsAndTypes) {
  const std::vector<std::string> expected = {"A_SERVICE", "A_MODEL_FIT", "A_EVENT"};
  EXPECT_EQ(LatestMessages("A_").channels(
                {DaemonMessage::service, DaemonMessage::model_fit, DaemonMessage::event}),
            expected);
  EXPECT_STREQ(LatestMessages::type_name(DaemonMessage::parameters), "parameter_table_t");
  EXPECT_STREQ(LatestMessages::type_name(DaemonMessage::uplink), "uplink_status_t");
}

}  // namespace latest_messages_test
}  // namespace framewatch::daemon
