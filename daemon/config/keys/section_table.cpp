#include "daemon/config/keys/section_table.h"

namespace framewatch::daemon {
namespace {

const SectionDescription kSections[] = {
    {"structure", "[structure]",
     "The building. Frames at a floor are numbered x-parallel first, in order of y, then "
     "y-parallel, in order of x. A number stands for a list of equal values.",
     Reach::restart},
    {"structure.design", "[structure.design]",
     "Optional: what the drawings say, never taken for truth. It tunes the filters before the "
     "first estimates and is what the prior is about.",
     Reach::restart},
    {"channel", "[[channel]]",
     "One accelerometer axis each. Every frame has one on every floor, and the base one in every "
     "direction that has frames. The corrected value is polarity * (scale * raw - offset).",
     Reach::restart},
    {"channel.source", "source = { lcm ... }", "Samples that come over LCM.", Reach::restart},
    {"channel.source.can", "source = { can ... }",
     "Samples that come over CAN ([how to commission a bus](can.md)).", Reach::restart},
    {"estimator", "[estimator]", "How the windows are estimated and when a value is published.",
     Reach::restart},
    {"lcm", "[lcm]", "The bus the samples come from and the estimates go to.", Reach::restart},
    {"commands", "[commands]",
     "How a running daemon is told what to do ([who may](operate.md#who-may-give-commands)).",
     Reach::restart},
    {"can", "[[can]]", "One CAN bus each, and what it carries.", Reach::restart},
    {"can_node", "[[can_node]]",
     "One sender of samples on a CAN bus each, and how its samples get their time.",
     Reach::restart},
    {"watch", "[watch]",
     "Optional: stiffness is watched for lasting changes, and event_t messages say which element, "
     "how much, how sure and since when.",
     Reach::settings},
    {"gap", "[gap]",
     "Optional: the building is simulated beside its measurement, and what differs is told "
     "([the gap](gap.md)).",
     Reach::settings},
    {"history", "[history]",
     "Optional: `framewatch run` keeps raw samples, summaries and events on disk "
     "([history](history.md)).",
     Reach::restart},
    {"event_report", "[event_report]",
     "Optional: after every strong motion a page and a JSON file say what the building went "
     "through "
     "([after an earthquake](operate.md#after-an-earthquake)).",
     Reach::restart},
    {"fragility", "[fragility]",
     "Optional: at which drift stories are damaged, for the placard after strong motion "
     "([what it says](operate.md#drift-damage-and-placard)). Without it drifts are told and damage "
     "is not judged: no type is assumed.",
     Reach::restart},
    {"actions", "[actions]",
     "Optional: `framewatch run` tells people of events, by a command and a webhook "
     "([telling people](actions.md)).",
     Reach::settings},
    {"fleet", "[fleet]",
     "Optional, and only for `framewatch uplink`, which sends what the history holds to the hub of "
     "many buildings ([many buildings](fleet.md)). `framewatch run` does not look at it; the "
     "uplink "
     "reads it when it starts. It takes a [history].",
     Reach::settings},
    {"scenario", "Scenario files: at the top",
     "`framewatch simulate` reads a scenario: the building as above or `config`, and what happens "
     "to it."},
    {"truth", "[truth]", "What the virtual building is, which the estimator does not know."},
    {"motion", "[motion]", "What the ground does."},
    {"sensors", "[sensors]", "What every virtual accelerometer is like."},
    {"sensor", "[[sensor]]", "One that is different."},
    {"change", "[[change]]", "Something in the building that changes while it is shaken."},
    {"effect", "[[effect]]",
     "What the linear building leaves out, in a scenario or a configuration, once for each: kind, "
     "place and numbers; [effects](effects.md) has the equations, and which keys belong to which "
     "kind.",
     Reach::restart},
    {"expect", "Expectation files: at the top",
     "`framewatch replay --expect` holds a replay to such a file, `--write-expect` makes a first "
     "one "
     "([replay in CI](replay-in-ci.md))."},
    {"expect.counts", "[counts]", "What became of the input."},
    {"expect.parameter", "[[parameter]]", "What the windows of a parameter, or of a group, say."},
    {"expect.event", "[[event]]", "Alarms, by the time since when they hold."},
    {"baseline.parameter", "Baseline files: [[parameter]]", "Reference parameters of [watch]."},
};

}  // namespace

std::span<const SectionDescription> section_table() {
  return kSections;
}

const SectionDescription* find_section(std::string_view section) {
  for (const SectionDescription& s : kSections)
    if (s.section == section) return &s;
  return nullptr;
}

}  // namespace framewatch::daemon
