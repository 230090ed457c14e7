#include "validation/theories/turned.h"

#include <algorithm>

#include "msa/base/outcome.h"
#include "validation/theories/agreement.h"

namespace deflect::theories {
namespace {

Vector6 turned_twist(const Matrix3& R, const Vector6& t) {
  Vector6 out;
  out << R * t.head<3>(), R * t.tail<3>();
  return out;
}

void turn(PlacedJoint& joint, const Matrix3& R) {
  joint.p_W = R * joint.p_W;
  joint.R_WJ = R * joint.R_WJ;
}

void turn(PlacedMember& member, const Matrix3& R) {
  member.p_W_start = R * member.p_W_start;
  member.p_W_end = R * member.p_W_end;
  member.R_WM = R * member.R_WM;
}

void turn(std::vector<PlacedLeg>& legs, const Matrix3& R);

void turn(PlacedParallel& group, const Matrix3& R) {
  group.p_W_start = R * group.p_W_start;
  group.p_W_end = R * group.p_W_end;
  turn(group.branches, R);
}

void turn(std::vector<PlacedLeg>& legs, const Matrix3& R) {
  for (PlacedLeg& leg : legs) {
    leg.misfit = turned_twist(R, leg.misfit);
    for (PlacedPart& part : leg.parts) std::visit([&](auto& p) { turn(p, R); }, part);
  }
}

}  // namespace

const Matrix3& turn_number(std::size_t i) {
  static const Matrix3 turns[] = {Eigen::AngleAxisd(0.7, Vector3(0.36, 0.48, 0.8)).toRotationMatrix(),
                                  Eigen::AngleAxisd(-1.9, Vector3(0.8, -0.36, 0.48)).toRotationMatrix()};
  return turns[i];
}

Configuration turned(const Configuration& c, const Matrix3& R) {
  Configuration out = c;
  out.pose = {R * c.pose.p_WT, R * c.pose.R_WT};
  turn(out.base, R);
  turn(out.tool, R);
  turn(out.legs, R);
  out.weight = R * c.weight;
  return out;
}

Answer turned_back(const Answer& answer, const Matrix3& R) {
  const Matrix3 back = R.transpose();
  Matrix6 T = Matrix6::Zero();
  T.topLeftCorner<3, 3>() = T.bottomRightCorner<3, 3>() = back;
  Answer out = answer;
  out.displacement = turned_twist(back, answer.displacement);
  out.stiffness = T * answer.stiffness * T.transpose();
  out.floating = {};  // its ends lie along axes that were turned
  return out;
}

double changed_by_turning(const Theory& theory, const Answer& answer, const Configuration& c, const Vector6& F) {
  Answer here = answer;
  here.floating = {};
  double most = 0;
  for (std::size_t i = 0; i < 2; ++i) {
    const Matrix3& R = turn_number(i);
    const Configuration there = turned(c, R);
    const auto again = outcome_of([&] { return theory.at(there, {})->answer(turned_twist(R, F)); });
    if (again && again->rigid == answer.rigid)
      most = std::max(most, difference(turned_back(*again, R), here, c.size).largest());
  }
  return most;
}

}  // namespace deflect::theories
