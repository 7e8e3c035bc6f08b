// SPDX-License-Identifier: MIT
#include "daemon/command_line/command_list.h"

#include <cstdint>

#include <CLI/CLI.hpp>

#include "daemon/base/exit_code.h"
#include "daemon/base/record_file_arguments.h"
#include "drivers/files/input_file.h"
#include "drivers/files/standard_streams.h"
#include "drivers/records/record_options.h"

namespace framewatch::daemon {

std::string CommandList::program() const {
  return app_.get_name();
}

CLI::App* CommandList::add(const std::string& name, const std::string& purpose,
                           const std::string& footer) {
  return app_.add_subcommand(name, purpose)->footer(footer);
}

void CommandList::set_action(CLI::App* command, std::function<int()> action,
                             std::function<void()> prepare) {
  command->callback([this, command, action = std::move(action), prepare = std::move(prepare)] {
    if (prepare) prepare();
    chosen_ = action;
    name_of_chosen_ = command->get_name();
  });
}

void CommandList::reads_files(CLI::Option* option) {
  option->transform(CLI::Validator(
      [this](std::string& path) {
        reads_file(path);
        return std::string();
      },
      ""));
}

void CommandList::reads_file(std::string& path) {
  if (path != "-") return;
  ++reads_standard_input_;
  path = drivers::kStandardInput;
}

int CommandList::run_chosen() const {
  if (!chosen_) return kBadInput;
  if (reads_standard_input_ > 1)
    return refuse(name_of_chosen_, "- is standard input and can be given only once");
  if (reads_standard_input_ == 1)
    if (const std::string why = drivers::keep_standard_input(); !why.empty())
      return refuse(name_of_chosen_, "standard input " + why);
  return chosen_();
}

CLI::Option* add_file(CLI::App* command, const char* name, std::string& file, const char* what) {
  return command->add_option(name, file, what)->type_name("FILE");
}

CLI::Option* add_folder(CLI::App* command, const char* name, std::string& folder,
                        const char* what) {
  return command->add_option(name, folder, what)->type_name("DIR");
}

void add_config(CommandList& commands, CLI::App* command, std::string& config) {
  commands.reads_files(
      command->add_option("CONFIG", config, "configuration file (TOML)")->required());
}

void add_installed_config(CLI::App* command, std::string& config) {
  command->add_option("CONFIG", config, "configuration file (TOML)")->capture_default_str();
}

void add_url(CLI::App* command, std::string& url) {
  command->add_option("--url", url, "LCM provider to use instead of the configuration's");
}

void add_json(CLI::App* command, bool& json) {
  command->add_flag("--json", json, "print JSON for programs");
}

void add_record_options(CLI::App* command, RecordFileArguments& record, const char* format) {
  command->add_option(
      "--unit", record.unit,
      "unit of a file that does not state it: g, mg, gal, mps2, or the m/s^2 of one");
  add_file(command, "--station-xml", record.station_xml,
           "StationXML of a miniSEED or SAC file's network, with units and more");
  command->add_option("--step", record.step_s, "seconds between samples of a file without times");
  command->add_option("--time", record.time,
                      "title of the column (or MATLAB variable) with the times");
  command->add_option("--time-unit", record.time_unit, "unit of that column: s, ms, us or ns");
  command->add_option("--zone", record.zone,
                      "time zone of time stamps without one: Z, or an offset such as +09:00");
  command->add_option("--decimal", record.decimal,
                      "decimal mark if a file leaves it open: comma or point");
  command
      ->add_option("--columns", record.columns,
                   "titles of the columns (or MATLAB variables, SEED channels) to read: A,B,...")
      ->delimiter(',')
      ->allow_extra_args(false);
  command
      ->add_option("--names", record.names, "names of the channels, in the file's order: A,B,...")
      ->delimiter(',')
      ->allow_extra_args(false);
  command->add_option(format, record.format, drivers::record_format_names())->capture_default_str();
}

void add_max_size(CLI::App* command) {
  command
      ->add_option_function<std::uint64_t>(
          "--max-size",
          [](const std::uint64_t& bytes) {
            drivers::set_unpack_limit(static_cast<std::int64_t>(bytes));
          },
          "largest unpacked size of a compressed input, for example 16GiB (default: 4000\ntimes "
          "its size or 64 MiB, whichever is more, but at most 4 GiB)")
      ->type_name("SIZE")
      ->transform(CLI::AsSizeValue(false) & CLI::Range(std::uint64_t{1}, std::uint64_t{1} << 60));
}

}  // namespace framewatch::daemon
