#include "estimator/diagnose/fit/run_columns.h"

#include <algorithm>
#include <cstdlib>

#include "estimator/diagnose/model/law_port.h"

namespace framewatch::estimator {
namespace {

using Eigen::Index;
using Eigen::VectorXcd;
using Eigen::VectorXd;
using Kind = Unknown::Kind;

constexpr double kChange = 1e-3;  ///< of a stiffness, for its derivative
/// Returns true if a stiffness is at the law or next to it. In a large building others move the run
/// too little for the cost of a run.
bool is_near(const EffectPlace& law, int story, int frame) {
  return law.frame == frame && std::abs(law.story - story) <= 1;
}

/// Returns the free run with an unknown changed. Keeps the modes of a large building.
FreeRun changed_run(const Plant& plant, const Model& model, const RecordSegment& segment,
                    std::size_t record, const Unknown& unknown, double change, int ratio,
                    RunCache* cache) {
  if (plant.is_large() && unknown.kind == Kind::theta) {
    std::vector<SmallSpring> springs{{unknown.index, change * unknown.scale}};
    for (const auto& [index, scale] : unknown.tied) springs.push_back({index, change * scale});
    return free_run(plant, model, segment, record, ratio, cache, springs);
  }
  Model moved = model;
  set_value(moved, unknown, value_of(model, unknown) + change);
  return free_run(plant, moved, segment, record, ratio, cache);
}

}  // namespace

bool moves_run(const Plant& plant, const Model& model, const Unknown& unknown) {
  if (unknown.kind == Kind::parameter || unknown.kind == Kind::record_parameter) return true;
  const Structure& s = plant.structure;
  int frame = -1, story = 0;  // -1: all directions
  if (unknown.kind == Kind::theta) {
    if (unknown.index >= plant.element_count()) return false;
    frame = plant.table[unknown.index].frame;
    if (frame < 0) return false;
    story = plant.table[unknown.index].story;
  } else if (unknown.kind == Kind::mass && !plant.is_large()) {
    if (plant.equations() == s.degrees_of_freedom()) {
      frame = unknown.index % s.frames();
      story = unknown.index / s.frames() + 1;
    }
  } else {
    return false;
  }
  return std::any_of(model.effects.begin(), model.effects.end(), [&](const ModelEffect& e) {
    if (plant.is_large() && frame >= 0) return e.element_law() && is_near(e.place, story, frame);
    return e.element_law() &&
           (frame < 0 || e.place.kind == PlaceKind::panel ||
            (e.place.frame < 0 ? e.place.direction : s.direction(e.place.frame)) ==
                s.direction(frame));
  });
}

std::optional<VectorXd> run_column(const Plant& plant, const Model& model,
                                   const RecordSegment& segment, std::size_t record,
                                   const Whitened& system, const Unknown& unknown, int ratio,
                                   RunCache* cache) {
  const double change = unknown.kind == Kind::theta ? kChange : 1.0;
  const FreeRun run = changed_run(plant, model, segment, record, unknown, change, ratio, cache);
  if (!run.good) return std::nullopt;
  Eigen::MatrixXcd forces = Eigen::MatrixXcd::Zero(plant.equations(), system.bins());
  std::size_t law = 0;
  for (const ActiveLaw& active : active_laws(plant, model)) {
    const LawTrack &from = system.tracks[law], &to = run.tracks[law];
    const VectorXcd force = band_of((to.force - from.force) / change, segment, ratio);
    const VectorXcd d = band_of((to.d - from.d) / change, segment, ratio);
    forces += active.port.act * beyond(system.linear[law], force, d, segment.w).transpose();
    ++law;
  }
  return whiten_rows(system, forces);
}

}  // namespace framewatch::estimator
