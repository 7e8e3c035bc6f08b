#include "fleet/archive/archive_task.h"

#include <algorithm>
#include <climits>
#include <utility>

#include <fmt/core.h>

#include "daemon/base/file_digest.h"
#include "drivers/files/number_text.h"

namespace framewatch::fleet {
namespace {

constexpr std::size_t kKeyPart = 12;  // hexadecimal digits
constexpr std::size_t kWordsBeforeLogs = 7;

std::vector<std::string> words_of(std::string_view line) {
  std::vector<std::string> out;
  for (std::size_t at = 0; at <= line.size();) {
    const std::size_t tab = std::min(line.find('\t', at), line.size());
    out.emplace_back(line.substr(at, tab - at));
    at = tab + 1;
  }
  return out;
}

bool is_hexadecimal(std::string_view text) {
  return std::all_of(text.begin(), text.end(),
                     [](char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f'); });
}

bool is_key(std::string_view key) {
  constexpr std::size_t kSize = 3 * kKeyPart + 2;
  if (key.size() != kSize || key[kKeyPart] != '-' || key[2 * kKeyPart + 1] != '-') return false;
  return is_hexadecimal(key.substr(0, kKeyPart)) &&
         is_hexadecimal(key.substr(kKeyPart + 1, kKeyPart)) &&
         is_hexadecimal(key.substr(2 * kKeyPart + 2));
}

}  // namespace

std::string making_of(const std::string& program, const std::string& config_sha256) {
  return program.substr(0, kKeyPart) + "-" + config_sha256.substr(0, kKeyPart);
}

std::string task_key(const std::string& making, const ArchiveTask& task,
                     const std::vector<std::string>& log_sha256) {
  std::string said = fmt::format("{} {} {}", task.warm_up_us, task.from_us, task.to_us);
  for (const std::string& digest : log_sha256) said += " " + digest;
  return making + "-" + daemon::sha256(said).substr(0, kKeyPart);
}

std::string manifest_line(const ArchiveTask& task) {
  std::string out = fmt::format("{}\t{}\t{}\t{}\t{}\t{}\t{}", task.number, task.key, task.config,
                                task.out, task.warm_up_us, task.from_us, task.to_us);
  for (const std::string& log : task.logs) out += "\t" + log;
  return out + "\n";
}

std::optional<ArchiveTask> read_manifest_line(std::string_view line, std::string& problem) {
  const std::vector<std::string> words = words_of(line);
  const auto wrong = [&](std::string rule) {
    problem = std::move(rule);
    return std::nullopt;
  };
  if (words.size() <= kWordsBeforeLogs)
    return wrong(fmt::format("{} words between tabs, a task has {} and its logs", words.size(),
                             kWordsBeforeLogs));
  ArchiveTask task;
  const auto number = drivers::parse_integer(words[0]);
  if (!number || *number < 1 || *number > INT_MAX)
    return wrong(words[0] + ": is no number of a task, from 1");
  task.number = static_cast<int>(*number);
  if (!is_key(words[1])) return wrong(words[1] + ": is no key, three times 12 hexadecimal digits");
  task.key = words[1];
  task.config = words[2];
  task.out = words[3];
  std::int64_t* const times[] = {&task.warm_up_us, &task.from_us, &task.to_us};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto time_us = drivers::parse_integer(words[4 + i]);
    if (!time_us) return wrong(words[4 + i] + ": is no time in microseconds");
    *times[i] = *time_us;
  }
  if (task.warm_up_us > task.from_us || task.from_us >= task.to_us)
    return wrong("the times of the warm-up, of the begin and of the end are not in order");
  if (task.config.empty() || task.out.empty()) return wrong("a name is empty");
  task.logs.assign(words.begin() + kWordsBeforeLogs, words.end());
  return task;
}

std::optional<std::vector<ArchiveTask>> read_manifest(const std::string& path,
                                                      std::string& problem) {
  const auto text = daemon::read_text_file(path, problem);
  if (!text) {
    problem = path + ": " + problem;
    return std::nullopt;
  }
  std::vector<ArchiveTask> out;
  for (std::size_t at = 0; at < text->size();) {
    const std::size_t end = std::min(text->find('\n', at), text->size());
    const int line = static_cast<int>(out.size()) + 1;
    std::string rule;
    auto task = read_manifest_line(std::string_view(*text).substr(at, end - at), rule);
    if (task && task->number != line) rule = fmt::format("is numbered {}", task->number);
    if (!rule.empty()) {
      problem = fmt::format("{}:{}: {}", path, line, rule);
      return std::nullopt;
    }
    out.push_back(std::move(*task));
    at = end + 1;
  }
  if (out.empty()) {
    problem = path + ": holds no task";
    return std::nullopt;
  }
  return out;
}

}  // namespace framewatch::fleet
