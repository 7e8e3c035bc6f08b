// SPDX-License-Identifier: MIT
#include "daemon/page/web/web_sessions.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <functional>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "daemon/base/json.h"
#include "daemon/base/served_file.h"
#include "daemon/monitor/event_report/event_report_files.h"
#include "daemon/tools/report/session_file.h"
#include "daemon/tools/session/session_log.h"

namespace framewatch::daemon {
namespace {

namespace fs = std::filesystem;
constexpr std::size_t kMaxShown = 200;

constexpr std::size_t kMaxReports = 50;

}  // namespace

bool is_session_name(const std::string& name) {
  return !name.empty() && std::all_of(name.begin(), name.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '-' || c == '_';
  });
}

std::string sessions_json(const std::string& folder) {
  std::vector<std::string> names;
  std::error_code error;
  for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error))
    if (std::string name = at->path().filename().string(); is_session_name(name))
      names.push_back(std::move(name));
  std::sort(names.begin(), names.end(), std::greater<>());
  Json out = Json::array();
  for (const std::string& name : names) {
    if (out.size() == kMaxShown) break;
    std::string why;
    const auto text = read_served_file(folder, {name, kSessionJson});
    const auto s = text ? parse_session(*text, why) : std::nullopt;
    if (!s) continue;
    const std::int64_t length_us = s->end_us > 0 ? s->end_us - s->trigger_us : 0;
    std::vector<std::string> said = s->problems;
    said.insert(said.end(), s->finishing.begin(), s->finishing.end());
    out.push_back({{"session", name},
                   {"test", s->request.test},
                   {"operator", s->request.operator_name},
                   {"state", s->state},
                   {"began_us", s->began_us},
                   {"seconds", 1e-6 * static_cast<double>(length_us)},
                   {"problems", said},
                   {"report", is_served_file(folder, {name, kReportPage})}});
  }
  return json_line(out);
}

std::optional<WebFile> session_document(const std::string& folder, const std::string& path) {
  const std::size_t slash = path.find('/');
  const std::string name = path.substr(0, slash);
  const std::string file = slash == std::string::npos ? "" : path.substr(slash + 1);
  if (folder.empty() || !is_session_name(name)) return std::nullopt;
  if (file != kReportPage && file != kSessionJson) return std::nullopt;
  auto text = read_served_file(folder, {name, file});
  if (!text) return std::nullopt;
  return WebFile{file == kReportPage ? "text/html; charset=utf-8" : "application/json",
                 std::move(*text)};
}

std::string event_reports_json(const std::string& folder) {
  const std::vector<std::string> names = event_report_names(folder);
  Json out = Json::array();
  for (auto name = names.rbegin(); name != names.rend() && out.size() < kMaxReports; ++name)
    if (const auto s = event_report_summary(folder, *name))
      out.push_back({{"name", s->name},
                     {"verdict", color_word(s->color)},
                     {"reason", s->reason},
                     {"placard", s->placard},
                     {"start_us", s->start_us},
                     {"end_us", s->end_us}});
  return json_line(out);
}

std::optional<WebFile> event_report_document(const std::string& folder, const std::string& path) {
  const std::size_t dot = path.find('.');
  const std::string ending = dot == std::string::npos ? "" : path.substr(dot);
  const bool page = ending == ".html";
  if (folder.empty() || !is_event_report_name(path.substr(0, dot))) return std::nullopt;
  if (!page && ending != ".json") return std::nullopt;
  auto text = read_served_file(folder, {path});
  if (!text) return std::nullopt;
  return WebFile{page ? "text/html; charset=utf-8" : "application/json", std::move(*text)};
}

}  // namespace framewatch::daemon
