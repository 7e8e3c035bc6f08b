// SPDX-License-Identifier: MIT
// A small interpreter of the commands of OpenSees that `framewatch export` writes: it assembles
// mass, damping and stiffness, and integrates. Elements and materials follow the manual and the
// source of OpenSees, not framewatch's equations.
#pragma once

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <Eigen/LU>

#include "estimator/numeric/eigenvalues.h"

namespace framewatch::test {

/// Words of one command, its name first.
using OpenSeesLine = std::vector<std::string>;

/// Splits a Tcl script of plain commands.
inline std::vector<OpenSeesLine> tcl_lines(const std::string& text) {
  std::vector<OpenSeesLine> out;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    line = line.substr(0, line.find('#'));
    std::replace(line.begin(), line.end(), ';', ' ');
    std::istringstream words(line);
    OpenSeesLine command;
    for (std::string word; words >> word;) command.push_back(word);
    if (!command.empty()) out.push_back(command);
  }
  return out;
}

class OpenSeesInterpreter {
 public:
  explicit OpenSeesInterpreter(const std::vector<OpenSeesLine>& lines) {
    for (const OpenSeesLine& line : lines) run(line);
    constrain();
  }

  /// Mass, damping and stiffness of the coordinates that have mass; coordinates without mass follow
  /// statically.
  struct System {
    Eigen::MatrixXd mass, damping, stiffness;
    Eigen::MatrixXd motion;  ///< degrees of freedom of all nodes x coordinates
  };
  System system() const {
    const Eigen::MatrixXd full_mass = full_masses().asDiagonal();
    Eigen::MatrixXd k = Eigen::MatrixXd::Zero(size(), size()), c = k;
    for (const Element& e : elements_) {
      k += e.volume * tangent(e.material) * e.b * e.b.transpose();
      c += e.volume * damping(e.material) * e.b * e.b.transpose();
    }
    const Eigen::MatrixXd m = motion_.transpose() * full_mass * motion_;
    k = motion_.transpose() * k * motion_;
    c = motion_.transpose() * c * motion_;
    std::vector<Eigen::Index> heavy, light;
    for (Eigen::Index i = 0; i < m.rows(); ++i)
      (m.row(i).cwiseAbs().sum() > 0 ? heavy : light).push_back(i);
    Eigen::MatrixXd keep = Eigen::MatrixXd::Zero(m.rows(), static_cast<Eigen::Index>(heavy.size()));
    for (std::size_t i = 0; i < heavy.size(); ++i) keep(heavy[i], static_cast<Eigen::Index>(i)) = 1;
    if (!light.empty()) {
      const Eigen::MatrixXd inner = k(light, light), side = k(light, heavy);
      const Eigen::MatrixXd follow = -inner.fullPivLu().solve(side);
      for (std::size_t i = 0; i < light.size(); ++i)
        keep.row(light[i]) = follow.row(static_cast<Eigen::Index>(i));
    }
    System out{keep.transpose() * m * keep, keep.transpose() * c * keep,
               keep.transpose() * k * keep, motion_ * keep};
    if (!modal_ratios_.empty()) add_modal_damping(out);
    return out;
  }

  /// Returns the row of a node's degree of freedom, 1 to 6, in System::motion. The node is the
  /// first one defined at these coordinates.
  Eigen::Index row(double x, double y, double z, int dof) const {
    for (const auto& [tag, at] : order_)
      if ((at - Eigen::Vector3d(x, y, z)).norm() < 1e-9) return 6 * index_.at(tag) + dof - 1;
    throw std::runtime_error("no node at these coordinates");
  }
  /// Returns the row of a degree of freedom of the node defined last.
  Eigen::Index last_row(int dof) const { return 6 * index_.at(order_.back().first) + dof - 1; }

