#include "msa/frame/structure/pieces.h"

#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "msa/base/index.h"
#include "msa/frame/structure/elimination.h"

namespace deflect::frame {
namespace {

constexpr double unseen = 1e-10;  // of the strongest hold of a piece: rounding of positions, far from the origin too

bool resists_everything(const BeamRigidity& r) { return std::min({r.EA, r.EIy, r.EIz, r.GJ, r.GAs_y, r.GAs_z}) > 0; }

/// What a beam resists that lacks some rigidity: elongation, torsion and the bending of both ends in each plane.
void append_deformations(std::vector<LinearForm>& forms, const Beam& beam) {
  const Vector3 x = beam.R_WM.col(0), y = beam.R_WM.col(1), z = beam.R_WM.col(2);
  const auto difference = [&](const Vector3& axis, double factor) {
    LinearForm form;
    for (int i = 0; i < 3; ++i) {
      form.push_back({6 * beam.b + i, factor * axis(i)});
      form.push_back({6 * beam.a + i, -factor * axis(i)});
    }
    return form;
  };
  const auto with_rotation = [](LinearForm form, int node, const Vector3& axis, double factor) {
    for (const Term& t : rotation_of(node, axis, factor)) form.push_back(t);
    return form;
  };
  const BeamRigidity& r = beam.rigidity;
  if (r.EA > 0) forms.push_back(difference(x, 1 / beam.length));
  if (r.GJ > 0) forms.push_back(with_rotation(rotation_of(beam.b, x), beam.a, x, -1));
  for (const int end : {beam.a, beam.b}) {
    if (std::min(r.EIz, r.GAs_y) > 0) forms.push_back(with_rotation(difference(y, 1 / beam.length), end, z, -1));
    if (std::min(r.EIy, r.GAs_z) > 0) forms.push_back(with_rotation(difference(z, 1 / beam.length), end, y, 1));
  }
}

/// Everything that a motion without strain leaves zero.
std::vector<LinearForm> conditions(const Model& m, const std::vector<char>& resists) {
  std::vector<LinearForm> forms;
  for (const Constraint& c : m.constraints) forms.push_back(c.form);
  for (std::size_t s = 0; s < m.springs.size(); ++s)
    if (resists[s]) forms.push_back(m.springs[s].elongation);
  for (const Beam& beam : m.beams) {
    if (!resists_everything(beam.rigidity)) append_deformations(forms, beam);
    for (int i = 0; i < 6 && beam.relative >= 0; ++i) forms.push_back({{beam.relative + i, 1}});
  }
  return forms;
}

/// A form over a piece's own motion: f·u + m·θ at a point of it.
struct Hold {
  int piece;
  Vector3 f = Vector3::Zero(), m = Vector3::Zero();
};

struct Form {
  std::vector<Hold> holds;  // by piece
  LinearForm scalars;       // terms over the scalars, from 0
};

/// Forms about the first node of each piece; terms that cancel within a piece leave nothing.
Form taken_by_pieces(const Model& m, const Pieces& all, const LinearForm& form) {
  const auto nodal = static_cast<int>(6 * m.nodes.size());
  Form out;
  for (const Term& t : form) {
    if (t.dof >= nodal) {
      out.scalars.push_back({t.dof - nodal, t.coefficient});
      continue;
    }
    const auto node = as_size(t.dof / 6);
    const int piece = all.of_node[node];
    auto hold = std::find_if(out.holds.begin(), out.holds.end(), [&](const Hold& h) { return h.piece == piece; });
    if (hold == out.holds.end()) hold = out.holds.insert(hold, Hold{piece});
    const Vector3 axis = t.coefficient * Vector3::Unit(t.dof % 3);
    if (t.dof % 6 < 3) {
      hold->f += axis;
      hold->m += (m.nodes[node].position - nth(all.pieces, piece).centre).cross(axis);
    } else {
      hold->m += axis;
    }
  }
  return out;
}

/// The point about which the forces of the holds have the least moments, from the present centre.
Vector3 middle(const std::vector<Hold>& holds) {
  Matrix3 A = Matrix3::Zero();
  Vector3 b = Vector3::Zero();
  for (const Hold& h : holds) {  // m − c × f = m + [f]× c
    Matrix3 cross;
    cross << 0, -h.f.z(), h.f.y(), h.f.z(), 0, -h.f.x(), -h.f.y(), h.f.x(), 0;
    A += cross.transpose() * cross;
    b -= cross.transpose() * h.m;
  }
  return A.completeOrthogonalDecomposition().solve(b);
}

/// Centre, size and coordinates of a piece from the holds on it, which it has about its first node.
void set_coordinates(Piece& piece, std::vector<Hold> holds) {
  const Vector3 to_centre = middle(holds);
  piece.centre += to_centre;
  double arm = 0;
  for (Hold& h : holds) {
    h.m -= to_centre.cross(h.f);
    if (h.f.norm() * piece.size > 1e-9 * h.m.norm())  // else a moment, with the rounding of a force
      arm = std::max(arm, h.m.norm() / h.f.norm());
  }
  if (arm > 1e-9 * piece.size) piece.size = arm;  // else all act at one point, but for rounding
  MatrixX A = MatrixX::Zero(std::max<Eigen::Index>(6, std::ssize(holds)), 6);
  for (std::size_t i = 0; i < holds.size(); ++i) {
    Vector6 row;
    row << holds[i].f, holds[i].m / piece.size;
    if (const double size = row.norm(); size > 0) A.row(as_index(i)) = row / size;
  }
  const MatrixX R = Eigen::HouseholderQR<MatrixX>(A).matrixQR().topRows<6>().triangularView<Eigen::Upper>();
  const Eigen::JacobiSVD<MatrixX> svd(R, Eigen::ComputeFullV);
  const VectorX& strength = svd.singularValues();
  Eigen::Index rank = 0;
  while (rank < 6 && strength(rank) > unseen * std::max(1.0, strength(0))) ++rank;
  piece.held = svd.matrixV().leftCols(rank);
  for (Eigen::Index i = 0; i < rank; ++i) piece.held.col(i) /= strength(i);
  piece.loose = svd.matrixV().rightCols(6 - rank);
  if (rank > 0) piece.weakest = strength(rank - 1) / strength(0);
}

/// Nodes by piece, each piece centred at its first node.
Pieces nodes_by_piece(const Model& m) {
  Pieces out;
  const std::vector<int> first = first_nodes(m);
  out.of_node.resize(m.nodes.size());
  for (std::size_t i = 0; i < m.nodes.size(); ++i) {
    const auto root = as_size(first[i]);
    if (root == i) {
      out.of_node[i] = static_cast<int>(out.pieces.size());
      out.pieces.emplace_back().centre = m.nodes[i].position;
    }
    out.of_node[i] = out.of_node[root];
    nth(out.pieces, out.of_node[i]).nodes.push_back(static_cast<int>(i));
  }
  return out;
}

/// Adds what the form, about the first nodes of the pieces, says of their coordinates; `to_centre`: by piece, from its
/// first node. Nothing where the form vanishes.
void add_row(Pieces& out, const Form& form, const std::vector<Vector3>& to_centre) {
  PieceRow row;
  double size = 0;
  for (const Hold& h : form.holds) {
    const Piece& piece = nth(out.pieces, h.piece);
    Vector6 w;
    w << h.f, (h.m - nth(to_centre, h.piece).cross(h.f)) / piece.size;
    size = std::max(size, w.norm());
    const VectorX c = piece.held.transpose() * w;
    for (Eigen::Index i = 0; i < c.size(); ++i) row.push_back({piece.first + static_cast<int>(i), c(i)});
  }
  for (const Term& t : form.scalars) {
    const auto k = as_size(t.dof);
    row.push_back({out.y_of_scalar[k], t.coefficient * out.scalar_unit[k]});
    size = std::max(size, std::abs(row.back().coefficient));
  }
  if (size == 0) return;
  for (Term& t : row) t.coefficient /= size;
  out.rows.push_back(std::move(row));
}

}  // namespace

std::vector<int> first_nodes(const Model& m) {
  std::vector<int> parent(m.nodes.size());
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&parent](int i) {
    while (nth(parent, i) != i) {
      int& up = nth(parent, i);
      i = up = nth(parent, up);
    }
    return i;
  };
  const auto join = [&](int a, int b) {
    const int low = std::min(root(a), root(b)), high = std::max(root(a), root(b));
    nth(parent, high) = low;
  };
  for (const Beam& beam : m.beams)
    if (resists_everything(beam.rigidity)) join(beam.a, beam.b);
  for (const auto& [a, b] : m.welds) join(a, b);
  for (std::size_t i = 0; i < parent.size(); ++i) parent[i] = root(static_cast<int>(i));
  return parent;
}

