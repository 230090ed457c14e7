#include "msa/mechanism/closure.h"
#include "msa/base/index.h"

#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

namespace deflect {
namespace {

constexpr double largest_step = 0.3;
// Of the mechanism's length, or rad. Newton goes on to rounding; what is left is the rounding of numbers in files.
constexpr double closed_tolerance = 1e-8;
constexpr double rank_tolerance = 1e-7;  // of singular values; a singular pose is reached to the root of rounding only

/// Two ways to one frame: the equation of six that they agree, b − a seen at a's origin.
struct Equation {
  Frame a, b;
  std::vector<std::size_t> path_a, path_b;
};

Vector3 rotation_vector(const Matrix3& R) {
  const Eigen::AngleAxisd turn(R);
  return turn.angle() * turn.axis();
}

Vector6 gap(const Equation& e) {
  Vector6 g;
  g << e.b.p - e.a.p, rotation_vector(e.b.R * e.a.R.transpose());
  return g;
}

std::vector<Equation> equations(const Trace& t, const std::optional<Frame>& platform) {
  std::vector<Equation> all;
  for (const Closure& c : t.closures) all.push_back({c.a, c.b, c.path_a, c.path_b});
  for (std::size_t leg = platform ? 0 : 1; leg < t.legs.size(); ++leg) {
    const Frame target = platform ? *platform : t.legs[0].end;
    all.push_back({target, t.legs[leg].end, platform ? std::vector<std::size_t>() : t.legs[0].path, t.legs[leg].path});
  }
  return all;
}

/// How a frame at p moves with each of the columns' coordinates, rotations times `length`.
void add_columns(MatrixX& J, Eigen::Index row, const Trace& t, const std::vector<std::size_t>& path, const Vector3& p,
                 const std::vector<Eigen::Index>& column, double sign, double length) {
  for (const std::size_t c : path)
    if (column[c] >= 0) {
      const Vector6& s = t.coordinates[c].twist;
      J.block<3, 1>(row, column[c]) += sign * (s.head<3>() + s.tail<3>().cross(p));
      J.block<3, 1>(row + 3, column[c]) += sign * length * s.tail<3>();
    }
}

/// Columns of the coordinates that may move, −1 for those that stay; coordinates in units of a rotation.
std::vector<Eigen::Index> columns(const Trace& t, bool actuators_stay, Eigen::Index& count) {
  std::vector<Eigen::Index> column;
  count = 0;
  for (const Coordinate& c : t.coordinates) column.push_back(actuators_stay && c.actuated ? -1 : count++);
  return column;
}

struct Size {
  double shift = 0, turn = 0;
};

Size left_open(const std::vector<Equation>& all) {
  Size size;
  for (const Equation& e : all) {
    const Vector6 g = gap(e);
    size.shift = std::max(size.shift, g.head<3>().norm());
    size.turn = std::max(size.turn, g.tail<3>().norm());
  }
  return size;
}

}  // namespace

Closed close_loops(std::span<const LegParts> legs, std::vector<JointState>& states,
                   const std::optional<Frame>& platform, double length) {
  Closed out;
  double best = std::numeric_limits<double>::infinity();
  for (int iteration = 0; iteration < 60; ++iteration) {
    out.trace = walk(legs, states);
    const std::vector<Equation> all = equations(out.trace, platform);
    const Size open = left_open(all);
    out.shift = open.shift;
    out.turn = open.turn;
    const double error = open.shift / length + open.turn;
    out.closed = error < closed_tolerance;
    if (all.empty() || (out.closed && error >= 0.5 * best)) return out;  // rounding: Newton gains no more
    best = std::min(best, error);

    Eigen::Index count = 0;
    const std::vector<Eigen::Index> column = columns(out.trace, !platform, count);
    if (count == 0) return out;
    MatrixX J = MatrixX::Zero(6 * std::ssize(all), count);
    VectorX r(J.rows());
    for (std::size_t e = 0; e < all.size(); ++e) {
      const auto row = as_index(6 * e);
      add_columns(J, row, out.trace, all[e].path_b, all[e].a.p, column, 1, length);
      add_columns(J, row, out.trace, all[e].path_a, all[e].a.p, column, -1, length);
      r.segment<6>(row) = gap(all[e]);
      r.segment<3>(row + 3) *= length;
    }
    VectorX unit(count);  // a translation by `length` counts as a turn by one
    for (std::size_t c = 0; c < column.size(); ++c)
      if (column[c] >= 0) unit(column[c]) = out.trace.coordinates[c].freedom < 3 ? length : 1;
    Eigen::CompleteOrthogonalDecomposition<MatrixX> cod;
    cod.setThreshold(1e-9);
    cod.compute(J * unit.asDiagonal());
    VectorX step = -cod.solve(r);
    const double largest = step.cwiseAbs().maxCoeff();
    if (largest > largest_step) step *= largest_step / largest;
    if (out.closed && largest < 1e-14) return out;
    for (std::size_t c = 0; c < column.size(); ++c)
      if (column[c] >= 0) {
        const Coordinate& k = out.trace.coordinates[c];
        move(states[k.joint], k, step(column[c]) * unit(column[c]));
      }
  }
  return out;
}

Reach reach(const Trace& t, std::size_t leg, const Vector3& p_W, double length) {
  Eigen::Index count = 0;
  const std::vector<Eigen::Index> column = columns(t, false, count);
  MatrixX inner = MatrixX::Zero(6 * std::ssize(t.closures), count), end = MatrixX::Zero(6, count);
  for (std::size_t e = 0; e < t.closures.size(); ++e) {
    const auto row = as_index(6 * e);
    add_columns(inner, row, t, t.closures[e].path_b, t.closures[e].a.p, column, 1, length);
    add_columns(inner, row, t, t.closures[e].path_a, t.closures[e].a.p, column, -1, length);
  }
  add_columns(end, 0, t, t.legs[leg].path, p_W, column, 1, length);
  for (std::size_t c = 0; c < column.size(); ++c)
    if (t.coordinates[c].freedom < 3) {
      end.col(column[c]) *= length;
      if (inner.rows() > 0) inner.col(column[c]) *= length;
    }
  if (inner.rows() > 0 && count > 0) {  // branches side by side in which nothing moves close by themselves
    Eigen::JacobiSVD<MatrixX> loops(inner, Eigen::ComputeFullV);
    loops.setThreshold(rank_tolerance);
    end = end * loops.matrixV().rightCols(count - loops.rank());
  }
  if (end.cols() == 0) return {Matrix6X(6, 0), Matrix6::Identity()};
  Eigen::JacobiSVD<MatrixX> svd(end, Eigen::ComputeFullU);
  svd.setThreshold(rank_tolerance);
  return {svd.matrixU().leftCols(svd.rank()), svd.matrixU().rightCols(6 - svd.rank())};
}

}  // namespace deflect
