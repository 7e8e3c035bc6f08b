#include "daemon/config/keys/grid.h"

#include <algorithm>
#include <iterator>

#include <fmt/core.h>

namespace framewatch::daemon {
namespace {

int depth(const TomlValue& value) {
  if (value.kind != TomlKind::array) return 0;
  int deepest = 0;
  for (const TomlValue& item : value.items) deepest = std::max(deepest, depth(item));
  return 1 + deepest;
}

/// The sizes the file's nesting has to have: those of size 1 go, last first, while there are more
/// dimensions than nesting.
std::vector<int> sizes_for_depth(std::vector<int> sizes, int nesting) {
  while (static_cast<int>(sizes.size()) > nesting) {
    const auto one = std::find(sizes.rbegin(), sizes.rend(), 1);
    if (one == sizes.rend()) break;
    sizes.erase(std::next(one).base());
  }
  return sizes;
}

void read_level(const TomlValue& value, const std::vector<int>& sizes, std::size_t level,
                GridReading& out) {
  if (!out.problem.empty()) return;
  const bool is_list = value.kind == TomlKind::array;
  if (level == sizes.size()) {
    if (is_list) {
      out.place = value.place;
      out.problem = "here a number is expected, found a list";
    } else {
      out.values.push_back(value.number);
    }
    return;
  }
  const auto wanted = static_cast<std::size_t>(sizes[level]);
  if (!is_list || value.items.size() != wanted) {
    out.place = value.place;
    out.problem = fmt::format("here a list of {} is expected, found {}", wanted,
                              is_list ? fmt::format("{}", value.items.size()) : "a number");
    return;
  }
  for (const TomlValue& item : value.items) read_level(item, sizes, level + 1, out);
}

}  // namespace

GridReading read_grid(const TomlValue& value, const std::vector<int>& sizes) {
  GridReading out;
  if (value.kind != TomlKind::array) {
    std::size_t count = 1;
    for (const int size : sizes) count *= static_cast<std::size_t>(size);
    out.values.assign(count, value.number);
    return out;
  }
  read_level(value, sizes_for_depth(sizes, depth(value)), 0, out);
  if (!out.problem.empty()) out.values.clear();
  return out;
}

std::string size_text(const std::vector<int>& sizes) {
  std::string out;
  for (const int size : sizes) out += fmt::format("{}{}", out.empty() ? "" : " x ", size);
  return out;
}

}  // namespace framewatch::daemon
