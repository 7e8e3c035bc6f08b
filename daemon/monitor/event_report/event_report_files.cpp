#include "daemon/monitor/event_report/event_report_files.h"

#include <chrono>
#include <filesystem>
#include <mutex>

#include <fmt/core.h>

#include "daemon/base/log.h"
#include "daemon/monitor/event_report/event_report_folder.h"
#include "drivers/files/caught.h"
#include "drivers/files/text_output.h"

namespace framewatch::daemon {
namespace {

namespace fs = std::filesystem;

void remove_oldest(const std::string& directory, std::size_t most) {
  const std::vector<std::string> names = event_report_names(directory);
  for (std::size_t i = 0; i + most < names.size(); ++i)
    for (const char* ending : {".html", ".json"}) {
      std::error_code ignored;
      fs::remove(directory + "/" + names[i] + ending, ignored);
    }
}

/// Two reports that end at the same time are written one after the other.
std::mutex& one_at_a_time() {
  static std::mutex mutex;
  return mutex;
}

void log_lost_report(const std::string& name, const std::string& why) {
  log(LogLevel::error, fmt::format("{}: is not written: {}", name, why));
}

}  // namespace

std::string write_event_report(const EventReport& report, const Config& config,
                               const std::string& directory) {
  const std::lock_guard lock(one_at_a_time());
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

EventReportFiles::~EventReportFiles() {
  for (std::future<void>& one : writing_) one.wait();
}

void EventReportFiles::write(const EventReport& report, const Config& config) {
  std::erase_if(writing_, [](const std::future<void>& one) {
    return one.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
  });
  const std::string name = event_report_name(report);
  if (writing_.size() == kMax) return log_lost_report(name, "others are still being written");
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
