#pragma once

#include <any>
#include <functional>
#include <list>
#include <string>
#include <utility>

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

  /// The program as it is called: framewatch, or framewatch fleet.
  [[nodiscard]] std::string program() const;

  /// A command without options yet.
  CLI::App* add(const std::string& name, const std::string& purpose);

  /// Arguments with their defaults; they live as long as the list.
  template <class Arguments>
  Arguments& arguments() {
    return *std::any_cast<Arguments>(&arguments_.emplace_back(Arguments{}));
  }

  /// Sets the action of `command`, which returns the exit status. The action may throw
  /// CLI::ParseError for options that exclude each other. `prepare` runs first, when the options
  /// are parsed.
  void set_action(CLI::App* command, std::function<int()> action,
                  std::function<void()> prepare = {});

  /// This option names files to read: "-" is standard input.
  void reads_files(CLI::Option* option);
  /// Checks one path, in `prepare`.
  void reads_file(std::string& path);

  /// Runs the chosen command, after parsing. Returns its exit status; 2 when none was chosen, or
  /// when standard input, which it wants, cannot be had.
  [[nodiscard]] int run_chosen() const;

 private:
  CLI::App& app_;
  std::list<std::any> arguments_;
  std::function<int()> chosen_;
  std::string name_of_chosen_;
  int reads_standard_input_ = 0;  ///< times
};

// Options that several commands have.
void add_config(CommandList& commands, CLI::App* command,
                std::string& config);                               ///< CONFIG, required
void add_installed_config(CLI::App* command, std::string& config);  ///< CONFIG, with a default
void add_url(CLI::App* command, std::string& url);                  ///< --url
void add_json(CLI::App* command, bool& json);                       ///< --json
/// --unit, --step and the like: what a record does not say itself.
void add_record_options(CLI::App* command, RecordFileArguments& record);
void add_max_size(CLI::App* command);  ///< --max-size, of what compressed input unpacks to

// help_commands.cpp: what every program has.
void add_help(CommandList& commands);
void add_completion(CommandList& commands);

// live_commands.cpp: the daemon and what one does with it while it runs.
void add_demo(CommandList& commands);
void add_run(CommandList& commands);
void add_serve(CommandList& commands);
void add_status(CommandList& commands);
void add_acknowledge(CommandList& commands);
void add_tell(CommandList& commands);
void add_selftest(CommandList& commands);

// record_commands.cpp: where records come from and what they are turned into.
void add_simulate(CommandList& commands);
void add_record(CommandList& commands);
void add_report(CommandList& commands);
void add_convert(CommandList& commands);
void add_history(CommandList& commands);

// replay_commands.cpp: logs and estimates from logs.
void add_replay(CommandList& commands);
void add_diff(CommandList& commands);
void add_repair(CommandList& commands);
void add_refine(CommandList& commands);

// fleet_program.cpp: listed here, done by framewatch-fleet.
void add_fleet(CommandList& commands);
void add_uplink(CommandList& commands);

// model_commands.cpp: configurations and models.
void add_init(CommandList& commands);
void add_check(CommandList& commands);
void add_reproduce(CommandList& commands);
void add_diagnose(CommandList& commands);
void add_adopt(CommandList& commands);

}  // namespace framewatch::daemon
