#include "daemon/base/damaged_database.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "daemon/base/utc_time.h"

namespace framewatch::daemon {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kDamagedKept = 3;
constexpr const char* kDamagedEnding = ".corrupt-";
constexpr const char* kOfDatabase[] = {"-wal", "-shm", ""};

/// A name that nothing has yet.
std::string name_aside(const std::string& database, std::int64_t now_us) {
  const std::string stamp = database + kDamagedEnding + utc_stamp(now_us);
  std::string name = stamp;
  std::error_code none;
  for (int i = 2; fs::exists(fs::symlink_status(name, none)); ++i)
    name = fmt::format("{}_{}", stamp, i);
  return name;
}

void remove_least(const fs::path& database) {
  const std::string begin = database.filename().string() + kDamagedEnding;
  const fs::path directory = database.has_parent_path() ? database.parent_path() : ".";
  std::vector<std::pair<std::int64_t, std::string>> found;
  std::error_code none;
  for (fs::directory_iterator at(directory, none), end; !none && at != end; at.increment(none)) {
    const std::string name = at->path().filename().string();
    if (!name.starts_with(begin) || name.ends_with("-wal") || name.ends_with("-shm")) continue;
    std::error_code failure;
    const auto bytes = at->file_size(failure);
    found.emplace_back(failure ? 0 : static_cast<std::int64_t>(bytes), at->path().string());
  }
  if (found.size() <= kDamagedKept) return;
  std::sort(found.rbegin(), found.rend());
  for (std::size_t i = kDamagedKept; i < found.size(); ++i)
    for (const char* beside : kOfDatabase) fs::remove(found[i].second + beside, none);
}

}  // namespace

void set_aside_database(const std::string& database, std::int64_t now_us, const std::string& reason,
                        SetAside& out) {
  const std::string name = name_aside(database, now_us);
  out.problem.clear();
  // The log first: beside a new database the old log would be taken for its own.
  for (const char* beside : kOfDatabase) {
    if (std::rename((database + beside).c_str(), (name + beside).c_str()) == 0) continue;
    if (errno == ENOENT) continue;
    out.problem = fmt::format("{} is corrupt and cannot be set aside: {}", database + beside,
                              std::strerror(errno));
    return;
  }
  ++out.count;
  out.path = name;
  out.reason = reason;
  remove_least(database);
}

}  // namespace framewatch::daemon
