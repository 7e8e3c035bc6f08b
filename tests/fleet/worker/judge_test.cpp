// SPDX-License-Identifier: MIT
#include "fleet/worker/judge.h"

#include <functional>
#include <string>

#include <framewatch/service_t.hpp>

#include <gtest/gtest.h>

#include "daemon/base/clocks.h"
#include "drivers/files/encoded.h"
#include "fleet/message/address.h"
#include "tests/fleet/worker/worker_fixture.h"

namespace framewatch::fleet {
namespace judge_test {

FleetBatch judged(const Message& message) {
  FleetBatch batch;
  judge(message, kHub_us, batch);
  return batch;
}

std::string reason(const Message& message) {
  const FleetBatch batch = judged(message);
  EXPECT_EQ(batch.events.size() + batch.summaries.size() + batch.newest.size() +
                batch.pieces.size() + batch.parameters.size(),
            0u);
  EXPECT_EQ(batch.others.size(), 1u);
  return batch.others.empty() ? "taken" : batch.others[0].reason;
}

TEST(Judge, AcceptsABuildingsMessages) {
  EXPECT_EQ(judged(event_message("kobe", 1)).events.at(0).building, "kobe");
  EXPECT_EQ(judged(event_message("kobe", 7)).events.at(0).event.id, 7);
  EXPECT_EQ(judged(summary_message("kobe", 600, kHub_us)).summaries.at(0).summary.period_s, 600);
  service_t service{};
  const Message heartbeat = packed(up_subject("kobe", "service"), newest_key("kobe", "service", 1),
                                   "service_t", drivers::encoded(service), "");
  EXPECT_EQ(judged(heartbeat).newest.at(0).kind, "service");
  const FleetBatch table = judged(parameters_message("kobe"));
  EXPECT_EQ(table.parameters.at(0).table.name.at(0), "kx_1_y1");
  EXPECT_EQ(table.newest.at(0).type, "parameter_table_t");
}

TEST(Judge, AcceptsAPieceOfRawSamples) {
  Message piece =
      packed(up_subject("kobe", "raw.r-17"), raw_key("kobe", "r-17", 2), "mseed", {1, 2, 3}, "");
  piece.headers[header::kPiece] = "2";
  piece.headers[header::kPieces] = "3";
  piece.headers[header::kFile] = "kobe.mseed";
  const ReceivedPiece taken = judged(piece).pieces.at(0);
  EXPECT_EQ(taken.request, "r-17");
  EXPECT_EQ(taken.content, (Bytes{1, 2, 3}));
  piece.headers[header::kPieces] = "0";
  EXPECT_EQ(reason(piece), "its piece number is not valid");
  Message none =
      packed(up_subject("kobe", "raw.r-18"), raw_key("kobe", "r-18", 0), "text", {'n', 'o'}, "");
  none.headers[header::kPiece] = none.headers[header::kPieces] = "0";
  EXPECT_EQ(judged(none).pieces.at(0).pieces, 0);
  none.bytes.assign(2000, 'n');
  EXPECT_EQ(reason(none), "its reason for sending nothing is too long");
  for (const auto& [number, of] : {std::pair("3", "3"), std::pair("-1", "3"), std::pair("x", "3"),
                                   std::pair("2", ""), std::pair("2", "99999999999")}) {
    piece.headers[header::kPiece] = number;
    piece.headers[header::kPieces] = of;
    EXPECT_EQ(reason(piece), "its piece number is not valid") << number;
  }
}

TEST(Judge, AcceptsSealedKeys) {
  Message message = event_message("kobe", 1);
  message.headers[header::kKey] =
      sealed_key(message.header(header::kKey), "secret of kobe", message.bytes);
  EXPECT_EQ(judged(message).events.size(), 1u);
  message.subject = up_subject("osaka", "event");
  EXPECT_EQ(reason(message), "its key names kobe, its subject osaka");
}

TEST(Judge, RefusesAMessageThatNamesAnotherBuilding) {
  Message forged = event_message("kobe", 1);
  forged.subject = up_subject("osaka", "event");
  EXPECT_EQ(reason(forged), "its key names kobe, its subject osaka");
  Message other_event = event_message("kobe", 1);
  other_event.headers[header::kKey] = event_message("kobe", 2).header(header::kKey);
  EXPECT_NE(reason(other_event).find("its key does not match its content"), std::string::npos);
  Message other_period = summary_message("kobe", 600, 0);
  other_period.subject = up_subject("kobe", "summary.3600");
  EXPECT_NE(reason(other_period).find("its subject says summary.3600"), std::string::npos);
}

TEST(Judge, RefusesMalformedMessages) {
  Message message = event_message("kobe", 1);
  message.headers.erase(header::kKey);
  EXPECT_EQ(reason(message), "its key (Nats-Msg-Id) is missing");
  message = event_message("kobe", 1);
  message.subject = "fw.down.kobe.raw";
  EXPECT_EQ(reason(message), "its subject is not fw.up.BUILDING.KIND");
  message = event_message("kobe", 1);
  message.headers[header::kType] = "summary_t";
  EXPECT_EQ(reason(message), "event must be event_t, not summary_t");
  message = event_message("kobe", 1);
  message.headers.erase(header::kEncoding);
  message.bytes = drivers::encoded(event(1));
  message.bytes.resize(40);
  EXPECT_FALSE(reason(message).empty());
  message.headers[header::kEncoding] = "rar";
  EXPECT_FALSE(reason(message).empty());
}

TEST(Judge, KeepsMessagesOfNewerProgramsForLater) {
  Message message = event_message("kobe", 1);
  message.headers.erase(header::kEncoding);
  message.bytes = drivers::encoded(event(1));
  message.bytes[3] ^= 0x55;  // the fingerprint
  EXPECT_EQ(reason(message), "");
  Message kind = event_message("kobe", 1);
  kind.subject = up_subject("kobe", "dreams");
  EXPECT_EQ(reason(kind), "");
}

TEST(Judge, RefusesSummariesOfAFarOffClock) {
  EXPECT_EQ(judged(summary_message("kobe", 600, kHub_us + daemon::kDay_us / 2)).summaries.size(),
            1u);
  EXPECT_NE(reason(summary_message("kobe", 600, kHub_us + 2 * daemon::kDay_us)).find("tomorrow"),
            std::string::npos);
  EXPECT_NE(reason(summary_message("kobe", 600, -600'000'000)).find("before 1970"),
            std::string::npos);
}

}  // namespace judge_test
}  // namespace framewatch::fleet
