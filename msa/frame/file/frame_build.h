// Builds the structure, and the loads of its cases, from a frame's description.
#pragma once

#include <array>
#include <utility>
#include <vector>

#include "msa/frame/elements/member_loads.h"
#include "msa/frame/file/frame_description.h"
#include "msa/frame/file/name_index.h"
#include "msa/frame/structure/model.h"

namespace deflect::frame {

/// By member, in the description's order: the fractions of the length at which nodes are, from 0 to 1. Empty: as many
/// elements as in the description.
using FrameDivision = std::vector<std::vector<double>>;

/// Node i of the model is node i of the description; inner nodes of members and ends with releases follow. Energy
/// groups: members by section, springs by their name.
struct FrameModel {
  Model model;
  NameIndex nodes, members;
  std::vector<int> first_element;                      ///< by member, and one past the last: index of its first beam in
                                                       ///< the model
  std::vector<double> mass_per_length;                 ///< by member, kg/m; 0 without density
  std::vector<double> expansion;                       ///< by member, 1/K; 0 where not given
  std::vector<std::array<int, 6>> support_constraint;  ///< by support and freedom, −1 where free
  std::vector<std::array<int, 6>> spring;              ///< by spring and freedom, −1 without stiffness
  std::vector<int> constraint;                         ///< by general constraint
  std::vector<std::pair<int, int>> arms;               ///< rigid arms, for pictures
};

/// Throws InputError for a name that does not resolve (a file's reader has checked them).
FrameModel build_frame(const FrameDescription&, const FrameDivision& = {});

struct CaseLoad {
  VectorX forces;                     ///< by freedom, line loads and temperature included
  VectorX thermal;                    ///< the part of it by temperature
  VectorX values;                     ///< by constraint: displacements of supports
  std::vector<ElementLoad> elements;  ///< by beam
};

/// Throws InputError with the case where it has a load out of the plane of a plane frame, or displaces an unsupported
/// freedom.
CaseLoad load_of(const FrameDescription&, const FrameModel&, const std::string& name, const LoadCase&);

}  // namespace deflect::frame
