// Builds the structure of a mechanism at a pose.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "msa/frame/structure/model.h"
#include "msa/mechanism/configuration.h"

namespace deflect::frame {

/// How members are divided: by part name, the fractions of the length at which nodes are, from 0 to 1. A part that is
/// not listed is one element.
using MemberDivision = std::map<std::string, std::vector<double>>;

/// From Young's and shear modulus and the section; only a Timoshenko member has shear deformation.
BeamRigidity rigidity(const PlacedMember&);

/// Every member in that many equal elements.
MemberDivision equal_division(const Configuration&, int elements);

/// Every element of every member halved.
MemberDivision halved(const Configuration&, const MemberDivision&);

struct MechanismModel {
  Model model;
  int ground = 0;    ///< fixed
  int base = 0;      ///< node of the base's body; `ground` where the base is rigid
  int platform = 0;  ///< at T, the platform's body
  int tool = 0;      ///< at T, after the tool's joint
  /// Pairs of nodes connected by a rigid arm of a body; for drawings.
  std::vector<std::pair<int, int>> arms;
  /// By leg, its attachment to the platform: ranges [first, last) of the model's constraints and springs.
  struct Attachment {
    std::size_t first_constraint = 0, last_constraint = 0, first_spring = 0, last_spring = 0;
  };
  std::vector<Attachment> attachments;
  /// Where something inside a leg can be read: a connection through which the leg's wrench passes, and the body behind
  /// a part.
  struct Cut {
    int connection = -1;  ///< of the model's; −1: the joint has a stiffness of all freedoms together, or is no joint
    std::size_t first_constraint = 0, last_constraint = 0, first_spring = 0, last_spring = 0;
    int side = 0;      ///< node of the body that the part stands on
    int far = 0;       ///< node of the body that the constraints and springs act on
    int behind = 0;    ///< node of the body behind the part
    bool own = false;  ///< the connection is that of the joint, which is not rigid
  };
  std::map<std::pair<std::size_t, std::vector<std::size_t>>, Cut> cuts;  ///< by leg and Inside::parts
  /// By member, in the order of for_each_part, its beams: a range [first, last) of the model's.
  std::vector<std::pair<std::size_t, std::size_t>> members;
};

/// Contains world, base joint, legs, platform and tool joint. Bodies are nodes with lever arms; joints between a member
/// and a body act directly on that body's node.
MechanismModel build(const Configuration&, const MemberDivision& = {});

/// One leg between the world and a free platform node at T; without base and tool joints.
MechanismModel build_leg(const Configuration&, std::size_t leg, const MemberDivision& = {});

}  // namespace deflect::frame
