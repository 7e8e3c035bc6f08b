// SPDX-License-Identifier: MIT
#include "daemon/base/served_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>

#include "drivers/files/descriptor.h"

namespace framewatch::daemon {
namespace {

bool is_plain_name(const std::string& name) {
  return !name.empty() && name != "." && name != ".." && name.find('/') == std::string::npos &&
         name.find('\0') == std::string::npos;
}

bool is_small(const struct stat& file) {
  return file.st_size >= 0 && static_cast<std::uint64_t>(file.st_size) <= kMaxServedBytes;
}

/// Opens the folder of the last name. Returns false if it is not a folder, or a link.
bool open_parent(const std::string& folder, const std::vector<std::string>& names,
                 drivers::Descriptor& parent) {
  if (names.empty() || !std::all_of(names.begin(), names.end(), is_plain_name)) return false;
  constexpr int kFolder = O_RDONLY | O_DIRECTORY | O_CLOEXEC;
  parent.reset(::open(folder.c_str(), kFolder));
  for (std::size_t i = 0; i + 1 < names.size() && parent.get() >= 0; ++i)
    parent.reset(::openat(parent.get(), names[i].c_str(), kFolder | O_NOFOLLOW));
  return parent.get() >= 0;
}

/// Never opens a device, because opening alone can have an effect.
std::optional<struct stat> regular_file_in(const drivers::Descriptor& parent,
                                           const std::string& name) {
  struct stat file {};
  if (::fstatat(parent.get(), name.c_str(), &file, AT_SYMLINK_NOFOLLOW) != 0 ||
      !S_ISREG(file.st_mode))
    return std::nullopt;
  return file;
}

}  // namespace

drivers::Descriptor open_served_file(const std::string& folder,
                                     const std::vector<std::string>& names) {
  drivers::Descriptor parent, file;
  if (!open_parent(folder, names, parent) || !regular_file_in(parent, names.back())) return file;
  file.reset(::openat(parent.get(), names.back().c_str(),
                      O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_NOCTTY | O_CLOEXEC));
  struct stat now {};
  if (file.get() >= 0 && (::fstat(file.get(), &now) != 0 || !S_ISREG(now.st_mode))) file.reset(-1);
  return file;
}

std::optional<std::string> read_served_file(const std::string& folder,
                                            const std::vector<std::string>& names) {
  const drivers::Descriptor file = open_served_file(folder, names);
  struct stat now {};
  if (file.get() < 0 || ::fstat(file.get(), &now) != 0 || !is_small(now)) return std::nullopt;
  std::string text(static_cast<std::size_t>(now.st_size), '\0');
  std::size_t read = 0;
  while (read < text.size()) {
    const ssize_t got = ::read(file.get(), text.data() + read, text.size() - read);
    if (got < 0) return std::nullopt;
    if (got == 0) break;
    read += static_cast<std::size_t>(got);
  }
  text.resize(read);
  return text;
}

bool is_served_file(const std::string& folder, const std::vector<std::string>& names) {
  drivers::Descriptor parent;
  if (!open_parent(folder, names, parent)) return false;
  const auto file = regular_file_in(parent, names.back());
  return file && is_small(*file);
}

}  // namespace framewatch::daemon
