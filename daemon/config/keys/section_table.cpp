#include "daemon/config/keys/section_table.h"

namespace framewatch::daemon {
namespace {

const SectionDescription kSections[] = {
    {"structure", "[structure]",
     "The building. Frames are numbered x-parallel first (by y), then y-parallel (by x). One "
     "number stands for a list of equal values.",
     Reach::restart},
    {"structure.design", "[structure.design]",
     "Optional values from the drawings. They tune the filters before the first estimates and "
     "define the prior.",
     Reach::restart},
    {"channel", "[[channel]]",
     "One accelerometer axis. Each frame needs one on every floor, and the base needs one per "
     "direction with frames. The corrected value is polarity * (scale * raw - offset).",
     Reach::restart},
    {"channel.source", "source = { lcm ... }", "Samples from LCM.", Reach::restart},
    {"channel.source.can", "source = { can ... }", "Samples from CAN ([setup](can.md)).",
     Reach::restart},
    {"estimator", "[estimator]", "How windows are estimated and published.", Reach::restart},
    {"lcm", "[lcm]", "The LCM bus for samples and estimates.", Reach::restart},
    {"commands", "[commands]",
     "Where a daemon takes commands ([permissions](operate.md#who-may-give-commands)).",
     Reach::restart},
    {"can", "[[can]]", "One CAN bus.", Reach::restart},
    {"can_node", "[[can_node]]", "One sender of samples on a CAN bus, and its timing.",
     Reach::restart},
    {"watch", "[watch]", "Optional: detect lasting stiffness changes and publish them as events.",
     Reach::settings},
    {"gap", "[gap]",
     "Optional: simulate the building and compare with its measurement ([the gap](gap.md)).",
     Reach::settings},
    {"history", "[history]",
     "Optional: `framewatch run` keeps raw samples, summaries and events on disk "
     "([history](history.md)).",
     Reach::restart},
    {"event_report", "[event_report]",
     "Optional: write a page and a JSON file after every strong motion ([after an "
     "earthquake](operate.md#after-an-earthquake)).",
     Reach::restart},
    {"fragility", "[fragility]",
     "Optional: drifts that damage stories, for the placard after strong motion "
     "([how](operate.md#drift-damage-and-placard)). Without this section, damage is not judged.",
     Reach::restart},
    {"actions", "[actions]",
     "Optional: `framewatch run` notifies people of events by a command and a webhook "
     "([actions](actions.md)).",
     Reach::settings},
    {"fleet", "[fleet]",
     "Optional: `framewatch uplink` sends the history to a hub of many buildings "
     "([fleet](fleet.md)). Needs [history]; `framewatch run` ignores this section.",
     Reach::settings},
    {"scenario", "Scenario files: at the top",
     "Input of `framewatch simulate`: the building and what happens to it."},
    {"truth", "[truth]",
     "The true values of the simulated building, unknown to the estimator. Defaults come from the "
     "design."},
    {"motion", "[motion]", "The ground motion."},
    {"sensors", "[sensors]", "Errors of every simulated accelerometer."},
    {"sensor", "[[sensor]]", "Different errors of one channel. All keys of [sensors] apply."},
    {"change", "[[change]]", "A parameter change during the simulation."},
    {"effect", "[[effect]]",
     "An effect beyond the linear building, in a scenario or a configuration. "
     "[Effects](effects.md) lists equations and the keys of each kind.",
     Reach::restart},
    {"expect", "Expectation files: at the top",
     "Input of `framewatch replay --expect`; `--write-expect` creates one ([replay in "
     "CI](replay-in-ci.md))."},
    {"expect.counts", "[counts]", "Expected counts."},
    {"expect.parameter", "[[parameter]]", "Expected values of a parameter or group."},
    {"expect.event", "[[event]]", "Expected events."},
    {"baseline.parameter", "Baseline files: [[parameter]]", "Reference values of [watch]."},
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
