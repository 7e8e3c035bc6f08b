// SPDX-License-Identifier: MIT
#include "fleet/archive/archive_task.h"

#include <elf.h>
#include <fcntl.h>
#include <link.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <climits>
#include <cstddef>
#include <cstring>
#include <string_view>
#include <utility>

#include <fmt/core.h>

#include "daemon/base/file_digest.h"
#include "drivers/files/number_text.h"
#include "drivers/files/partial_file.h"

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

/// Returns false if the previous owner of the lock has removed or replaced the file.
bool is_still_named(int file, const std::string& path) {
  struct stat open {
  }, named{};
  return ::fstat(file, &open) == 0 && ::lstat(path.c_str(), &named) == 0 &&
         open.st_ino == named.st_ino && open.st_dev == named.st_dev;
}

constexpr std::size_t aligned(std::size_t size) {
  return (size + 3) / 4 * 4;
}

/// Returns the build id among the notes of a segment; empty if it is missing.
std::string_view build_id_in(const char* at, std::size_t size) {
  while (size >= sizeof(ElfW(Nhdr))) {
    ElfW(Nhdr) note{};
    std::memcpy(&note, at, sizeof(note));
    const std::size_t name = sizeof(note), content = name + aligned(note.n_namesz);
    const std::size_t end = content + aligned(note.n_descsz);
    if (end > size) return {};
    if (note.n_type == NT_GNU_BUILD_ID && note.n_namesz == sizeof(ELF_NOTE_GNU) &&
        std::memcmp(at + name, ELF_NOTE_GNU, sizeof(ELF_NOTE_GNU)) == 0)
      return {at + content, note.n_descsz};
    at += end;
    size -= end;
  }
  return {};
}

/// Stores the build id of the first object, which is the program itself.
int look(dl_phdr_info* info, std::size_t, void* out) {
  for (int i = 0; i < info->dlpi_phnum; ++i) {
    const ElfW(Phdr)& segment = info->dlpi_phdr[i];
    if (segment.p_type != PT_NOTE) continue;
    const auto* const begin = reinterpret_cast<const char*>(info->dlpi_addr + segment.p_vaddr);
    const std::string_view id = build_id_in(begin, segment.p_memsz);
    if (!id.empty()) *static_cast<std::string*>(out) = id;
  }
  return 1;
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
    return wrong(fmt::format("{} words between tabs; a task has {} and its logs", words.size(),
                             kWordsBeforeLogs));
  ArchiveTask task;
  const auto number = drivers::parse_integer(words[0]);
  if (!number || *number < 1 || *number > INT_MAX)
    return wrong(words[0] + ": is not the number of a task, from 1");
  task.number = static_cast<int>(*number);
  if (!is_key(words[1]))
    return wrong(words[1] + ": is not a key: expected three groups of 12 hexadecimal digits");
  task.key = words[1];
  task.config = words[2];
  task.out = words[3];
  std::int64_t* const times[] = {&task.warm_up_us, &task.from_us, &task.to_us};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto time_us = drivers::parse_integer(words[4 + i]);
    if (!time_us) return wrong(words[4 + i] + ": is not a time in microseconds");
    *times[i] = *time_us;
  }
  if (task.warm_up_us > task.from_us || task.from_us >= task.to_us)
    return wrong("the times must be in the order warm-up, start, end");
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
    problem = path + ": has no task";
    return std::nullopt;
  }
  return out;
}

TaskLock::~TaskLock() {
  if (file_ < 0) return;
  ::unlink(path_.c_str());
  ::close(file_);
}

std::string TaskLock::take(const std::string& path) {
  for (;;) {
    const int file = drivers::open_own_file(path, O_RDWR | O_CREAT);
    if (file < 0) return std::strerror(errno);
    int locked = -1;
    do locked = ::flock(file, LOCK_EX);
    while (locked != 0 && errno == EINTR);
    const int why = errno;
    if (locked == 0 && is_still_named(file, path)) {
      path_ = path;
      file_ = file;
      return {};
    }
    ::close(file);
    if (locked != 0) return std::strerror(why);
  }
}

std::string program_identity() {
  static const std::string identity = [] {
    std::string id;
    ::dl_iterate_phdr(&look, &id);
    return id.empty() ? daemon::sha256_of_file("/proc/self/exe")
                      : daemon::sha256(FRAMEWATCH_VERSION " " + id);
  }();
  return identity;
}

}  // namespace framewatch::fleet
