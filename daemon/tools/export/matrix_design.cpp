// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/core.h>

#include "daemon/base/file_digest.h"
#include "daemon/tools/export/model_matrices.h"
#include "drivers/files/number_text.h"
#include "estimator/numeric/solve.h"
#include "estimator/structure/matrices.h"

namespace framewatch::daemon {
namespace {

constexpr double kMassTolerance = 1e-6;  ///< relative, of an entry of M to the largest
constexpr double kStiffnessRest = 0.01;  ///< share of K that frames and panels may leave

std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> out;
  while (!(line = drivers::trimmed(line)).empty()) {
    const std::size_t end = std::min(line.find_first_of(" \t"), line.size());
    out.push_back(line.substr(0, end));
    line.remove_prefix(end);
  }
  return out;
}

/// Fits K = sum of k b b' by least squares. Returns the k, and sets `rest` to the share of K that
/// they leave.
Eigen::VectorXd fitted(const std::vector<Eigen::VectorXd>& elements, const Eigen::MatrixXd& k,
                       double& rest) {
  const auto size = static_cast<Eigen::Index>(elements.size());
  Eigen::MatrixXd products(size, size);
  Eigen::VectorXd right(size);
  for (Eigen::Index i = 0; i < size; ++i) {
    const Eigen::VectorXd& b = elements[static_cast<std::size_t>(i)];
    right[i] = b.dot(k * b);
    for (Eigen::Index j = 0; j < size; ++j) {
      const double product = b.dot(elements[static_cast<std::size_t>(j)]);
      products(i, j) = product * product;
    }
  }
  const Eigen::VectorXd out = estimator::solve_positive(products, right);
  Eigen::MatrixXd left = k;
  for (Eigen::Index i = 0; i < size; ++i) {
    const Eigen::VectorXd& b = elements[static_cast<std::size_t>(i)];
    left -= out[i] * b * b.transpose();
  }
  rest = k.norm() > 0 ? left.norm() / k.norm() : 0;
  return out;
}

}  // namespace

std::optional<Eigen::MatrixXd> parse_matrix_market(const std::string& name, const std::string& text,
                                                   Eigen::Index size,
                                                   std::vector<std::string>& problems) {
  std::istringstream lines(text);
  int number = 0;
  const auto refuse = [&](const std::string& why) {
    problems.push_back(fmt::format("{}:{}: {}", name, number, why));
    return std::nullopt;
  };
  std::string line;
  const auto next = [&] {
    while (std::getline(lines, line)) {
      ++number;
      if (!line.starts_with('%') && !drivers::trimmed(line).empty()) return true;
    }
    return false;
  };
  std::getline(lines, line);
  ++number;
  const auto head = words_of(line);
  if (head.size() != 5 || head[0] != "%%MatrixMarket" || head[1] != "matrix" ||
      (head[2] != "coordinate" && head[2] != "array") ||
      (head[3] != "real" && head[3] != "integer" && head[3] != "double") ||
      (head[4] != "general" && head[4] != "symmetric"))
    return refuse("write %%MatrixMarket matrix coordinate (or array) real general (or symmetric)");
  const bool listed = head[2] == "coordinate", symmetric = head[4] == "symmetric";
  if (!next()) return refuse("the file ends before the numbers of rows and columns");
  const auto sizes = words_of(line);
  const std::size_t count_words = listed ? 3 : 2;
  const auto rows = sizes.size() == count_words ? drivers::parse_integer(sizes[0]) : std::nullopt;
  const auto columns =
      sizes.size() == count_words ? drivers::parse_integer(sizes[1]) : std::nullopt;
  if (!rows || !columns || *rows != size || *columns != size)
    return refuse(fmt::format("the building's matrices have {0} rows and {0} columns", size));
  const auto entries = listed ? drivers::parse_integer(sizes[2]) : std::nullopt;
  if (listed && (!entries || *entries < 0 || *entries > size * size))
    return refuse(fmt::format("the number of entries is 0 to {}", size * size));
  const std::int64_t count = entries.value_or(0);
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(size, size);
  const auto put = [&](Eigen::Index r, Eigen::Index c, std::string_view word) {
    const auto value = drivers::parse_number(word);
    if (!value || !std::isfinite(*value)) return false;
    out(r, c) = *value;
    if (symmetric) out(c, r) = *value;
    return true;
  };
  for (std::int64_t i = 0; i < count; ++i) {
    if (!next()) return refuse(fmt::format("the file ends after {} of {} entries", i, count));
    const auto words = words_of(line);
    const auto r = words.size() == 3 ? drivers::parse_integer(words[0]) : std::nullopt;
    const auto c = words.size() == 3 ? drivers::parse_integer(words[1]) : std::nullopt;
    if (!r || !c || *r < 1 || *r > size || *c < 1 || *c > size || !put(*r - 1, *c - 1, words[2]))
      return refuse(fmt::format("an entry is row, column (1 to {}) and a number", size));
  }
  for (Eigen::Index c = 0; !listed && c < size; ++c)
    for (Eigen::Index r = symmetric ? c : 0; r < size; ++r) {
      if (!next()) return refuse("the file ends before the last number");
      if (!put(r, c, drivers::trimmed(line))) return refuse("a number a line");
    }
  if (next()) return refuse("the file goes on after its last entry");
  return out;
}

