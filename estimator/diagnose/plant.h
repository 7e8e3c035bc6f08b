#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "estimator/refine/measured_building.h"
#include "estimator/structure/matrices.h"
#include "estimator/structure/parameter_table.h"
#include "estimator/structure/sensors.h"
#include "estimator/structure/structure.h"

namespace framewatch {

/// The building under diagnosis: its equations as the sensors see them, and what is believed of
/// its parameters. One equation per coordinate (degree of freedom; of rigid floors: see
/// floor_constraint).
struct Plant {
  Plant(const Structure& s, const std::vector<SensorAxis>& sensors, Eigen::VectorXd believed,
        MeasuredBuilding equations);

  Structure structure;
  /// The floors are believed rigid, but sensors would show it if they were not: `structure` has
  /// flexible ones, with panels so stiff that nothing shows.
  bool stiff_floors = false;
  double highest_hz = 0;  ///< natural frequency of what is believed
  ParameterTable table;
  std::vector<SensorAxis> axes;
  Eigen::VectorXd design;  ///< theta order, > 0
  MeasuredBuilding building;
  std::vector<Element> elements;
  Eigen::MatrixXd constraint;  ///< degrees of freedom x coordinates
  Eigen::VectorXd mass;        ///< of the coordinates, kg
  Eigen::MatrixXd motion;      ///< coordinates x axes: their absolute motion
  Eigen::MatrixXd ground;      ///< degrees of freedom x axes: the ground's motion there
  /// equations x axes: minus where the force that an axis measures acts; zero for others.
  Eigen::MatrixXd push;
  /// A component's motion is prescribed and the force for it measured: the model's output is that
  /// force.
  bool prescribed = false;

  Eigen::Index equations() const { return building.equations(); }
  Eigen::Index element_count() const { return building.elements(); }
  Eigen::Index axis_count() const { return building.axes(); }
  bool is_force(Eigen::Index axis) const { return !push.col(axis).isZero(0); }
  /// Of the base, or of a force: what a simulation is driven by.
  bool is_input(Eigen::Index axis) const {
    return axes[static_cast<std::size_t>(axis)].story == 0 || is_force(axis);
  }
};

/// The same with one more axis, which measures a force (N) on one degree of freedom from outside.
/// frame and story of `axis` say where.
Plant with_force_axis(const Plant& plant, const SensorAxis& axis);

/// design: in the order of `structure`'s parameters. Empty when the equations need a motion that no
/// axis measures.
std::optional<Plant> make_plant(const Structure& structure, const std::vector<SensorAxis>& axes,
                                const Eigen::VectorXd& design, double rate_hz);

}  // namespace framewatch
