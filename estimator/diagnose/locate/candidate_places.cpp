// SPDX-License-Identifier: MIT
#include "estimator/diagnose/locate/candidate_places.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <utility>

#include "estimator/numeric/complex.h"

namespace framewatch::estimator {
namespace {

using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXcd;
using Eigen::VectorXd;

/// Share of a direction's square below which it depends on the directions before it.
constexpr double kIndependent = 1e-12;

Complex product(const Eigen::RowVectorXcd& equations, const BinProducts::Direction& direction) {
  Complex out = 0;
  for (const BinProducts::Entry& e : direction)
    out += equations[e.equation] * Complex(e.real, e.imaginary);
  return out;
}

PlaceProducts products_of(const BinProducts& products, const std::vector<CandidatePlace>& places,
                          bool with_columns) {
  std::vector<BinProducts::Direction> directions;
  for (const CandidatePlace& place : places) {
    if (place.kind == CandidatePlace::Kind::axis)
      directions.push_back(products.of_axis(place.axis));
    for (Index c = 0; c < place.directions.cols(); ++c)
      directions.push_back(products.of_force(place.directions.col(c)));
  }
  PlaceProducts out;
  const auto count = static_cast<Index>(directions.size());
  for (Index i = 0; i < count; ++i) {
    const BinProducts::Direction& direction = directions[static_cast<std::size_t>(i)];
    const Eigen::RowVectorXcd equations = products.under_metric(direction);
    Eigen::RowVectorXcd columns;
    if (with_columns) columns = products.with_columns(direction);
    if (i == 0) {
      out.equations = MatrixXcd::Zero(count, equations.size());
      out.columns = MatrixXcd::Zero(count, columns.size());
    }
    out.equations.row(i) = equations;
    out.columns.row(i) = columns;
    const double before = product(equations, direction).real();
    double square = before;
    // equations.row(k) force: the product of the orthonormal direction k with this one.
    for (Index k = 0; k < i; ++k) {
      const Complex with = product(out.equations.row(k), direction);
      out.equations.row(i) -= std::conj(with) * out.equations.row(k);
      out.columns.row(i) -= std::conj(with) * out.columns.row(k);
      square -= std::norm(with);
    }
    const double scale = square > kIndependent * before ? 1 / std::sqrt(square) : 0.0;
    out.equations.row(i) *= scale;
    out.columns.row(i) *= scale;
  }
  return out;
}

bool same_direction(const MatrixXd& a, const MatrixXd& b) {
  if (a.cols() != 1 || b.cols() != 1) return false;
  const double cosine = std::abs(a.col(0).dot(b.col(0))) / (a.norm() * b.norm());
  return cosine > 1 - 1e-9;
}

/// Returns true if the axes read most of a motion.
bool is_read(const Plant& plant, const VectorXd& motion) {
  constexpr double kMax = 0.5;
  return plant.unread.cols() == 0 ||
         (plant.read.transpose() * motion).squaredNorm() > kMax * motion.squaredNorm();
}

/// Returns true if an element shares its factors with others: its force cannot be separated from
/// theirs.
bool is_tied(const Plant& plant, int element) {
  return !plant.groups.empty() &&
         std::none_of(plant.groups.begin(), plant.groups.end(), [&](const TiedStories& group) {
           return group.elements == std::vector<int>{element};
         });
}

void add_forces(std::vector<CandidatePlace>& out, CandidatePlace candidate_place) {
  if (!(candidate_place.directions.colwise().norm().minCoeff() > 0)) return;
  for (const CandidatePlace& s : out)
    if (s.directions.size() > 0 && same_direction(s.directions, candidate_place.directions)) return;
  out.push_back(std::move(candidate_place));
}

/// Returns the forces of a rotation of the base, through the stiffnesses of the frames in one
/// direction.
MatrixXd moment_of(const Plant& plant, const Model& model, Direction direction) {
  const Structure& s = plant.structure;
  MatrixXd out = MatrixXd::Zero(plant.equations(), 1);
  for (const Element& e : plant.elements)
    if (e.frame >= 0 && s.direction(e.frame) == direction)
      out += model.theta[e.stiffness] * s.story_height[static_cast<std::size_t>(e.story - 1)] *
             plant.building.act.col(e.stiffness);
  return out;
}

std::vector<CandidatePlace> axes_of(const Plant& plant) {
  std::vector<CandidatePlace> out;
  for (Index a = 0; a < plant.axis_count(); ++a) {
    CandidatePlace axis;
    axis.kind = CandidatePlace::Kind::axis;
    axis.axis = static_cast<int>(a);
    axis.place.kind = PlaceKind::channel;
    axis.place.channel = axis.axis;
    out.push_back(axis);
  }
  return out;
}

void add_floors(const Plant& plant, std::vector<CandidatePlace>& out) {
  const Structure& s = plant.structure;
  for (int story = 1; story <= s.stories; ++story) {
    CandidatePlace floor;
    floor.kind = CandidatePlace::Kind::floor;
    floor.place.kind = PlaceKind::floor;
    floor.place.story = story;
    floor.directions.resize(plant.equations(), s.panels());
    for (int p = 0; p < s.panels(); ++p)
      floor.directions.col(p) = plant.building.act.col(plant.table.panel_stiffness(story, p));
    add_forces(out, floor);
  }
}

void add_elements(const Plant& plant, std::vector<CandidatePlace>& out) {
  for (const Element& e : plant.elements) {
    if ((plant.stiff_floors && e.panel >= 0) || is_tied(plant, e.stiffness)) continue;
    CandidatePlace element;
    element.kind = CandidatePlace::Kind::element;
    element.element = e.stiffness;
    element.place.kind = e.frame >= 0 ? PlaceKind::frame : PlaceKind::panel;
    element.place.story = e.story;
    element.place.frame = e.frame;
    element.place.panel = e.panel;
    element.directions = plant.building.act.col(e.stiffness);
    add_forces(out, element);
  }
}

/// Adds forces on every frame at every floor, and pairs of them between floors that are not
/// adjacent.
void add_nodes_and_links(const Plant& plant, std::vector<CandidatePlace>& out) {
  const Structure& s = plant.structure;
  for (int story = 1; story <= s.stories; ++story)
    for (int f = 0; f < s.frames(); ++f) {
      CandidatePlace node;
      node.kind = CandidatePlace::Kind::node;
      node.place.kind = PlaceKind::node;
      node.place.story = story;
      node.place.frame = f;
      node.directions = node_direction(plant, story, f);
      if (!is_read(plant, node.directions)) continue;
      add_forces(out, node);
      for (int to = 1; to <= story - 2 && plant.groups.empty(); ++to) {
        CandidatePlace link = node;
        link.kind = CandidatePlace::Kind::link;
        link.place.kind = PlaceKind::node_pair;
        link.place.to_story = to;
        link.directions -= node_direction(plant, to, f);
        add_forces(out, link);
      }
    }
}

void add_crossings(const Plant& plant, std::vector<CandidatePlace>& out) {
  const Structure& s = plant.structure;
  for (int story = 1; story <= s.stories; ++story)
    for (int crossing = 0; crossing < s.n() * s.m(); ++crossing) {
      CandidatePlace mass;
      mass.kind = CandidatePlace::Kind::crossing;
      mass.place.kind = PlaceKind::crossing;
      mass.place.story = story;
      mass.place.crossing = crossing;
      mass.directions.resize(plant.equations(), 2);
      const std::vector<int> frames = frames_at(s, crossing);
      mass.directions << node_direction(plant, story, frames[0]),
          node_direction(plant, story, frames[1]);
      if (is_read(plant, mass.directions.col(0)) && is_read(plant, mass.directions.col(1)))
        add_forces(out, mass);
    }
}

void add_rocking(const Plant& plant, const Model& model, std::vector<CandidatePlace>& out) {
  const Structure& s = plant.structure;
  for (const Direction direction : {Direction::x, Direction::y}) {
    if ((direction == Direction::x ? s.n() : s.m()) == 0) continue;
    if (plant.bending[direction == Direction::x ? 0 : 1] > 0) continue;  // part of the design
    CandidatePlace rocking;
    rocking.kind = CandidatePlace::Kind::rocking;
    rocking.place.kind = PlaceKind::building;
    rocking.place.direction = direction;
    rocking.directions = moment_of(plant, model, direction);
    add_forces(out, rocking);
  }
}

}  // namespace

void update_directions(const Plant& plant, const Model& model,
                       std::vector<CandidatePlace>& candidate_places) {
  for (CandidatePlace& s : candidate_places)
    if (s.kind == CandidatePlace::Kind::rocking)
      s.directions = moment_of(plant, model, s.place.direction);
}

std::vector<CandidatePlace> candidate_places_of(const Plant& plant, const Model& model) {
  std::vector<CandidatePlace> out;
  // With one equation, an error of a reading is indistinguishable from a force.
  if (plant.equations() > 1) out = axes_of(plant);
  if (plant.stiff_floors) add_floors(plant, out);
  add_elements(plant, out);
  add_nodes_and_links(plant, out);
  add_crossings(plant, out);
  add_rocking(plant, model, out);
  return out;
}

MatrixXcd candidate_basis(const Whitened& system, Index bin,
                          const std::vector<CandidatePlace>& candidate_places) {
  const auto at = static_cast<std::size_t>(bin);
  const Index n = system.operation.equations();
  Index count = 0;
  for (const CandidatePlace& s : candidate_places) count += s.size();
  MatrixXcd out(n, count);
  Index next = 0;
  for (const CandidatePlace& s : candidate_places) {
    if (s.directions.size() > 0) {
      for (Index c = 0; c < s.directions.cols(); ++c)
        out.col(next++) = s.directions.col(c).cast<std::complex<double>>();
    } else {
      out.col(next++) = system.operation[at].col(s.axis);
    }
  }
  const Whitener& whitener = system.weights->whitener(bin);
  for (Index c = 0; c < count; ++c) out.col(c) = whitener.times(out.col(c));
  for (Index c = 0; c < count; ++c) {
    const double before = out.col(c).norm();
    for (Index b = 0; b < c; ++b) out.col(c) -= out.col(b) * out.col(b).dot(out.col(c));
    const double norm = out.col(c).norm();
    out.col(c) /= norm > 1e-9 * before ? norm : 1e300;
  }
  return out;
}

PlaceProducts place_products(const BinProducts& products,
                             const std::vector<CandidatePlace>& places) {
  return products_of(products, places, true);
}

MatrixXcd place_equations(const BinProducts& products, const std::vector<CandidatePlace>& places) {
  return products_of(products, places, false).equations;
}

}  // namespace framewatch::estimator
