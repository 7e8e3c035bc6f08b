#include "daemon/command_line/command_list.h"

#include <CLI/CLI.hpp>

namespace framewatch::daemon {

CLI::App* CommandList::add(const std::string& name, const std::string& purpose) {
  return app_.add_subcommand(name, purpose);
}

void CommandList::set_action(CLI::App* command, std::function<int()> action) {
  command->callback([this, action = std::move(action)] { chosen_ = action; });
}

void add_config(CLI::App* command, std::string& config) {
  command->add_option("CONFIG", config, "configuration file (TOML)")->required();
}

void add_installed_config(CLI::App* command, std::string& config) {
  command->add_option("CONFIG", config, "configuration file (TOML)")->capture_default_str();
}

void add_url(CLI::App* command, std::string& url) {
  command->add_option("--url", url, "LCM provider instead of the configuration's");
}

void add_json(CLI::App* command, bool& json) {
  command->add_flag("--json", json, "print what a program would read");
}

}  // namespace framewatch::daemon
