// SPDX-License-Identifier: MIT
#include "daemon/tools/init/draft.h"

namespace framewatch::daemon {

const ChannelColumns& ColumnCache::records(const std::vector<std::string>& paths,
                                           const RecordFileArguments& arguments) {
  std::string key = options_text(arguments);
  for (const std::string& path : paths) key += "\n" + path;
  const auto [at, fresh] = read_.try_emplace(key);
  if (fresh) at->second = columns_of_records(paths, arguments);
  return at->second;
}

const ChannelColumns& ColumnCache::dbc(const std::string& path, const std::string& interface) {
  const auto [at, fresh] = read_.try_emplace(interface + " " + path);
  if (fresh) at->second = columns_of_dbc(path, interface);
  return at->second;
}

}  // namespace framewatch::daemon
