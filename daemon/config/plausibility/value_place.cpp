#include "daemon/config/plausibility/value_place.h"

namespace framewatch::daemon {

bool is_list(const TomlValue& section, std::string_view key) {
  const TomlEntry* entry = section.find(key);
  return entry && entry->value.kind == TomlKind::array;
}

TextPlace place_in(const TomlValue& section, std::string_view key, std::size_t index,
                   std::size_t count) {
  const TomlEntry* entry = section.find(key);
  if (!entry) return section.place;
  const TomlValue* value = &entry->value;
  if (value->kind == TomlKind::array && value->items.size() == count) value = &value->items[index];
  while (value->kind == TomlKind::array && !value->items.empty()) value = &value->items.front();
  return value->place;
}

}  // namespace framewatch::daemon