  /// Integrates relative motion from rest under ground acceleration along x and y, which is linear
  /// between samples `step_s` apart, in steps of step_s / parts by the classical scheme of Runge
  /// and Kutta. Returns the displacements of all nodes' degrees of freedom at each sample.
  std::vector<Eigen::VectorXd> integrate(const std::vector<Eigen::Vector2d>& ground, double step_s,
                                         int parts) {
    const Eigen::MatrixXd t = motion_;
    const Eigen::MatrixXd full_mass = full_masses().asDiagonal();
    const Eigen::MatrixXd inverse = Eigen::MatrixXd(t.transpose() * full_mass * t).inverse();
    const Eigen::MatrixXd push = -inverse * t.transpose() * full_mass;
    const Eigen::Index n = t.cols();
    std::vector<Law> laws;
    for (const Element& e : elements_) flatten(e, e.material, inverse, laws);
    Eigen::Index states = 2 * n;
    for (Law& law : laws) {
      law.state = states;
      states += law.material->type == "BoucWen" ? 2 : 0;
    }
    const auto slope = [&](const Eigen::VectorXd& y, const Eigen::Vector2d& a) {
      Eigen::VectorXd out = Eigen::VectorXd::Zero(states);
      Eigen::VectorXd base = Eigen::VectorXd::Zero(size());
      for (Eigen::Index i = 0; i < size(); i += 6) base.segment(i, 2) = a;
      out.head(n) = y.segment(n, n);
      out.segment(n, n) = push * base;
      for (const Law& law : laws) {
        const double strain = law.b.dot(y.head(n)), rate = law.b.dot(y.segment(n, n));
        out.segment(n, n) -= law.push * stress(law, strain, rate, y);
        if (law.material->type == "BoucWen") {
          const auto& p = law.material->numbers;  // alpha ko n gamma beta Ao dA dNu dEta
          const double z = y[law.state], work = y[law.state + 1];
          const double sign = rate * z > 0 ? 1 : -1;
          const double phi = p[5] - p[6] * work -
                             std::pow(std::abs(z), p[2]) * (p[3] + p[4] * sign) * (1 + p[7] * work);
          out[law.state] = phi / (1 + p[8] * work) * rate;
          out[law.state + 1] = (1 - p[0]) * p[1] * z * rate;
        }
      }
      return out;
    };
    Eigen::VectorXd y = Eigen::VectorXd::Zero(states);
    std::vector<Eigen::VectorXd> out{t * y.head(n)};
    const double h = step_s / parts;
    for (std::size_t s = 0; s + 1 < ground.size(); ++s) {
      for (int part = 0; part < parts; ++part) {
        const auto at = [&](double share) -> Eigen::Vector2d {
          return ground[s] + (ground[s + 1] - ground[s]) * (part + share) / parts;
        };
        const Eigen::VectorXd k1 = slope(y, at(0)), k2 = slope(y + h / 2 * k1, at(0.5)),
                              k3 = slope(y + h / 2 * k2, at(0.5)), k4 = slope(y + h * k3, at(1));
        y += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
        for (Law& law : laws)
          if (law.material->type == "ElasticPP") {
            const double strain = law.b.dot(y.head(n)), yield = law.material->numbers[1];
            law.slider = strain - std::clamp(strain - law.slider, -yield, yield);
          }
      }
      out.push_back(t * y.head(n));
    }
    return out;
  }

 private:
  struct Material {
    std::string type;
    std::vector<double> numbers;
  };
  struct Element {
    Eigen::VectorXd b;  ///< strain for each degree of freedom of the nodes
    double volume;      ///< work of a unit of stress and strain
    int material;
  };
  struct Law {
    const Material* material;
    Eigen::VectorXd b, push;
    Eigen::Index state = 0;
    double slider = 0;
  };

  static double number(const std::string& word) { return std::stod(word); }
  static int tag(const std::string& word) { return std::stoi(word); }
  Eigen::Index size() const { return 6 * static_cast<Eigen::Index>(order_.size()); }
  Eigen::VectorXd full_masses() const {
    Eigen::VectorXd out = Eigen::VectorXd::Zero(size());
    for (const auto& [dof, mass] : masses_) out[dof] = mass;
    return out;
  }

  void run(const OpenSeesLine& line) {
    const std::string& name = line.front();
    if (name == "node") {
      index_[tag(line.at(1))] = static_cast<Eigen::Index>(order_.size());
      order_.emplace_back(tag(line.at(1)), Eigen::Vector3d(number(line.at(2)), number(line.at(3)),
                                                           number(line.at(4))));
    } else if (name == "fix") {
      for (std::size_t d = 0; d < 6; ++d)
        if (line.at(d + 2) == "1") fixed_.insert(dof_of(line.at(1), static_cast<int>(d) + 1));
    } else if (name == "mass") {
      for (std::size_t d = 0; d < 6; ++d)
        masses_[dof_of(line.at(1), static_cast<int>(d) + 1)] = number(line.at(d + 2));
    } else if (name == "equalDOF" || name == "rigidDiaphragm") {
      constraints_.push_back(line);
    } else if (name == "uniaxialMaterial") {
      Material material{line.at(1), {}};
      for (std::size_t i = 3; i < line.size(); ++i)
        if (line[i][0] != '-' || std::isdigit(static_cast<unsigned char>(line[i][1])))
          material.numbers.push_back(number(line[i]));
      if (!materials_.emplace(tag(line.at(2)), material).second)
        throw std::runtime_error("a tag twice");
    } else if (name == "element") {
      add_element(line);
    } else if (name == "constraints") {
      handler_ = line.at(1);
    } else if (name == "modalDamping") {
      for (std::size_t i = 1; i < line.size(); ++i) modal_ratios_.push_back(number(line[i]));
    } else if (name != "wipe" && name != "model" && name != "eigen") {
      throw std::runtime_error("unknown command " + name);
    }
  }

