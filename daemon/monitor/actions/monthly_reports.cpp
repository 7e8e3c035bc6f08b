// SPDX-License-Identifier: MIT
#include "daemon/monitor/actions/monthly_reports.h"

#include <chrono>
#include <filesystem>
#include <optional>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "daemon/base/clocks.h"
#include "daemon/base/log.h"
#include "daemon/monitor/history/weather_table.h"
#include "drivers/files/caught.h"
#include "drivers/files/input_file.h"
#include "drivers/files/text_output.h"

namespace framewatch::daemon {
namespace {

constexpr std::int64_t kHour_us =
    3600 * kSecond_us;  // until summaries are stored; between attempts

/// Reads the weather of [report]. Returns nullopt if that is the history's, or, with every problem,
/// if the table is malformed.
std::optional<WeatherTable> table_of(const ReportSettings& s, std::string& trouble) {
  if (s.weather.empty()) return std::nullopt;
  std::vector<std::string> problems;
  std::optional<WeatherTable> out = read_weather(s.weather, problems);
  for (const std::string& p : problems) trouble += (trouble.empty() ? "" : "; ") + p;
  return out;
}

std::string send(const Config& config, const Email& email, const std::string& sent_path,
                 EmailRound& round, const Abandoned& abandoned) {
  const DeliveryResult result =
      round.send(config.email.value_or(EmailSettings{}), config.report->email, email, abandoned);
  if (!result.trouble.empty() && result.retry) return result.trouble;
  if (!result.trouble.empty())
    log(LogLevel::error, "the monthly report was refused: " + result.trouble);
  return drivers::write_text_file(
      sent_path, result.trouble.empty() ? "sent\n" : "refused: " + result.trouble + "\n");
}

}  // namespace

Email month_email(const MonthReport& report) {
  Email out;
  out.subject = fmt::format("{}: {} {}", report.building, report.month.name(),
                            report.changed ? "something changed" : "report");
  out.id = fmt::format("month/{}/{}", report.building, report.month.name());
  out.body = fmt::format("{}, {}\n\n", report.building, report.month.name());
  for (const std::string& sentence : report.sentences) out.body += "- " + sentence + ".\n";
  out.body += "\nThe attached page shows it in pictures.\n";
  out.attachments.push_back(
      {report.month.name() + ".html", "text/html; charset=utf-8", report.page});
  return out;
}

MonthOutcome make_month_report(const Config& config, const Month& month, std::int64_t now_us,
                               EmailRound& round, const Abandoned& abandoned) {
  const ReportSettings& s = *config.report;
  const std::string stem = s.directory + "/" + month.name();
  const std::string page_path = stem + ".html", sent_path = stem + ".sent";
  const bool written = !drivers::is_absent(page_path);
  const bool to_send = !s.email.empty() && drivers::is_absent(sent_path);
  if (written && !to_send) return {};
  std::string problem;
  const std::optional<WeatherTable> weather = table_of(s, problem);
  if (!problem.empty()) return {problem};
  const std::optional<MonthReport> report = month_report(config, weather, month, now_us, problem);
  if (!report) return {problem.empty() ? "" : config.history->directory + ": " + problem};
  if (!written) {
    std::error_code failed;
    std::filesystem::create_directories(s.directory, failed);
    if (failed) return {fmt::format("{}: {}", s.directory, failed.message())};
    problem = drivers::write_text_file(page_path, report->page);
    if (!problem.empty()) return {problem};
    log(LogLevel::notice, "wrote the monthly report " + page_path);
  }
  if (to_send) problem = send(config, month_email(*report), sent_path, round, abandoned);
  return {problem, !written || problem.empty()};
}

MonthlyReports::~MonthlyReports() {
  stop_ = true;
}

void MonthlyReports::configure(const Config& config) {
  config_ = std::make_shared<const Config>(config);
  finished_.clear();
  next_us_ = 0;
  if (!wanted()) trouble_.clear();
}

void MonthlyReports::collect(std::int64_t now_us) {
  MonthOutcome outcome;
  const std::string thrown = drivers::caught([&] { outcome = working_.get(); });
  if (!thrown.empty()) outcome.trouble = thrown;
  if (!outcome.trouble.empty() && outcome.trouble != trouble_)
    log(LogLevel::error, "monthly report: " + outcome.trouble + ". Trying again every hour");
  trouble_ = std::move(outcome.trouble);
  done_ += outcome.news ? 1 : 0;
  if (trouble_.empty())
    finished_ = month_;
  else
    next_us_ = now_us + kHour_us;
}

void MonthlyReports::update(std::int64_t now_us) {
  if (working_.valid()) {
    if (working_.wait_for(std::chrono::seconds(0)) == std::future_status::ready) collect(now_us);
    return;
  }
  if (!wanted() || (now_us < next_us_ && next_us_ <= now_us + kHour_us)) return;
  const Month month = Month::of(now_us - kHour_us).before();
  if (month.name() == finished_) return;
  month_ = month.name();
  const std::string thrown = drivers::caught([&] {
    working_ = std::async(std::launch::async, [this, config = config_, month, now_us] {
      return make_month_report(*config, month, now_us, round_, [this] { return stop_.load(); });
    });
  });
  if (!thrown.empty()) next_us_ = now_us + kHour_us;
}

}  // namespace framewatch::daemon
