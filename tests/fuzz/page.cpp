// SPDX-License-Identifier: MIT
// Messages in sequence, as `framewatch serve` receives them, for the page and the metrics.
#include <array>

#include "daemon/page/metrics/metrics.h"
#include "daemon/page/view/live_view.h"
#include "tests/fuzz/example_building.h"
#include "tests/fuzz/message_sequence.h"
#include "tests/fuzz/targets.h"

namespace framewatch::test {
namespace {

daemon::CommandAnswer no_daemon(const std::string&, const daemon::CommandPacket&) {
  return {};
}

using daemon::LiveView;
using daemon::Metrics;

std::vector<std::string> page_channels() {
  static const std::vector<std::string> channels = [] {
    LiveView view(
        example_building(), [](auto...) {}, no_daemon);
    std::vector<std::string> out = view.channels();
    const std::vector<std::string> more = Metrics(example_building()).channels();
    out.insert(out.end(), more.begin(), more.end());
    return out;
  }();
  return channels;
}

/// Checks that every event has a name and one line of data.
void require_events(const std::string& text) {
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = text.find("\n\n", at);
    require(end != std::string::npos, "an event that ends");
    const std::string event = text.substr(at, end - at);
    const std::size_t data = event.find("\ndata: ");
    require(event.starts_with("retry: ") ||
                (event.starts_with("event: ") && data != std::string::npos &&
                 event.find('\n', data + 1) == std::string::npos),
            "a name and a line of data");
    at = end + 2;
  }
}

void show_messages(Bytes input) {
  Pieces pieces(input);
  LiveView view(
      example_building(), [](auto...) {}, no_daemon);
  Metrics metrics(example_building());
  daemon::EventRing::Cursor early = view.join();
  std::int64_t now_us = 1'000'000;
  take_messages(pieces, page_channels(), [&](const std::string& channel, const auto& payload) {
    view.message(channel, payload.data(), payload.size());
    metrics.message(channel, payload.data(), payload.size(), now_us += 100'000);
    view.flush();
  });
  (void)view.acknowledge(1, "127.0.0.1");
  view.flush();
  daemon::EventRing::Cursor late = view.join();
  for (daemon::EventRing::Cursor* cursor : {&early, &late}) {
    std::string text;
    std::array<char, 4096> part;
    while (const std::size_t size = view.read(*cursor, part.data(), part.size()))
      text.append(part.data(), size);
    require_events(text);
  }
  (void)view.building_json();
  (void)metrics.text(now_us, {});
}

std::vector<std::string> page_seeds() {
  const auto all = example_messages();
  std::vector<std::string> out{message_sequence(page_channels(), all)};
  for (const auto& one : all) out.push_back(message_sequence(page_channels(), {one}));
  return out;
}

}  // namespace

const FuzzTarget kPageTarget{"page", &show_messages, &page_seeds};

}  // namespace framewatch::test
