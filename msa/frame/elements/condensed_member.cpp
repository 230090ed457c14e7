#include "msa/frame/elements/condensed_member.h"

#include <algorithm>
#include <cmath>

namespace deflect::frame {
namespace {

// Of a length, relative: a link of constant length comes out of its two ends with their rounding.
constexpr double same_length = 2e-15;

}  // namespace

bool CondensedMember::set(const BeamRigidity& rigidity, double length) {
  if (rigidity == rigidity_ && std::abs(length - length_) <= same_length * length) return true;
  length_ = 0;
  Matrix12 element;
  double share = 0;
  for (std::size_t i = 1; i < at_.size(); ++i) {
    if (const double next = at_[i] - at_[i - 1]; next != share) {
      share = next;
      element = local_stiffness(rigidity, share * length);
    }
    const double most = element.diagonal().head<3>().maxCoeff();
    if (i == 1) {
      k_ = element;
      stiffest_ = most;
    } else {
      if (!append(element)) return false;
      stiffest_ = std::max(stiffest_, most);
    }
  }
  rigidity_ = rigidity;
  length_ = length;
  return true;
}

/// Freedom by freedom of the node between; most of them do not meet, as stretch, twist and the two bendings are apart.
bool CondensedMember::append(const Matrix12& element) {
  constexpr Eigen::Index n = 18;
  Eigen::Matrix<double, n, n> k = Eigen::Matrix<double, n, n>::Zero();
  k.topLeftCorner<12, 12>() = k_;
  k.bottomRightCorner<12, 12>() += element;
  for (Eigen::Index i = 6; i < 12; ++i) {
    if (!(k(i, i) > 0)) return false;
    for (Eigen::Index j = 0; j < n; ++j)
      if ((j < 6 || j > i) && k(i, j) != 0) k.col(j) -= (k(i, j) / k(i, i)) * k.col(i);
  }
  k_ << k.topLeftCorner<6, 6>(), k.topRightCorner<6, 6>(), k.bottomLeftCorner<6, 6>(), k.bottomRightCorner<6, 6>();
  return true;
}

}  // namespace deflect::frame
