// SPDX-License-Identifier: MIT
#pragma once

#include <any>
#include <functional>
#include <list>
#include <string>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace framewatch::daemon {

struct RecordFileArguments;

/// The commands of the program with their options. Each add_<command> below declares one command:
/// its options, which write the fields of its arguments struct, and what runs when it is chosen.
class CommandList {
 public:
  explicit CommandList(CLI::App& app) : app_(app) {}

  /// Returns the program's name: framewatch, or framewatch fleet.
  [[nodiscard]] std::string program() const;

  /// Adds a command without options. `footer` stands below its options in --help.
  CLI::App* add(const std::string& name, const std::string& purpose,
                const std::string& footer = "");

  /// Returns arguments with their defaults. They live as long as the list.
  template <class Arguments>
  Arguments& arguments() {
    return *std::any_cast<Arguments>(&arguments_.emplace_back(Arguments{}));
  }

  /// Sets the action of `command`, which returns the exit status. The action may throw
  /// CLI::ParseError for options that exclude each other. `prepare` runs first, when the options
  /// are parsed.
  void set_action(CLI::App* command, std::function<int()> action,
                  std::function<void()> prepare = {});

  /// Declares an option that names files to read. "-" means standard input.
  void reads_files(CLI::Option* option);
  /// Checks one path, in `prepare`.
  void reads_file(std::string& path);

  /// Runs the chosen command after parsing and returns its exit status. Returns 2 if no command was
  /// chosen or its standard input cannot be read.
  [[nodiscard]] int run_chosen() const;

 private:
  CLI::App& app_;
  std::list<std::any> arguments_;
  std::function<int()> chosen_;
  std::string name_of_chosen_;
  int reads_standard_input_ = 0;  ///< times
};

/// Adds an option that names a file, or a folder.
CLI::Option* add_file(CLI::App* command, const char* name, std::string& file, const char* what);
CLI::Option* add_folder(CLI::App* command, const char* name, std::string& folder, const char* what);

// Options that several commands have.
void add_config(CommandList& commands, CLI::App* command,
                std::string& config);                               ///< CONFIG, required
void add_installed_config(CLI::App* command, std::string& config);  ///< CONFIG, with a default
void add_url(CLI::App* command, std::string& url);                  ///< --url
void add_json(CLI::App* command, bool& json);                       ///< --json
/// Adds --unit, --step and similar options for properties that a record does not state. format: the
/// option for the format of record files.
void add_record_options(CLI::App* command, RecordFileArguments& record,
                        const char* format = "--format");
void add_max_size(CLI::App* command);  ///< --max-size of unpacked input

// help_commands.cpp: commands of every program.
void add_help(CommandList& commands);
void add_completion(CommandList& commands);

// live_commands.cpp: the daemon and commands for a running daemon.
void add_demo(CommandList& commands);
void add_run(CommandList& commands);
void add_serve(CommandList& commands);
void add_status(CommandList& commands);
void add_acknowledge(CommandList& commands);
void add_note(CommandList& commands);
void add_tell(CommandList& commands);
void add_selftest(CommandList& commands);

// record_commands.cpp: sources, conversion and reports of records.
void add_simulate(CommandList& commands);
void add_record(CommandList& commands);
void add_report(CommandList& commands);
void add_convert(CommandList& commands);
void add_history(CommandList& commands);

// record_commands.cpp: estimates and repair of logs.
void add_replay(CommandList& commands);
void add_diff(CommandList& commands);
void add_compare(CommandList& commands);
void add_repair(CommandList& commands);
void add_refine(CommandList& commands);
void add_modes(CommandList& commands);

// command_line.cpp: commands of framewatch-fleet, listed here.
void add_fleet(CommandList& commands);
void add_uplink(CommandList& commands);

// model_commands.cpp: configurations and models.
void add_init(CommandList& commands);
void add_export(CommandList& commands);
void add_check(CommandList& commands);
void add_reproduce(CommandList& commands);
void add_diagnose(CommandList& commands);
void add_adopt(CommandList& commands);

}  // namespace framewatch::daemon
