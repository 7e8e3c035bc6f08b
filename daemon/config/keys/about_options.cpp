// SPDX-License-Identifier: MIT
#include "daemon/config/keys/about_options.h"

#include "daemon/config/keys/option_table.h"

namespace framewatch::daemon {
namespace {

const Option kAbout[] = {
    {.key = "date", .meaning = "Date of the report or test.", .target = into<&ReportAbout::date>},
    {.key = "laboratory", .meaning = "Who measured.", .target = into<&ReportAbout::laboratory>},
    {.key = "client", .meaning = "Who ordered it.", .target = into<&ReportAbout::client>},
    {.key = "author", .meaning = "Who wrote it.", .target = into<&ReportAbout::author>},
    {.key = "number", .meaning = "Number of the report.", .target = into<&ReportAbout::number>},
};

const Option kPhotograph[] = {
    {.key = "file",
     .required = true,
     .meaning = "JPEG or PNG file, at most 16 MiB, relative to this file.",
     .is_path = true,
     .target = into<&ReportPhotograph::file>},
    {.key = "caption", .meaning = "What it shows.", .target = into<&ReportPhotograph::caption>},
};

}  // namespace

std::vector<OptionSection> about_options() {
  return {{"about", kAbout}, {"about.photograph", kPhotograph}};
}

}  // namespace framewatch::daemon
