#include "tests/attack/shape_chain.h"

#include <algorithm>

#include "msa/base/index.h"

namespace deflect::attack {
namespace {

Matrix3L about(int axis, Long angle) { return rotation_by(angle * Vector3L::Unit(axis)); }

/// Deflections of the six motions.
Vector6L deflections(const JointL& j, const VectorL& numbers, Eigen::Index first, Long c, Long length,
                     std::vector<LawPoint>& at) {
  Vector6L q = Vector6L::Zero();
  for (const auto& [freedom, law] : j.numbers) {
    const Long s = numbers(first++);
    at.push_back(law ? along_law(*law, s, freedom < 3 ? c : c / (length * length)) : LawPoint{0, s, 0, 1});
    q(as_index(freedom)) += at.back().delta;
  }
  return q;
}

struct Walk {
  MotionL at;
  Eigen::Index next = 0;  // of the numbers
  Vector3L p_T;
  const WrenchL* wrench;
  const VectorL* numbers;
  Long misfit;
  const ShapeScale* scale;
  ChainLeft* out;

  void pass(const RodL& rod) { at = rod.beyond(at, *wrench, scale->steps); }

  void pass(const SeatL& seat) {
    at.u += at.R * (misfit * seat.beside.head<3>());
    at.R = at.R * rotation_by(misfit * seat.beside.tail<3>());
  }

  void pass(const JointL& j) {
    std::vector<LawPoint> points;
    const Long c = scale->move * scale->length / scale->force;
    const Vector6L q = deflections(j, *numbers, next, c, scale->length, points);
    const Matrix3L R0 = j.joint->R_WJ.cast<Long>(), A = at.R * R0;
    const Vector3L p = j.joint->p_W.cast<Long>(), x = p_T + at.u + at.R * (p - p_T) + A * q.head<3>();
    const Matrix3L Rx = about(0, q(3)), Rxy = Rx * about(1, q(4)), Rxyz = Rxy * about(2, q(5));
    const Vector3L m = wrench->moment_at(x);
    Vector6L work;  // of the wrench, by each motion
    work << A.transpose() * wrench->f, m.dot(A.col(0)), m.dot(A * Rx.col(1)), m.dot(A * Rxy.col(2));
    Vector6L coupled = Vector6L::Zero();
    if (j.joint->stiffness) coupled = j.joint->stiffness->cast<Long>() * q;
    for (std::size_t k = 0; k < j.numbers.size(); ++k, ++next) {
      const auto i = as_index(j.numbers[k].freedom);
      const Long unit = scale->force * (i < 3 ? 1 : scale->length);
      out->left(6 + next) = (work(i) - points[k].f - coupled(i)) / unit;
      out->slopes(next) = points[k].df / unit;
    }
    at.R = A * Rxyz * R0.transpose();
    at.u = x - p_T - at.R * (p - p_T);
  }
};

}  // namespace

void ChainL::add(const PlacedPart& part, const Vector3L& p_T, Shear shear) {
  if (const auto* member = std::get_if<PlacedMember>(&part)) {
    parts.emplace_back(RodL(*member, p_T, shear));
    return;
  }
  JointL out{&std::get<PlacedJoint>(part), {}};
  for (std::size_t i = 0; i < 6; ++i) {
    if (out.joint->stiffness || out.joint->free(i)) out.numbers.push_back({i, nullptr});
    for (const Law& law : out.joint->laws[i]) out.numbers.push_back({i, &law});
  }
  if (out.numbers.empty()) return;
  numbers += std::ssize(out.numbers);
  parts.emplace_back(std::move(out));
}

ChainLeft left_of(const ChainL& chain, const MotionL& start, const MotionL& end, const WrenchL& wrench,
                  const VectorL& numbers, Long misfit, const ShapeScale& scale) {
  ChainLeft out{VectorL::Zero(6 + chain.numbers), VectorL::Zero(chain.numbers)};
  Walk walk{start, 0, wrench.about, &wrench, &numbers, misfit, &scale, &out};
  for (const auto& part : chain.parts) std::visit([&](const auto& p) { walk.pass(p); }, part);
  const Matrix3L D = walk.at.R * end.R.transpose();
  out.left.head<3>() = (walk.at.u - end.u) / (scale.move * scale.length);
  out.left.segment<3>(3) = Vector3L(D(2, 1) - D(1, 2), D(0, 2) - D(2, 0), D(1, 0) - D(0, 1)) / (2 * scale.move);
  return out;
}

}  // namespace deflect::attack
