// SPDX-License-Identifier: MIT
// The database of a history with foreign changes, and queries of it.
#include <filesystem>
#include <fstream>
#include <iterator>

#include "daemon/monitor/history/history_command.h"
#include "daemon/monitor/history/history_files.h"
#include "daemon/monitor/history/summary_store.h"
#include "tests/drivers/lcm/example_messages.h"
#include "tests/fuzz/scratch.h"
#include "tests/fuzz/targets.h"

namespace framewatch::test {
namespace {

namespace fs = std::filesystem;

daemon::HistorySettings history_settings() {
  daemon::HistorySettings settings;
  settings.directory = scratch_folder() + "/history";
  settings.summary_s = {1, 2, 4};
  return settings;
}

daemon::SummaryBatch two_periods() {
  daemon::SummaryBatch batch;
  batch.parameters = drivers::examples::parameter_table();
  batch.channels = {"base-x"};
  for (const std::int64_t start_us : {1'700'000'000'000'000, 1'700'000'001'000'000}) {
    daemon::PeriodData period;
    period.start_us = start_us;
    period.windows = 100;
    period.last_us = start_us + 990'000;
    period.parameters.assign(2, {100, 3.4e6, 1e4, 33e3, 35e3, {33e3, 34e3, 35e3}});
    period.channels.resize(1);
    batch.periods.push_back(period);
  }
  batch.events = {drivers::examples::event()};
  batch.acknowledged = {drivers::examples::acknowledged()};
  return batch;
}

/// Bytes of a database that this program wrote, all in one file.
const std::vector<std::uint8_t>& good_database() {
  static const std::vector<std::uint8_t> bytes = [] {
    const std::string path = daemon::summary_file(history_settings().directory);
    {
      daemon::SummaryStore store(history_settings());
      require(store.open().empty() && store.add(two_periods()).empty(), "a database");
    }
    std::ifstream file(path, std::ios::binary);
    return std::vector<std::uint8_t>{std::istreambuf_iterator<char>(file), {}};
  }();
  return bytes;
}

void begin_anew(const std::vector<std::uint8_t>& database) {
  const std::string directory = history_settings().directory;
  fs::remove_all(directory);
  fs::create_directories(directory);
  write_scratch_file(daemon::summary_file(directory), database.data(), database.size());
}

void ask_database(Bytes input) {
  Pieces pieces(input);
  daemon::HistoryArguments asked;
  asked.place = history_settings().directory;
  const auto what = pieces.take<std::uint8_t>();
  asked.json = what & 1;
  asked.events = what & 2;
  if (what & 4) asked.from = text_of(pieces.take_bytes(pieces.take<std::uint8_t>()));
  if (what & 8) asked.to = text_of(pieces.take_bytes(pieces.take<std::uint8_t>()));
  if (what & 16) asked.last = text_of(pieces.take_bytes(pieces.take<std::uint8_t>()));
  if (what & 32) asked.period_s = pieces.take<std::int16_t>();
  if (what & 64) asked.parameters = {text_of(pieces.take_bytes(pieces.take<std::uint8_t>()))};
  begin_anew(changed(good_database(), pieces));
  (void)daemon::history(asked);
  if (what & 128) {  // `run` continues with it
    daemon::SummaryStore store(history_settings());
    if (store.open().empty() && store.add(two_periods()).empty()) {
      (void)store.open_periods();
      (void)store.prune(1'800'000'000'000'000);
    }
  }
}

std::vector<std::string> database_seeds() {
  std::vector<std::string> out;
  for (const int what : {0, 1, 2, 128, 130}) out.push_back(std::string(1, static_cast<char>(what)));
  PiecesWriter all;
  all.put(std::uint8_t{4 + 8 + 32 + 64});
  for (const std::string text : {"2023-11-14T22:13:20Z", "1700000002"})
    all.put(static_cast<std::uint8_t>(text.size()))
        .put_bytes({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  out.push_back(all.text() + std::string{'\1', '\0', '\2', 'k', '*'});
  out.push_back(std::string{'\x10', '\2', '9', 'm'});
  for (std::uint32_t at = 40; at < good_database().size(); at += 1777) {
    PiecesWriter seed;
    const std::uint8_t bytes4 = 5 * 2;
    out.push_back(seed.put(std::uint8_t{130}).put(bytes4).put(at).put(0x7fffffff).text());
  }
  return out;
}

}  // namespace

const FuzzTarget kDatabaseTarget{"database", &ask_database, &database_seeds};

}  // namespace framewatch::test