  Eigen::Index dof_of(const std::string& node, int dof) const {
    return 6 * index_.at(tag(node)) + dof - 1;
  }

  void add_element(const OpenSeesLine& line) {
    const std::string& type = line.at(1);
    const Eigen::Index i = index_.at(tag(line.at(3))), j = index_.at(tag(line.at(4)));
    const Eigen::Vector3d span =
        order_[static_cast<std::size_t>(j)].second - order_[static_cast<std::size_t>(i)].second;
    if (type == "truss") {
      Eigen::VectorXd b = Eigen::VectorXd::Zero(size());
      b.segment(6 * i, 3) = -span / span.squaredNorm();
      b.segment(6 * j, 3) = span / span.squaredNorm();
      elements_.push_back({b, number(line.at(5)) * span.norm(), tag(line.at(6))});
      return;
    }
    std::map<std::string, std::vector<std::string>> options;
    std::string option;
    for (std::size_t w = 5; w < line.size(); ++w) {
      if (line[w][0] == '-' && std::isalpha(static_cast<unsigned char>(line[w][1])))
        option = line[w];
      else
        options[option].push_back(line[w]);
    }
    Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  // rows: local x, y, z
    double from_i = 0.5, length = 0;
    if (type == "twoNodeLink") {
      length = span.norm();
      const auto& orient = options.at("-orient");
      const Eigen::Vector3d y(number(orient.at(0)), number(orient.at(1)), number(orient.at(2)));
      axes.row(0) = span.normalized();
      axes.row(2) = Eigen::Vector3d(axes.row(0)).cross(y).normalized();
      axes.row(1) = Eigen::Vector3d(axes.row(2)).cross(Eigen::Vector3d(axes.row(0)));
      if (options.contains("-shearDist")) from_i = number(options["-shearDist"].at(0));
    } else if (type != "zeroLength") {
      throw std::runtime_error("unknown element " + type);
    } else if (span.norm() > 1e-6) {
      throw std::runtime_error("zeroLength of some length");
    }
    for (std::size_t d = 0; d < options.at("-dir").size(); ++d) {
      const int dir = std::stoi(options["-dir"][d]) - 1;
      Eigen::VectorXd b = Eigen::VectorXd::Zero(size());
      const Eigen::Index part = dir < 3 ? 0 : 3;
      b.segment(6 * i + part, 3) = -axes.row(dir % 3);
      b.segment(6 * j + part, 3) = axes.row(dir % 3);
      if (dir == 1) {
        b.segment(6 * i + 3, 3) = -from_i * length * axes.row(2);
        b.segment(6 * j + 3, 3) = -(1 - from_i) * length * axes.row(2);
      }
      elements_.push_back({b, 1, tag(options.at("-mat").at(d))});
    }
  }

  void constrain() {
    for (Element& e : elements_) {  // nodes may stand after elements
      const Eigen::Index before = e.b.size();
      e.b.conservativeResize(size());
      e.b.tail(size() - before).setZero();
    }
    std::map<Eigen::Index, std::vector<std::pair<Eigen::Index, double>>> follows;
    std::map<std::string, int> constraints_of_node;
    for (const OpenSeesLine& line : constraints_) {
      if (line.front() == "equalDOF") {
        for (std::size_t d = 3; d < line.size(); ++d) {
          const int dof = std::stoi(line[d]);
          follows[dof_of(line.at(2), dof)] = {{dof_of(line.at(1), dof), 1.0}};
        }
        ++constraints_of_node[line.at(2)];
        continue;
      }
      if (handler_ != "Transformation") throw std::runtime_error("Plain holds equalDOF only");
      const Eigen::Vector3d& from = place(line.at(2));
      for (std::size_t w = 3; w < line.size(); ++w) {
        const Eigen::Vector3d arm = place(line[w]) - from;
        if (arm.z() != 0) throw std::runtime_error("a diaphragm lies in one plane");
        const Eigen::Index turn = dof_of(line.at(2), 6);
        follows[dof_of(line[w], 1)] = {{dof_of(line.at(2), 1), 1.0}, {turn, -arm.y()}};
        follows[dof_of(line[w], 2)] = {{dof_of(line.at(2), 2), 1.0}, {turn, arm.x()}};
        follows[dof_of(line[w], 6)] = {{turn, 1.0}};
        ++constraints_of_node[line[w]];
      }
    }
    for (const auto& [node, count] : constraints_of_node)
      if (handler_ == "Transformation" && count > 1)
        throw std::runtime_error("Transformation takes one constraint a node");
    std::map<Eigen::Index, Eigen::Index> free;
    for (Eigen::Index dof = 0; dof < size(); ++dof)
      if (!fixed_.contains(dof) && !follows.contains(dof))
        free.emplace(dof, static_cast<Eigen::Index>(free.size()));
    motion_ = Eigen::MatrixXd::Zero(size(), static_cast<Eigen::Index>(free.size()));
    for (const auto& [dof, column] : free) motion_(dof, column) = 1;
    for (const auto& [dof, terms] : follows) {
      if (fixed_.contains(dof)) throw std::runtime_error("fixed and constrained");
      for (const auto& [master, factor] : terms) {
        if (follows.contains(master)) throw std::runtime_error("a chain of constraints");
        if (!fixed_.contains(master)) motion_(dof, free.at(master)) += factor;
      }
    }
  }
  const Eigen::Vector3d& place(const std::string& node) const {
    return order_[static_cast<std::size_t>(index_.at(tag(node)))].second;
  }

