// SPDX-License-Identifier: MIT
#include "daemon/base/record_file_arguments.h"

#include <fmt/core.h>

#include "drivers/records/unit_text.h"

namespace framewatch::daemon {

bool RecordFileArguments::any() const {
  return !unit.empty() || !station_xml.empty() || step_s != 0 || format != "detect" ||
         !time.empty() || !time_unit.empty() || !zone.empty() || !decimal.empty() ||
         !columns.empty() || !names.empty();
}

drivers::RecordOptions record_options(const RecordFileArguments& a,
                                      std::vector<drivers::Problem>& problems) {
  drivers::RecordOptions out;
  const auto wrong = [&](const char* option, const std::string& value, const std::string& rule) {
    problems.push_back({option, fmt::format("'{}' is not {}", value, rule)});
  };
  if (const auto format = drivers::record_format(a.format))
    out.format = *format;
  else
    wrong("--format", a.format, drivers::record_format_names());
  out.unit_mps2 = drivers::declared_unit(a.unit);
  if (!a.unit.empty() && !out.unit_mps2)
    wrong("--unit", a.unit, "g, mg, gal or mps2, nor a number of m/s^2");
  out.station_xml = a.station_xml;
  if (a.step_s != 0) out.step_s = a.step_s;
  out.time_column = a.time;
  out.time_unit_s = drivers::seconds_per(a.time_unit);
  if (!a.time_unit.empty() && !out.time_unit_s)
    wrong("--time-unit", a.time_unit, "s, ms, us or ns");
  out.zone_min = drivers::parse_zone(a.zone);
  if (!a.zone.empty() && !out.zone_min) wrong("--zone", a.zone, "Z, nor an offset such as +09:00");
  if (a.decimal == "comma" || a.decimal == "point")
    out.decimal = a.decimal == "comma" ? ',' : '.';
  else if (!a.decimal.empty())
    wrong("--decimal", a.decimal, "comma or point");
  out.columns = a.columns;
  out.names = a.names;
  return out;
}

}  // namespace framewatch::daemon
