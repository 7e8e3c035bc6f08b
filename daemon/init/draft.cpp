#include "daemon/init/draft.h"

namespace framewatch::daemon {

const ChannelColumns& ColumnCache::record(const std::string& path,
                                          const RecordFileArguments& arguments) {
  const auto [at, fresh] = read_.try_emplace(path + options_text(arguments));
  if (fresh) at->second = columns_of_record(path, arguments);
  return at->second;
}

const ChannelColumns& ColumnCache::dbc(const std::string& path, const std::string& interface) {
  const auto [at, fresh] = read_.try_emplace(interface + " " + path);
  if (fresh) at->second = columns_of_dbc(path, interface);
  return at->second;
}

}  // namespace framewatch::daemon
