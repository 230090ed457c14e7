// Springs with a stiffness of all six freedoms together.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "msa/frame/structure/model.h"

namespace deflect::frame {

/// K = Σ d v vᵀ for a symmetric positive definite K of [δ; θ], N/m … Nm/rad: at most six pairs of v and d. Every d is
/// in N/m and every v moves along a length.
std::vector<std::pair<Vector6, double>> squares(const Matrix6& K);

/// A spring with K at p between the bodies of the nodes a (−1: the ground) and b, in the axes R (columns), which turn
/// with body a. The six components of its motion are scalars of the model, defined by six constraints, so that it keeps
/// its law in every geometry. Returns the index of the first of the constraints, in the order tx … rz; the force of
/// constraint i is that on b along its component.
int connect_coupled(Model&, int a, int b, const Vector3& p, const Matrix3& R, const Matrix6& K, const std::string& name,
                    const std::string& part);

}  // namespace deflect::frame
