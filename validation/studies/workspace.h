// The workspace that a device file states, as a region of poses: where devices are validated, mapped and measured.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "msa/mechanism/description.h"

namespace deflect::measurement {
class Random;
}

namespace deflect::studies {

/// A pose to be validated: a label for tables ("0" … "8"), x y z roll pitch yaw in mm and deg as written to results.
struct ValidationPoint {
  std::string label;
  Vector6 pose_mm_deg = Vector6::Zero();
};

/// About the workspace's centre, or the home pose. A cube has no extent along the axes of the base in which the machine
/// cannot move its tool without turning it: a planar machine has a square.
struct Region {
  std::string words;                                            ///< "cube", "disc of 100 mm": for messages
  Vector6 centre_mm_deg = Vector6::Zero();                      ///< position and orientation
  Vector3 low_mm = Vector3::Zero(), high_mm = Vector3::Zero();  ///< of the box around it, base axes
  std::vector<Eigen::Vector2d> corners_mm = {};                 ///< of a polygon
  std::optional<double> radius_mm = {};                         ///< of a disc or cylinder
  std::vector<Vector6> poses_mm_deg = {};                       ///< where a list of poses is given

  bool holds(const Vector3& mm) const;
};

/// InputError where the device has no workspace; ModelError where it is driven and its cube is nothing but a point.
Region region_of(const Mechanism&);

/// The points that stand for it, numbered from 0: the centre and the corners of a box (1…4 upper face, 5…8 lower, each
/// in the order (+,+), (−,+), (−,−), (+,−) of (x, y); no corner twice where it is flat), eight points on the rim of a
/// disc, four on each rim of a cylinder, the corners of a polygon (and its centroid, where that is inside), the poses
/// of a list.
std::vector<ValidationPoint> workspace_points(const Mechanism&);

/// A pose in it, drawn by lot with the centre's orientation; of a list one of its poses.
Vector6 draw_pose(const Region&, measurement::Random&);

}  // namespace deflect::studies