Pieces pieces_of(const Model& m, const std::vector<char>& resists) {
  Pieces out = nodes_by_piece(m);
  std::vector<Form> forms;
  std::vector<std::vector<Hold>> holds(out.pieces.size());
  std::vector<double> seen(m.scalars.size(), 0);
  const double length = characteristic_length(m);
  const auto nodal = static_cast<int>(6 * m.nodes.size());
  for (const LinearForm& condition : conditions(m, resists)) {
    Form form = taken_by_pieces(m, out, condition);
    double whole = 0;
    for (const Term& t : condition) {
      const bool turns = t.dof < nodal && t.dof % 6 >= 3;
      whole = std::max(whole, std::abs(t.coefficient) * (turns ? 1 / length : 1));
    }
    // What cancelled within a piece leaves its rounding.
    std::erase_if(form.holds, [&](const Hold& h) { return h.f.norm() + h.m.norm() / length <= 1e-13 * whole; });
    for (const Hold& h : form.holds) nth(holds, h.piece).push_back(h);
    for (const Term& t : form.scalars) {
      double& most = nth(seen, t.dof);
      most = std::max(most, std::abs(t.coefficient));
    }
    forms.push_back(std::move(form));
  }
  std::vector<Vector3> to_centre;
  for (std::size_t p = 0; p < out.pieces.size(); ++p) {
    Piece& piece = out.pieces[p];
    piece.size = length;
    const Vector3 before = piece.centre;
    set_coordinates(piece, std::move(holds[p]));
    to_centre.push_back(piece.centre - before);
    piece.first = out.coordinates;
    out.coordinates += static_cast<int>(piece.held.cols());
  }
  for (const double most : seen) {
    out.y_of_scalar.push_back(most > 0 ? out.coordinates++ : -1);
    out.scalar_unit.push_back(most > 0 ? 1 / most : 1);
  }
  for (const Form& form : forms) add_row(out, form, to_centre);
  return out;
}

LinearForm motion_of(const Model& m, const Piece& piece, const Vector6& x) {
  const Vector3 u = x.head<3>(), theta = x.tail<3>() / piece.size;
  LinearForm out;
  for (const int node : piece.nodes) {
    const Vector3 d = u + theta.cross(nth(m.nodes, node).position - piece.centre);
    for (int i = 0; i < 3; ++i) {
      out.push_back({6 * node + i, d(i)});
      out.push_back({6 * node + 3 + i, theta(i)});
    }
  }
  return out;
}

}  // namespace deflect::frame
