#include "daemon/config/keys/fields.h"

#include <filesystem>
#include <string>

#include "daemon/config/keys/option_table.h"

namespace framewatch::daemon::fields_detail {

void place_files(std::string_view section, const void* owner, std::string_view directory,
                 void* settings) {
  for (const Option& o : options()) {
    if (o.section != section || o.target.owner != owner || !o.is_path) continue;
    std::string& file = *o.target.text(settings);
    if (!file.empty()) file = (std::filesystem::path(directory) / file).string();
  }
}

void take_reloadable(std::string_view section, const void* owner, const void* from, void* to) {
  for (const Option& o : options())
    if (o.section == section && o.target.owner == owner && o.reload && *o.reload != Reach::restart)
      o.target.copy(from, to);
}

}  // namespace framewatch::daemon::fields_detail
