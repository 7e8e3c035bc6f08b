// SPDX-License-Identifier: MIT
#include "daemon/monitor/event_report/event_report_files.h"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <mutex>
#include <utility>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "daemon/base/json.h"
#include "daemon/base/log.h"
#include "daemon/base/served_file.h"
#include "daemon/base/utc_time.h"
#include "drivers/files/caught.h"
#include "drivers/files/text_output.h"

namespace framewatch::daemon {
namespace {

namespace fs = std::filesystem;

const std::string kBeginning = "event-", kStamp = "20261121T231500Z";

std::optional<EventColor> color_of_word(const std::string& word) {
  for (const EventColor color : {EventColor::green, EventColor::yellow, EventColor::red})
    if (word == color_word(color)) return color;
  return std::nullopt;
}

void remove_oldest(const std::string& directory, std::size_t most) {
  const std::vector<std::string> names = event_report_names(directory);
  for (std::size_t i = 0; i + most < names.size(); ++i)
    for (const char* ending : {".html", ".json"}) {
      std::error_code ignored;
      fs::remove(directory + "/" + names[i] + ending, ignored);
    }
}

void log_lost_report(const std::string& name, const std::string& why) {
  log(LogLevel::error, fmt::format("{}: cannot write the report: {}", name, why));
}

}  // namespace

bool is_event_report_name(const std::string& name) {
  return name.size() == kBeginning.size() + kStamp.size() && name.starts_with(kBeginning) &&
         read_utc_stamp(name.substr(kBeginning.size()));
}

std::vector<std::string> event_report_names(const std::string& folder) {
  std::vector<std::string> out;
  std::error_code error;
  for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error))
    if (const std::string name = at->path().stem().string();
        at->path().extension() == ".json" && is_event_report_name(name))
      out.push_back(name);
  std::sort(out.begin(), out.end());
  return out;
}

std::optional<EventReportSummary> event_report_summary(const std::string& folder,
                                                       const std::string& name) {
  const auto text = read_served_file(folder, {name + ".json"});
  if (!text) return std::nullopt;
  try {
    const Json json = Json::parse(*text);
    const auto color = color_of_word(json.at("verdict").get<std::string>());
    const Json& reasons = json.at("reasons");
    if (!color || reasons.empty()) return std::nullopt;
    EventReportSummary out{name, *color, reasons.at(0).get<std::string>(),
                           json.at("start_us").get<std::int64_t>(),
                           json.at("end_us").get<std::int64_t>()};
    if (json.contains("placard") && json.at("placard").is_object()) {
      out.placard = json.at("placard").at("words").get<std::string>();
      out.placard_reason = json.at("placard").at("reason").get<std::string>();
    }
    return out;
  } catch (const Json::exception&) {
    return std::nullopt;
  }
}

NewestEventReport::NewestEventReport(std::string folder) : folder_(std::move(folder)) {}

const std::optional<EventReportSummary>& NewestEventReport::poll() {
  if (folder_.empty()) return newest_;
  const std::vector<std::string> names = event_report_names(folder_);
  if (names.empty()) {
    name_.clear();
    newest_.reset();
  } else if (names.back() != name_ || !newest_) {
    name_ = names.back();
    newest_ = event_report_summary(folder_, name_);
  }
  return newest_;
}

std::string write_event_report(const EventReport& report, const Config& config,
                               const std::string& directory) {
  static std::mutex one_at_a_time;  // two motions may end at once
  const std::lock_guard lock(one_at_a_time);
  std::error_code error;
  fs::create_directories(directory, error);
  if (error) return directory + ": " + error.message();
  const std::string path = directory + "/" + event_report_name(report);
  std::string problem = drivers::write_text_file(path + ".html", event_report_html(report, config));
  if (problem.empty())
    problem = drivers::write_text_file(path + ".json", event_report_json(report, config));
  if (problem.empty())
    remove_oldest(directory, static_cast<std::size_t>(config.event_report->most_reports));
  return problem;
}

void EventReportFiles::write(const EventReport& report, const Config& config) {
  std::erase_if(writing_, [](const std::future<void>& one) {
    return one.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
  });
  const std::string name = event_report_name(report);
  if (writing_.size() == kMax)
    return log_lost_report(name, "too many reports are still being written");
  const std::string thrown = drivers::caught([&] {
    writing_.push_back(std::async(std::launch::async, [report, config, name] {
      std::string problem;
      const std::string why = drivers::caught(
          [&] { problem = write_event_report(report, config, config.event_report->directory); });
      if (!why.empty()) problem = why;
      if (!problem.empty()) return log_lost_report(name, problem);
      log(LogLevel::notice, fmt::format("report of the strong motion: {}/{}.html",
                                        config.event_report->directory, name));
    }));
  });
  if (!thrown.empty()) log_lost_report(name, thrown);
}

}  // namespace framewatch::daemon
