#include "fleet/uplink/summary_message.h"

#include <array>
#include <cstddef>
#include <limits>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "daemon/base/clocks.h"

namespace framewatch::fleet {
namespace {

using daemon::SqliteStatement;

constexpr const char* kParameters =
    "SELECT name, unit, observable, boxed, outliers, mean, std_error, min, max, q1, median, q3,"
    " whisker_low, whisker_high FROM parameter JOIN summary ON summary.parameter = parameter.id"
    " AND period_s = ? AND start_us = ? ORDER BY parameter.id";
constexpr const char* kChannels =
    "SELECT received, lost, late, repaired, rejected, stuck, clipped, noise FROM channel"
    " JOIN channel_summary ON channel_summary.channel = channel.id AND period_s = ?"
    " AND start_us = ? ORDER BY channel.id";

struct Row {
  std::array<std::int32_t, 3> counts{};
  std::array<float, 9> values{};
};

Row missing() {
  Row out;
  out.values.fill(std::numeric_limits<float>::quiet_NaN());
  return out;
}

void append(summary_t& to, const Row& row) {
  int at = 0;
  for (auto* list : {&to.observable, &to.boxed, &to.outliers})
    list->push_back(row.counts[static_cast<std::size_t>(at++)]);
  at = 0;
  for (auto* list : {&to.mean, &to.std_error, &to.min, &to.max, &to.q1, &to.median, &to.q3,
                     &to.whisker_low, &to.whisker_high})
    list->push_back(row.values[static_cast<std::size_t>(at++)]);
}

std::string config_of(daemon::SqliteFile& history, std::int64_t until_us) {
  SqliteStatement s = history.prepare(
      "SELECT sha256 FROM config WHERE first_us < ? ORDER BY first_us DESC LIMIT 1");
  s.bind(1, until_us);
  return s.row() ? s.text(0) : "";
}

void add_parameters(daemon::SqliteFile& history, const SummaryKey& key,
                    const std::optional<parameter_table_t>& table, summary_t& out) {
  std::vector<std::pair<std::string, std::string>> names;
  std::map<std::pair<std::string, std::string>, Row> rows;
  SqliteStatement s = history.prepare(kParameters);
  s.bind(1, key.period_s).bind(2, key.start_us);
  while (s.row()) {
    Row row;
    int column = 2;
    for (std::int32_t& count : row.counts) count = static_cast<std::int32_t>(s.integer(column++));
    for (float& value : row.values) value = static_cast<float>(s.number(column++));
    names.emplace_back(s.text(0), s.text(1));
    rows[names.back()] = row;
  }
  if (table && table->config_sha256 == out.config_sha256) {
    names.clear();
    for (std::size_t p = 0; p < table->name.size(); ++p)
      names.emplace_back(table->name[p], table->unit[p]);
  }
  for (const auto& name : names) {
    const auto found = rows.find(name);
    append(out, found == rows.end() ? missing() : found->second);
  }
  out.parameters = static_cast<std::int32_t>(out.mean.size());
}

void add_channels(daemon::SqliteFile& history, const SummaryKey& key, summary_t& out) {
  SqliteStatement s = history.prepare(kChannels);
  s.bind(1, key.period_s).bind(2, key.start_us);
  while (s.row()) {
    int column = 0;
    for (auto* list : {&out.received, &out.lost, &out.late, &out.repaired, &out.rejected,
                       &out.stuck, &out.clipped})
      list->push_back(s.integer(column++));
    out.noise.push_back(s.number(column));
  }
  out.channels = static_cast<std::int32_t>(out.noise.size());
}

}  // namespace

std::optional<summary_t> summary_message(daemon::SqliteFile& history, const SummaryKey& key,
                                         const std::optional<parameter_table_t>& table) {
  summary_t out{};
  out.start_us = key.start_us;
  out.period_s = static_cast<std::int32_t>(key.period_s);
  SqliteStatement period =
      history.prepare("SELECT windows FROM period WHERE period_s = ? AND start_us = ?");
  period.bind(1, key.period_s).bind(2, key.start_us);
  if (!period.row()) return std::nullopt;
  out.windows = static_cast<std::int32_t>(period.integer(0));
  period.again();
  out.config_sha256 = config_of(history, key.start_us + key.period_s * daemon::kSecond_us);
  add_parameters(history, key, table, out);
  add_channels(history, key, out);
  if (history.failed()) return std::nullopt;
  return out;
}

}  // namespace framewatch::fleet
