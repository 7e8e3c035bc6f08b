#include <algorithm>
#include <cmath>
#include <complex>

#include "estimator/diagnose/localise.h"

namespace framewatch {
namespace {

using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXcd;
using Eigen::VectorXd;

bool same_direction(const MatrixXd& a, const MatrixXd& b) {
  if (a.cols() != 1 || b.cols() != 1) return false;
  const double cosine = std::abs(a.col(0).dot(b.col(0))) / (a.norm() * b.norm());
  return cosine > 1 - 1e-9;
}

void add_forces(std::vector<Suspect>& out, Suspect suspect) {
  if (!(suspect.directions.colwise().norm().minCoeff() > 0)) return;
  for (const Suspect& s : out)
    if (s.directions.size() > 0 && same_direction(s.directions, suspect.directions)) return;
  out.push_back(std::move(suspect));
}

/// Forces of a moment at the base, as the frames' stiffnesses pass it on.
MatrixXd moment_of(const Plant& plant, const Model& model, Direction direction) {
  const Structure& s = plant.structure;
  MatrixXd out = MatrixXd::Zero(plant.equations(), 1);
  for (const Element& e : plant.elements)
    if (e.frame >= 0 && s.direction(e.frame) == direction)
      out += model.theta[e.stiffness] * s.story_height[static_cast<std::size_t>(e.story - 1)] *
             plant.building.act.col(e.stiffness);
  return out;
}

}  // namespace

void follow(const Plant& plant, const Model& model, std::vector<Suspect>& suspects) {
  for (Suspect& s : suspects)
    if (s.kind == Suspect::Kind::rocking) s.directions = moment_of(plant, model, s.place.direction);
}

std::vector<Suspect> suspects_of(const Plant& plant, const Model& model) {
  std::vector<Suspect> out;
  const Structure& s = plant.structure;
  // One equation does not tell a reading from a force.
  for (Index a = 0; a < plant.axis_count() && plant.equations() > 1; ++a) {
    Suspect axis;
    axis.kind = Suspect::Kind::axis;
    axis.axis = static_cast<int>(a);
    axis.place.kind = PlaceKind::channel;
    axis.place.channel = axis.axis;
    out.push_back(axis);
  }
  if (plant.stiff_floors)
    for (int story = 1; story <= s.stories; ++story) {
      Suspect floor;
      floor.kind = Suspect::Kind::floor;
      floor.place.kind = PlaceKind::floor;
      floor.place.story = story;
      floor.directions.resize(plant.equations(), s.panels());
      for (int p = 0; p < s.panels(); ++p)
        floor.directions.col(p) = plant.building.act.col(plant.table.panel_stiffness(story, p));
      add_forces(out, floor);
    }
  for (const Element& e : plant.elements) {
    if (plant.stiff_floors && e.panel >= 0) continue;
    Suspect element;
    element.kind = Suspect::Kind::element;
    element.element = e.stiffness;
    element.place.kind = e.frame >= 0 ? PlaceKind::frame : PlaceKind::panel;
    element.place.story = e.story;
    element.place.frame = e.frame;
    element.place.panel = e.panel;
    element.directions = plant.building.act.col(e.stiffness);
    add_forces(out, element);
  }
  for (int story = 1; story <= s.stories; ++story)
    for (int f = 0; f < s.frames(); ++f) {
      Suspect node;
      node.kind = Suspect::Kind::node;
      node.place.kind = PlaceKind::node;
      node.place.story = story;
      node.place.frame = f;
      node.directions = node_direction(plant, story, f);
      add_forces(out, node);
      for (int to = 1; to <= story - 2; ++to) {
        Suspect link = node;
        link.kind = Suspect::Kind::link;
        link.place.kind = PlaceKind::node_pair;
        link.place.to_story = to;
        link.directions -= node_direction(plant, to, f);
        add_forces(out, link);
      }
    }
  if (s.n() > 0 && s.m() > 0)
    for (int story = 1; story <= s.stories; ++story)
      for (int crossing = 0; crossing < s.n() * s.m(); ++crossing) {
        Suspect mass;
        mass.kind = Suspect::Kind::crossing;
        mass.place.kind = PlaceKind::crossing;
        mass.place.story = story;
        mass.place.crossing = crossing;
        mass.directions.resize(plant.equations(), 2);
        const std::vector<int> frames = frames_at(s, crossing);
        mass.directions << node_direction(plant, story, frames[0]),
            node_direction(plant, story, frames[1]);
        add_forces(out, mass);
      }
  for (const Direction direction : {Direction::x, Direction::y}) {
    if ((direction == Direction::x ? s.n() : s.m()) == 0) continue;
    Suspect rocking;
    rocking.kind = Suspect::Kind::rocking;
    rocking.place.kind = PlaceKind::building;
    rocking.place.direction = direction;
    rocking.directions = moment_of(plant, model, direction);
    add_forces(out, rocking);
  }
  return out;
}

MatrixXcd suspect_basis(const Whitened& system, Index bin, const std::vector<Suspect>& suspects) {
  const auto at = static_cast<std::size_t>(bin);
  const Index n = system.operation[at].rows();
  Index count = 0;
  for (const Suspect& s : suspects) count += s.size();
  MatrixXcd out(n, count);
  Index next = 0;
  for (const Suspect& s : suspects) {
    if (s.directions.size() > 0) {
      for (Index c = 0; c < s.directions.cols(); ++c)
        out.col(next++) = s.directions.col(c).cast<std::complex<double>>();
    } else {
      out.col(next++) = system.operation[at].col(s.axis);
    }
  }
  out = (system.weights->whitener(bin) * out).eval();
  for (Index c = 0; c < count; ++c) {
    const double before = out.col(c).norm();
    for (Index b = 0; b < c; ++b) out.col(c) -= out.col(b) * out.col(b).dot(out.col(c));
    const double norm = out.col(c).norm();
    out.col(c) /= norm > 1e-9 * before ? norm : 1e300;
  }
  return out;
}

}  // namespace framewatch
