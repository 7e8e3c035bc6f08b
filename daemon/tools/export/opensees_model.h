// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "estimator/structure/effect.h"
#include "estimator/structure/parameter_table.h"
#include "estimator/structure/structure.h"

namespace framewatch::daemon {

/// A building with its parameters and effects.
struct ExportedModel {
  estimator::Structure structure;
  Eigen::VectorXd theta;  ///< of every story, in the order of ParameterTable(structure), SI
  estimator::BendingStiffness bending_nmprad{};
  std::vector<estimator::Effect> effects;
};

/// A command of OpenSees: its name, its words, and a comment for people ("" for none).
struct OpenSeesCommand {
  std::string name;
  std::vector<std::string> words;
  std::string comment = {};
};

/// Returns the commands that make the model in OpenSees, in N, m, kg and s. Nodes with masses are
/// at the crossings. Each frame story is a twoNodeLink, each floor panel a truss along its
/// diagonal; effects are materials of them. Adds a problem for each effect that OpenSees does not
/// have; the commands are then incomplete. Effects of sensors are skipped.
std::vector<OpenSeesCommand> opensees_model(const ExportedModel& model,
                                            std::vector<std::string>& problems);

/// Returns the commands as a Tcl script, or as a Python script for openseespy. `head`: lines of a
/// comment at its top.
std::string tcl_text(const std::vector<OpenSeesCommand>& commands,
                     const std::vector<std::string>& head);
std::string python_text(const std::vector<OpenSeesCommand>& commands,
                        const std::vector<std::string>& head);

}  // namespace framewatch::daemon
