// SPDX-License-Identifier: MIT
#include "daemon/config/keys/option_table.h"
#include "estimator/structure/structure.h"

namespace framewatch::daemon {
namespace {

constexpr std::string_view kSized = "its sizes follow from stories and frames";
constexpr std::string_view kTheta = "its index in theta depends on the structure";

const Option kStructure[] = {
    {.key = "name",
     .default_value = "\"building\"",
     .meaning = "Name of the building.",
     .target = into<&estimator::Structure::name>},
    {.key = "stories",
     .required = true,
     .range = {1, 1000},
     .meaning = "Number of stories. Floor i is on top of story i; 0 is the ground.",
     .target = into<&estimator::Structure::stories>},
    {.key = "frames_x",
     .meaning =
         "Names of the frames parallel to x, in order of y. Empty for a plane building along y.",
     .target = into<&estimator::Structure::frames_x>},
    {.key = "frames_y",
     .meaning =
         "Names of the frames parallel to y, in order of x. Empty for a plane building along x.",
     .target = into<&estimator::Structure::frames_y>},
    {.key = "labels_x",
     .meaning =
         "What people call frames_x, such as \"north wall\": on the page, in events and reports. "
         "Default: their names.",
     .target = into<&estimator::Structure::labels_x>},
    {.key = "labels_y",
     .meaning = "What people call frames_y.",
     .target = into<&estimator::Structure::labels_y>},
    {.key = "span_x_m",
     .unit = "m",
     .shape = "[x span]",
     .default_value = "[]",
     .range = above(0, 1000),
     .meaning = "Distances between y-parallel frames, one less than frames_y.",
     .by_hand = kSized},
    {.key = "span_y_m",
     .unit = "m",
     .shape = "[y span]",
     .default_value = "[]",
     .range = above(0, 1000),
     .meaning = "Distances between x-parallel frames, one less than frames_x.",
     .by_hand = kSized},
    {.key = "story_height_m",
     .unit = "m",
     .shape = "[story]",
     .required = true,
     .range = above(0, 1000),
     .meaning = "Floor-to-floor heights.",
     .by_hand = kSized},
    {.key = "floor",
     .choices = "flexible|rigid",
     .meaning = "Whether floor panels shear in their plane.",
     .target = into<&estimator::Structure::floor>},
    {.key = "node_mass_kg",
     .unit = "kg",
     .shape = "[story][y][x]",
     .required = true,
     .range = above(0, 1e9),
     .meaning = "Mass at each frame crossing, one row per x-parallel frame. Plane buildings: also "
                "[story][frame].",
     .by_hand = kSized},

    {.key = "azimuth_y_deg",
     .unit = "deg",
     .range = {-360, 360},
     .meaning = "Compass direction of the building's +y axis, clockwise from north.",
     .by_hand = "goes into the channels' places"},

    {.key = "group_floors",
     .shape = "[floor]",
     .default_value = "[]",
     .range = {1, 1000},
     .meaning = "Measured floors at which groups of stories end, upward, if some floors have no "
                "channels. Default: all measured floors.",
     .by_hand = kSized},
    {.key = "mass_tolerance_ratio",
     .default_value = "0.02",
     .range = {0, 0.5},
     .meaning = "Standard deviation of a floor's mass. Adds to the error of absolute values.",
     .by_hand = kSized},
    {.key = "profile_tolerance_ratio",
     .default_value = "0.05",
     .range = {0, 0.5},
     .meaning = "Standard deviation of a story's design stiffness relative to its group. Adds to "
                "the error of absolute values.",
     .by_hand = kSized},
};

const Option kStructureDesign[] = {
    {.key = "kx_npm",
     .unit = "N/m",
     .shape = "[story][frame]",
     .range = above(0, 1e13),
     .meaning = "Stiffness of the x-parallel frames; required if there are any.",
     .by_hand = kTheta},
    {.key = "ky_npm",
     .unit = "N/m",
     .shape = "[story][frame]",
     .range = above(0, 1e13),
     .meaning = "Stiffness of the y-parallel frames; required if there are any.",
     .by_hand = kTheta},
    {.key = "gk",
     .unit = "N/(rad*m)",
     .shape = "[story][y span][x span]",
     .range = above(0, 1e13),
     .meaning = "Shear stiffness of the floor panels. Default: mean frame stiffness of the story "
                "below. Unused with rigid floors.",
     .by_hand = kTheta},
    {.key = "damping_ratio",
     .default_value = "0.02",
     .range = above(0, 1),
     .meaning = "Damping ratio of the first mode. Damping is proportional to stiffness unless "
                "given below.",
     .by_hand = kTheta},
    {.key = "cx_nspm",
     .unit = "N*s/m",
     .shape = "[story][frame]",
     .range = above(0, 1e13),
     .meaning = "Damping of the x-parallel frames.",
     .by_hand = kTheta},
    {.key = "cy_nspm",
     .unit = "N*s/m",
     .shape = "[story][frame]",
     .range = above(0, 1e13),
     .meaning = "Damping of the y-parallel frames.",
     .by_hand = kTheta},
    {.key = "gc",
     .unit = "N*s/(rad*m)",
     .shape = "[story][y span][x span]",
     .range = above(0, 1e13),
     .meaning = "Damping of the floor panels. Unused with rigid floors.",
     .by_hand = kTheta},
    {.key = "krx_nmprad",
     .unit = "N*m/rad",
     .shape = "[floor from the base up]",
     .range = above(0, 1e16),
     .meaning =
         "Rotational stiffness of x-parallel frames at each floor (effect frame_bending). Default: "
         "no bending. If only some floors have channels, the base's value is identified.",
     .by_hand = kTheta},
    {.key = "kry_nmprad",
     .unit = "N*m/rad",
     .shape = "[floor from the base up]",
     .range = above(0, 1e16),
     .meaning = "The same for y-parallel frames.",
     .by_hand = kTheta},
};

}  // namespace

std::vector<OptionSection> structure_options() {
  return {{"structure", kStructure, Reach::restart},
          {"structure.design", kStructureDesign, Reach::restart}};
}

}  // namespace framewatch::daemon
