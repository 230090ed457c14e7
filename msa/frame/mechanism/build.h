// From a mechanism at a pose to a structure.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "msa/frame/structure/model.h"
#include "msa/mechanism/configuration.h"

namespace deflect::frame {

/// How members are divided: by part name, the fractions of the length at which nodes stand, from 0 to 1. A part that
/// is not named is one element.
using MemberDivision = std::map<std::string, std::vector<double>>;

/// Of Young's and shear modulus and section; shear deforms a Timoshenko member only.
BeamRigidity rigidity(const PlacedMember&);

/// Every member in that many equal elements.
MemberDivision equal_division(const Configuration&, int elements);

/// Every element of every member halved.
MemberDivision halved(const Configuration&, const MemberDivision&);

struct MechanismModel {
  Model model;
  int ground = 0;    ///< fixed
  int base = 0;      ///< the base's body; the ground where the base is rigid
  int platform = 0;  ///< at T, the platform's body
  int tool = 0;      ///< at T, behind the tool's joint
  /// Pairs of nodes that a rigid arm of a body lies between; for pictures.
  std::vector<std::pair<int, int>> arms;
  /// By leg, what attaches it to the platform: ranges [first, last) of the model's constraints and springs.
  struct Attachment {
    std::size_t first_constraint = 0, last_constraint = 0, first_spring = 0, last_spring = 0;
  };
  std::vector<Attachment> attachments;
  /// By member, in the order of for_each_part, its beams: a range [first, last) of the model's.
  std::vector<std::pair<std::size_t, std::size_t>> members;
};

/// World, base joint, legs, platform, tool joint. Bodies are nodes with lever arms; joints between a member and a body
/// act on that body's node directly.
MechanismModel build(const Configuration&, const MemberDivision& = {});

/// One leg between the world and a free platform node at T; base and tool joints left out.
MechanismModel build_leg(const Configuration&, std::size_t leg, const MemberDivision& = {});

}  // namespace deflect::frame
