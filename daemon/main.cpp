#include <functional>

#include <fmt/core.h>
#include <CLI/CLI.hpp>

// The one translation unit that sees CLI11 (it costs seconds to compile): it turns the command line
// into plain argument structs; every command lives in its own file.
namespace {

/// What the chosen subcommand will do; set by its CLI11 callback.
using Action = std::function<int()>;

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{
      "framewatch: stiffness and damping of every frame and floor panel of a building,\n"
      "from its accelerometers, while it moves."};
  app.name("framewatch");
  app.require_subcommand(1);
  app.set_version_flag("--version", FRAMEWATCH_VERSION);
  Action action;

  // add_<command>(app, action) calls go here, one per command, in the order people meet them.

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  return action ? action() : 2;
}
