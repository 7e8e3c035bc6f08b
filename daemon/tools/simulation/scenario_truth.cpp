#include "daemon/tools/simulation/scenario_truth.h"

#include <vector>

#include "estimator/structure/natural_frequencies.h"
#include "estimator/structure/parameter_table.h"

namespace framewatch::daemon {
namespace {

class TruthReader {
 public:
  TruthReader(const estimator::Structure& structure, const Eigen::VectorXd& design,
              ConfigSection& section)
      : structure_(structure), table_(structure), section_(section), theta_(design) {}

  Eigen::VectorXd read() {
    const bool has_design = theta_.size() == table_.size();
    if (!has_design) theta_ = Eigen::VectorXd::Zero(table_.size());
    const bool kx = frames("kx_npm", 0, structure_.n(), 0);
    const bool ky = frames("ky_npm", structure_.n(), structure_.m(), 0);
    const bool gk = panels("gk", 0);
    if (!has_design) {
      require(kx || structure_.n() == 0, "kx_npm");
      require(ky || structure_.m() == 0, "ky_npm");
      require(gk || structure_.panels() == 0, "gk");
    }
    const bool stiffness_known =
        table_.elements() > 0 && theta_.head(table_.elements()).minCoeff() > 0;
    if (stiffness_known && (kx || ky || gk || section_.given("damping_ratio") || !has_design))
      theta_ =
          with_proportional_damping(structure_, table_, theta_, section_.number("damping_ratio"));
    frames("cx_nspm", 0, structure_.n(), table_.elements());
    frames("cy_nspm", structure_.n(), structure_.m(), table_.elements());
    panels("gc", table_.elements());
    return theta_;
  }

 private:
  bool frames(const char* key, int first, int count, int offset) {
    if (!section_.given(key)) return false;
    const std::vector<double> grid = section_.grid(key, {structure_.stories, count});
    if (grid.empty()) return false;
    for (int story = 1; story <= structure_.stories; ++story)
      for (int f = 0; f < count; ++f)
        theta_[table_.frame_stiffness(story, first + f) + offset] =
            grid[static_cast<std::size_t>((story - 1) * count + f)];
    return true;
  }

  bool panels(const char* key, int offset) {
    if (!section_.given(key)) return false;
    if (structure_.panels() == 0) {
      section_.problem(key, "this building has no floor panels");
      return false;
    }
    const std::vector<double> grid =
        section_.grid(key, {structure_.stories, structure_.n() - 1, structure_.m() - 1});
    if (grid.empty()) return false;
    for (int story = 1; story <= structure_.stories; ++story)
      for (int p = 0; p < structure_.panels(); ++p)
        theta_[table_.panel_stiffness(story, p) + offset] =
            grid[static_cast<std::size_t>((story - 1) * structure_.panels() + p)];
    return true;
  }

  void require(bool holds, const char* key) {
    if (!holds && section_.good(key))
      section_.problem(key,
                       "is missing, and the building has no [structure.design] to take it from");
  }

  const estimator::Structure& structure_;
  estimator::ParameterTable table_;
  ConfigSection& section_;
  Eigen::VectorXd theta_;
};

}  // namespace

Eigen::VectorXd read_truth(ConfigSection& section, const estimator::Structure& structure,
                           const Eigen::VectorXd& design) {
  return TruthReader(structure, design, section).read();
}

}  // namespace framewatch::daemon
