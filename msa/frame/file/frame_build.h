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

/// What holds a node: constraints by freedom (−1: none), and springs [first, last) of the model. Of these the `direct`
/// ones act on the node, each along a freedom; the others are between them, in series.
struct Holding {
  std::array<int, 6> constraint = {-1, -1, -1, -1, -1, -1};
  int connection = 0;  ///< the first of the model's, with what is in series
  int first = 0, last = 0;
  std::vector<std::pair<int, int>> direct;  ///< freedom, index of the spring
};

/// Node i of the model is node i of the description; inner nodes of members and ends with releases or laws follow.
struct FrameModel {
  Model model;
  NameIndex nodes, members;
  std::vector<int> first_element;       ///< by member, and one past the last: index of its first beam in
                                        ///< the model
  std::vector<double> mass_per_length;  ///< by member, kg/m; 0 without density
  std::vector<double> expansion;        ///< by member, 1/K; 0 where not given
  std::vector<double> misfit;           ///< by member, free strain
  std::vector<Holding> supports, springs;
  std::vector<std::array<int, 2>> ends;   ///< by member the connections of its start and end; −1: welded to the node
  Named<std::pair<int, int>> elastic;     ///< springs [first, last) by their place: springs, then supports
                                          ///< and ends of members that have laws
  std::vector<int> constraint;            ///< by general constraint
  std::vector<std::pair<int, int>> arms;  ///< rigid arms, for pictures

  bool prestressed() const;  ///< whether a member has a misfit
};

/// Throws InputError for a name that does not resolve (a file's reader has checked them).
FrameModel build_frame(const FrameDescription&, const FrameDivision& = {});

struct CaseLoad {
  VectorX forces;                     ///< by freedom, line loads and temperature included
  VectorX thermal;                    ///< the part of it by temperature and misfits
  VectorX values;                     ///< by constraint: displacements of supports
  std::vector<ElementLoad> elements;  ///< by beam
};

/// A wrench of a load case as it really acts.
Vector6 turned(const LoadCase&, const Vector6& wrench);

/// With the misfits and temperatures of members and the settlements of supports, which are there in every case;
/// `assembled`: with the misfits alone, as the frame was assembled. Throws InputError with the case where it has a load
/// out of the plane of a plane frame, or displaces a freedom that no support holds rigidly.
CaseLoad load_of(const FrameDescription&, const FrameModel&, const std::string& name, const LoadCase&,
                 bool assembled = false);

}  // namespace deflect::frame
