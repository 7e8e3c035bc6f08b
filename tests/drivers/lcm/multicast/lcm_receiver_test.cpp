// SPDX-License-Identifier: MIT
#include "drivers/lcm/multicast/lcm_receiver.h"

#include <poll.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <fmt/core.h>
#include <gtest/gtest.h>
#include <lcm/lcm-cpp.hpp>

#include "tests/drivers/lcm/multicast/datagram_sender.h"
#include "tests/support/temporary.h"

namespace framewatch::drivers {
namespace lcm_receiver_test {

using packets::part;
using packets::whole;

constexpr std::uint16_t kTestPort = 7712;

MulticastGroup group(std::vector<std::string> interfaces = {"lo"}) {
  return {ntohl(::inet_addr(kTestGroup)), kTestPort, std::move(interfaces), 1 << 22};
}

class Receiver : public testing::Test {
 protected:
  void SetUp() override {
    if (const char* reason = std::getenv("FRAMEWATCH_NO_MULTICAST")) GTEST_SKIP() << reason;
    begin(1000);
  }
  void begin(std::size_t capacity) {
    receiver_ = std::make_unique<LcmReceiver>(std::vector<std::string>{"WANTED", "END"}, capacity);
    std::string error;
    ASSERT_TRUE(receiver_->open(group(), error)) << error;
  }
  /// Returns the messages up to the one on END.
  std::vector<ReceivedMessage> until_end() {
    std::vector<ReceivedMessage> out;
    for (ReceivedMessage m; m.channel != "END";) {
      pollfd waiting{receiver_->descriptor(), POLLIN, 0};
      if (::poll(&waiting, 1, 30'000) != 1) ADD_FAILURE() << "nothing comes";
      if (testing::Test::HasFailure()) break;
      while (receiver_->take(m) && m.channel != "END") out.push_back(m);
    }
    return out;
  }

  DatagramSender sender_{kTestPort};
  std::unique_ptr<LcmReceiver> receiver_;
};

std::string text(const ReceivedMessage& message) {
  return {message.payload.begin(), message.payload.end()};
}

TEST_F(Receiver, TakesOnlyItsChannels) {
  sender_.send(whole(1, "WANTED", "a"));
  sender_.send(whole(2, "OTHER", "b"));
  sender_.send(whole(3, "WANTED2", "c"));
  sender_.send(part(4, 6, 0, 0, 2, std::string("WANTED\0abc", 10)));
  sender_.send(part(4, 6, 3, 1, 2, "def"));
  sender_.send(whole(5, "END", ""));
  const auto messages = until_end();
  ASSERT_EQ(messages.size(), 2u);
  EXPECT_EQ(text(messages[0]), "a");
  EXPECT_EQ(text(messages[1]), "abcdef");
  EXPECT_EQ(messages[0].sender.address, INADDR_LOOPBACK);
  EXPECT_NE(messages[0].sender.port, 0);
  const auto now_us = std::chrono::duration_cast<std::chrono::microseconds>(
                          std::chrono::system_clock::now().time_since_epoch())
                          .count();
  EXPECT_NEAR(static_cast<double>(messages[0].received_us), static_cast<double>(now_us), 60e6);
  EXPECT_EQ(receiver_->counters(), ReceiverCounters{});
}

TEST_F(Receiver, HearsLiblcmsShortAndLongMessages) {
  lcm::LCM lcm(fmt::format("udpm://{}:{}?ttl=0", kTestGroup, kTestPort));
  ASSERT_TRUE(lcm.good());
  std::vector<std::string> sent;
  for (const std::size_t size : {0, 1, 1000, 60'000, 65'499, 65'500, 70'000, 200'000, 1'000'000}) {
    std::string payload(size, '\0');
    for (std::size_t i = 0; i < size; ++i) payload[i] = static_cast<char>(i * 7 + i / 251 + size);
    ASSERT_EQ(lcm.publish("WANTED", payload.data(), static_cast<unsigned>(size)), 0);
    sent.push_back(std::move(payload));
  }
  sender_.send(whole(1, "END", ""));
  std::vector<std::string> came;
  for (const ReceivedMessage& m : until_end()) came.push_back(text(m));
  EXPECT_TRUE(came == sent) << came.size();
}

TEST_F(Receiver, CountsAndSurvivesDatagramsThatCrashLiblcm) {
  sender_.send(part(77, 3000, 0, 0, 3, std::string("WANTED\0", 7) + std::string(100, 'A')));
  sender_.send(part(77, 3000, 0xFFFFFF00, 1, 3, std::string(0x200, 'B')));
  packets::Bytes bad_magic = whole(5, "WANTED", std::string(80, 'z'));
  bad_magic[0] = 0xde;
  sender_.send(bad_magic);
  packets::Bytes cut = whole(5, "WANTED", "");
  cut.pop_back();
  sender_.send(cut);
  sender_.send({});
  sender_.send(whole(6, "WANTED", "alive"));
  sender_.send(whole(7, "END", ""));
  const auto messages = until_end();
  ASSERT_EQ(messages.size(), 1u);
  EXPECT_EQ(text(messages[0]), "alive");
  EXPECT_EQ(receiver_->counters().malformed, 4);
}

TEST_F(Receiver, DoesNotHearUnicast) {
  for (const char* address : {"127.0.0.1", "127.0.0.2"})
    DatagramSender(kTestPort, address).send(whole(1, "WANTED", "unicast"));
  sender_.send(whole(2, "END", ""));
  EXPECT_TRUE(until_end().empty());
}

TEST_F(Receiver, AFullQueueDropsAndCounts) {
  begin(10);
  for (std::uint32_t i = 0; i < 100; ++i) sender_.send(whole(i, "WANTED", std::to_string(i)));
  sender_.send(whole(0, "END", ""));
  for (int i = 0; i < 3000 && receiver_->waiting() < 11; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  const auto messages = until_end();
  ASSERT_EQ(messages.size(), 10u);
  EXPECT_EQ(text(messages.back()), "9");
  EXPECT_EQ(receiver_->counters().queue_full, 90);
}

TEST_F(Receiver, ListsTheInterfaces) {
  LcmReceiver receiver({"WANTED"}, 10);
  std::string error;
  EXPECT_FALSE(receiver.open(group({"lo", "eth77"}), error));
  EXPECT_NE(error.find("no network interface 'eth77'; this machine has "), std::string::npos)
      << error;
  EXPECT_NE(error.find("lo"), std::string::npos) << error;
}

/// Another host: a network namespace joined to ours by a virtual cable with the ends v0 here
/// (10.9.0.1) and v1 there (10.9.0.2).
class OtherHost {
 public:
  OtherHost() {
    const test::TemporaryDirectory directory;
    const std::string told = directory.path("process");
    const char* lines =
        "exec 2>/dev/null; unshare -n sleep 600 & P=$!; for i in $(seq 300); do "
        "[ $(readlink /proc/$P/ns/net) != $(readlink /proc/self/ns/net) ] && break; sleep .1; "
        "done; "
        "ip link add v0 type veth peer name v1 && ip link set v1 netns $P && "
        "ip addr add 10.9.0.1/24 dev v0 && ip link set v0 up && "
        "nsenter -t $P -n ip addr add 10.9.0.2/24 dev v1 && nsenter -t $P -n ip link set v1 up && "
        "echo $P > ";
    if (std::system((lines + told).c_str()) == 0) std::ifstream(told) >> process_;
  }
  ~OtherHost() {
    if (process_ > 0) ::kill(process_, SIGKILL);
  }
  bool there() const { return process_ > 0; }
  /// Sends the message from the other host to the group or to our address.
  bool send(const std::string& to, const std::string& payload) const {
    return std::system(fmt::format("nsenter -t {} -n python3 -c \"import socket,struct\n"
                                   "s=socket.socket(socket.AF_INET,socket.SOCK_DGRAM)\n"
                                   "s.setsockopt(0,socket.IP_MULTICAST_IF,"
                                   "socket.inet_aton('10.9.0.2'))\n"
                                   "s.sendto(b'LC02\\\\0\\\\0\\\\0\\\\1WANTED\\\\0{}',('{}',{}))\"",
                                   process_, payload, to, kTestPort)
                           .c_str()) == 0;
  }

 private:
  int process_ = 0;
};

TEST_F(Receiver, HearsOtherHostsOnlyOverNamedInterfaces) {
  const OtherHost other;
  if (!other.there()) GTEST_SKIP() << "no second network namespace here";
  LcmReceiver open({"WANTED"}, 10);
  std::string error;
  ASSERT_TRUE(open.open(group({"v0"}), error)) << error;
  ASSERT_TRUE(other.send("10.9.0.1", "unicast"));
  ASSERT_TRUE(other.send(kTestGroup, "multicast"));
  sender_.send(whole(1, "WANTED", "our own"));
  ReceivedMessage first, second;
  for (ReceivedMessage* m : {&first, &second})
    for (int i = 0; i < 3000 && !open.take(*m); ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
  EXPECT_EQ(text(first), "multicast");
  EXPECT_EQ(to_text(first.sender).substr(0, 9), "10.9.0.2:");
  EXPECT_EQ(text(second), "our own");
  EXPECT_EQ(open.counters().from_elsewhere, 0);

  sender_.send(whole(2, "END", ""));
  const auto messages = until_end();  // of the receiver on the loopback only
  ASSERT_EQ(messages.size(), 1u);
  EXPECT_EQ(text(messages[0]), "our own");
}

TEST_F(Receiver, HearsOnlyThisMachineWhateverTheRoute) {
  const OtherHost other;
  if (!other.there()) GTEST_SKIP() << "no second network namespace here";
  ASSERT_EQ(std::system(fmt::format("ip route replace {}/32 dev v0", kTestGroup).c_str()), 0);
  begin(1000);
  ASSERT_TRUE(other.send(kTestGroup, "multicast"));
  lcm::LCM lcm(fmt::format("udpm://{}:{}?ttl=0", kTestGroup, kTestPort));
  ASSERT_EQ(lcm.publish("WANTED", "our own", 7), 0);
  ASSERT_EQ(lcm.publish("END", "", 0), 0);
  const auto messages = until_end();
  ASSERT_EQ(std::system(fmt::format("ip route replace {}/32 dev lo", kTestGroup).c_str()), 0);
  ASSERT_EQ(messages.size(), 1u);
  EXPECT_EQ(text(messages[0]), "our own");
  EXPECT_EQ(to_text(messages[0].sender).substr(0, 9), "10.9.0.1:");
  for (int i = 0; i < 3000 && receiver_->counters().from_elsewhere == 0; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  EXPECT_EQ(receiver_->counters().from_elsewhere, 1);
}

}  // namespace lcm_receiver_test
}  // namespace framewatch::drivers