std::optional<MatrixDesign> read_matrix_design(const estimator::Structure& s,
                                               const std::string& folder,
                                               std::vector<std::string>& problems) {
  const estimator::ParameterTable table(s);
  const std::size_t before = problems.size();
  const ModelMatrices own =
      model_matrices({s, Eigen::VectorXd::Ones(table.size()), {}, {}}, problems);
  const auto size = static_cast<Eigen::Index>(own.rows.size());
  const auto read = [&](const char* name) -> std::optional<Eigen::MatrixXd> {
    const std::string path = folder + "/" + name;
    std::string error;
    const auto text = read_text_file(path, error);
    if (!text) problems.push_back(path + ": " + error);
    return text ? parse_matrix_market(path, *text, size, problems) : std::nullopt;
  };
  const auto mass = read("M.mtx"), damping = read("C.mtx"), stiffness = read("K.mtx");
  if (problems.size() > before) return std::nullopt;
  Eigen::Index row = 0, column = 0;
  const double off = (*mass - own.mass).cwiseAbs().maxCoeff(&row, &column);
  if (off > kMassTolerance * own.mass.cwiseAbs().maxCoeff())
    problems.push_back(fmt::format(
        "{}/M.mtx: row {} ({}), column {} has {:.6g}, the masses of the configuration make {:.6g}",
        folder, row + 1, own.rows[static_cast<std::size_t>(row)].name, column + 1,
        (*mass)(row, column), own.mass(row, column)));
  std::vector<Eigen::VectorXd> bs;
  for (const estimator::Element& e : elements(s, table)) {
    Eigen::VectorXd b = Eigen::VectorXd::Zero(own.frames.rows());
    for (const auto& [dof, factor] : e.b) b[dof] = factor;
    bs.emplace_back(own.frames.transpose() * b);
  }
  MatrixDesign out;
  out.theta = Eigen::VectorXd::Zero(table.size());
  out.theta.head(table.elements()) = fitted(bs, *stiffness, out.stiffness_rest);
  out.theta.tail(table.elements()) = fitted(bs, *damping, out.damping_rest);
  if (out.stiffness_rest > kStiffnessRest)
    problems.push_back(fmt::format(
        "{}/K.mtx: the frames and floor panels of the building leave {:.2g} % of it; framewatch's "
        "models have forces between neighboring floors only. Are the rows those of `framewatch "
        "export --matrices`?",
        folder, 100 * out.stiffness_rest));
  for (int i = 0; i < table.elements() && problems.size() == before; ++i)
    if (!(out.theta[i] > 0))
      problems.push_back(fmt::format("{}/K.mtx: {} would be {:.6g}, not above 0", folder,
                                     table[i].name, out.theta[i]));
  if (problems.size() > before) return std::nullopt;
  out.theta.tail(table.elements()) = out.theta.tail(table.elements()).cwiseMax(0.0);
  return out;
}

}  // namespace framewatch::daemon
