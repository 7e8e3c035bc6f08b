// SPDX-License-Identifier: MIT
#include "fleet/uplink/raw_sender.h"

#include "tests/fleet/uplink/uplink_fixture.h"

namespace framewatch::fleet {
namespace raw_sender_test {

constexpr std::size_t kFile_bytes = 10 * 128 * 1024 - 5;

/// "Exports" noise that does not compress.
class FakeExporter : public RawExporter {
 public:
  explicit FakeExporter(int& times, std::string problem = "")
      : times_(times), problem_(std::move(problem)) {}
  std::string begin(const RawRequest&, const std::string& path) override {
    ++times_;
    std::string bytes;
    std::uint32_t state = 1;
    for (std::size_t i = 0; i < kFile_bytes; ++i)
      bytes += static_cast<char>((state = state * 1664525 + 1013904223) >> 24);
    if (problem_.empty()) framewatch::test::write_file(path, bytes);
    return "";
  }
  std::optional<std::string> ended() override { return problem_; }

 private:
  int& times_;
  std::string problem_;
};

class Raw : public test::UplinkTest {
 protected:
  void begin_raw(const std::string& problem = "") {
    begin(std::make_unique<FakeExporter>(exports_, problem));
    run(1);
  }
  void ask(const std::string& request, const std::string& more = "") {
    Message m;
    m.subject = "fw.down.a.raw";
    m.reply = "_INBOX_page.x";
    m.headers = {{header::kWho, "Ada"},
                 {header::kRequest, request},
                 {header::kUntil, std::to_string(host_us_ / test::kSecond + 60)}};
    const std::string text = fmt::format(R"({{"from_us":0,"to_us":1000000{}}})", more);
    m.bytes.assign(text.begin(), text.end());
    hub_.bring(m);
  }
  std::string received(const std::string& request) const {
    std::map<int, std::string> pieces;
    for (const Message& m : hub_.published)
      if (m.subject == "fw.up.a.raw." + request) {
        std::string why;
        const auto bytes = unpacked(m, 1 << 20, why);
        if (bytes) pieces[std::stoi(m.header(header::kPiece))] = {bytes->begin(), bytes->end()};
      }
    std::string all;
    for (const auto& [number, bytes] : pieces) all += bytes;
    return all;
  }
  int exports_ = 0;
};

TEST_F(Raw, ArrivesWholeAtTheAllowedRate) {
  settings_.raw_kbit_s = 1000;
  begin_raw();
  ask("r1");
  run(5);
  EXPECT_LT(hub_.count("a/raw/r1/"), 7U);
  run(20);
  EXPECT_EQ(hub_.count("a/raw/r1/"), 10U);
  EXPECT_EQ(received("r1").size(), kFile_bytes);
  EXPECT_TRUE(std::filesystem::is_empty(folder_.path("uplink-raw")));
  EXPECT_EQ(kept_twice(), 0U);
}

TEST_F(Raw, ContinuesAfterARestart) {
  settings_.raw_kbit_s = 1000;
  begin_raw();
  ask("r1");
  run(5);
  const std::size_t before = hub_.count("a/raw/r1/");
  ASSERT_GT(before, 1U);
  uplink_.reset();
  begin_raw();
  run(20);
  EXPECT_EQ(exports_, 1);
  EXPECT_EQ(hub_.count("a/raw/r1/"), 10U);
  EXPECT_LE(kept_twice(), 1U);  // the one whose answer was not read
  EXPECT_EQ(received("r1").size(), kFile_bytes);
}

TEST_F(Raw, PiecesStayInTheBuildingWhileTheHubIsFull) {
  begin_raw();
  hub_.error = R"({"error":{"code":400,"description":"maximum bytes exceeded"}})";
  ask("r1");
  run(30);
  EXPECT_LE(hub_.published.size(), 2 * RawSender::kUnderWay);
  hub_.error.clear();
  run(90);
  EXPECT_EQ(hub_.count("a/raw/r1/"), 10U);
}

TEST_F(Raw, ReportsWhyAPieceCannotBeSent) {
  begin_raw();
  ask("r1", R"(,"bytes":1000)");
  run(5);
  EXPECT_EQ(hub_.count("a/raw/r1/"), 1U);
  EXPECT_EQ(hub_.published.back().header(header::kPieces), "0");
  EXPECT_NE(received("r1").find("more than the 1000 allowed"), std::string::npos);
  begin_raw("there are no raw samples in that time");
  ask("r2");
  run(5);
  EXPECT_EQ(received("r2"), "there are no raw samples in that time");
  EXPECT_EQ(uplink_->status(now()).pieces_waiting, 0);
  begin_raw();
  ask("r3");
  run(10);
  EXPECT_EQ(hub_.count("a/raw/r3/"), 10U);
}

}  // namespace raw_sender_test
}  // namespace framewatch::fleet