  double tangent(int material) const {
    const Material& m = materials_.at(material);
    double sum = 0;
    if (m.type == "Parallel")
      for (const double part : m.numbers) sum += tangent(static_cast<int>(part));
    if (m.type == "Elastic" || m.type == "ElasticPP") return m.numbers[0];
    if (m.type == "BoucWen") return m.numbers[1];
    if (m.type == "ElasticPPGap") return m.numbers[2] == 0 ? m.numbers[0] : 0;
    return sum;
  }
  double damping(int material) const {
    const Material& m = materials_.at(material);
    double sum = 0;
    if (m.type == "Parallel")
      for (const double part : m.numbers) sum += damping(static_cast<int>(part));
    return m.type == "Elastic" ? m.numbers[1] : sum;
  }

  void flatten(const Element& e, int material, const Eigen::MatrixXd& inverse,
               std::vector<Law>& out) const {
    const Material& m = materials_.at(material);
    if (m.type == "Parallel") {
      for (const double part : m.numbers) flatten(e, static_cast<int>(part), inverse, out);
      return;
    }
    const Eigen::VectorXd b = motion_.transpose() * e.b;
    out.push_back({&m, b, inverse * b * e.volume, 0, 0});
  }

  static double stress(const Law& law, double strain, double rate, const Eigen::VectorXd& y) {
    const Material& m = *law.material;
    const auto& p = m.numbers;
    if (m.type == "Elastic") return p[0] * strain + p[1] * rate;
    if (m.type == "ElasticPowerFunc")
      return p[0] * std::copysign(std::pow(std::abs(strain), p[1]), strain);
    if (m.type == "Viscous") return p[0] * std::copysign(std::pow(std::abs(rate), p[1]), rate);
    if (m.type == "ElasticPP") return p[0] * std::clamp(strain - law.slider, -p[1], p[1]);
    if (m.type == "ElasticPPGap") {
      const bool touches = p[1] > 0 ? strain > p[2] : strain < p[2];
      return touches ? p[0] * (strain - p[2]) : 0;
    }
    if (m.type == "BoucWen") return p[0] * p[1] * strain + (1 - p[0]) * p[1] * y[law.state];
    throw std::runtime_error("unknown material " + m.type);
  }

  void add_modal_damping(System& s) const {
    const estimator::RealEigen modes = estimator::generalized_eigen(s.stiffness, s.mass);
    for (std::size_t i = 0; i < modal_ratios_.size(); ++i) {
      const auto at = static_cast<Eigen::Index>(i);
      const Eigen::VectorXd push = s.mass * modes.vectors.col(at);
      s.damping += 2 * modal_ratios_[i] * std::sqrt(modes.values[at]) * push * push.transpose();
    }
  }

  std::map<int, Eigen::Index> index_;
  std::vector<std::pair<int, Eigen::Vector3d>> order_;
  std::set<Eigen::Index> fixed_;
  std::map<Eigen::Index, double> masses_;
  std::vector<OpenSeesLine> constraints_;
  std::map<int, Material> materials_;
  std::vector<Element> elements_;
  std::string handler_;
  std::vector<double> modal_ratios_;
  Eigen::MatrixXd motion_;  ///< degrees of freedom of all nodes x free coordinates
};

}  // namespace framewatch::test
