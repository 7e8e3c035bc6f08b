#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "daemon/config/keys/can_options.h"
#include "daemon/config/sections/can_signals.h"

namespace framewatch::daemon {

/// One sensor node while it is read: its table, if it has one, and the channels it carries.
struct CanNodeReading : CanNodeSettings {
  drivers::CanNodeMap map;
  std::optional<ConfigSection> section;
  std::size_t bus = 0;
  CanSignal counter, clock;
};

/// Reads the CAN part of a configuration: buses, sensor nodes, and the signals that are channels.
class CanConfigReader {
 public:
  CanConfigReader(const TomlValue& document, Config& config, std::vector<TextProblem>& problems)
      : document_(document), config_(config), problems_(problems) {}

  void run();

 private:
  std::optional<std::size_t> find_bus(const std::string& interface) const;
  std::string unknown_bus(const std::string& interface) const;

  // In can_nodes.cpp
  void read_node(const TomlValue& table);
  void read_times(CanNodeReading& node, ConfigSection& section);
  void read_stamp(const char* key, bool needed, bool allowed, CanSignal& found,
                  const CanNodeReading& node, ConfigSection& section);

  // In can_sources.cpp
  TextPlace place_of_source(std::size_t channel) const;
  void source_problem(std::size_t channel, const std::string& message);
  CanNodeReading* node_of(std::size_t channel, std::size_t bus, const std::string& message);
  void read_source(std::size_t channel);
  void add_reading(std::size_t channel, CanNodeReading& node, const CanSignal& found, int sample);
  /// The message's map at the multiplexor's value that this signal needs.
  drivers::CanMessageMap& message_map(CanNodeReading& node, const drivers::DbcMessage& m,
                                      const drivers::DbcSignal* multiplexor,
                                      const std::optional<std::int64_t>& at);

  // In can_finish.cpp
  void node_problem(CanNodeReading& node, const std::string& key, const std::string& message);
  /// The frame with the time stamp goes first; a node that carries no channel is left out.
  void finish_node(CanNodeReading& node);
  void check_ids();
  void check_pair(const drivers::CanNodeMap& a, const drivers::CanNodeMap& b);

  const TomlValue& document_;
  Config& config_;
  std::vector<TextProblem>& problems_;
  std::vector<CanBusReading> buses_;
  std::vector<CanNodeReading> nodes_;
};

/// [[can]], [[can_node]] and the sources of the channels into config.can. Problems of a DBC file
/// are reported at their place in it.
void read_can(const TomlValue& document, Config& config, std::vector<TextProblem>& problems);

}  // namespace framewatch::daemon
