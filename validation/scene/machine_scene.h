// The machine where it stands, with what loads make of it, as data of the 3D view.
#pragma once

#include <string>
#include <vector>

#include "msa/base/geometry.h"
#include "msa/mechanism/configuration.h"
#include "validation/effects/changed_parts.h"
#include "validation/json/json_text.h"

namespace deflect::scene {

struct SceneStand {
  std::string label;
  Vector6 pose_mm_deg = Vector6::Zero();
  Configuration configuration;
};

/// {"kind": "machine",
///  "bodies": [{"leg", "part", "kind": "member" | "platform" | "base" | "offset", "guilty", and of members "size_mm":
///  [y,
///             z] of the box around the section, "round"}],
///  "cells": [[a, b, body], …]: lines between points,
///  "joints": [{"leg", "part", "point", "driven", "guilty"}], "tool": point,
///  "ground": [{"at_mm", "words", "whole"}]: where a leg stands on the base; whole: held in every direction,
///  "guilty": ["leg 4 guideway", …],
///  "poses": [{"label", "pose_mm_deg", "points_mm": [[x, y, z], …], "axes": [local y of each body's section, or null],
///             "shapes": [{"load_N_Nmm", "arrows", "displacement_mm": [[x, y, z], …]}]}]}
/// in base axes, one displacement for each point by the MSA, eight elements in a member. "arrows": [{"point", "kind":
/// "force" | "moment" | "line", "vector": direction, "words": "50 N"}]. All stands are of one device.
/// `loads`: at T, N and Nm. Throws as MsaAtPose does.
Json scene_json(const Mechanism&, const std::vector<SceneStand>&, const std::vector<Vector6>& loads,
                const std::vector<effects::ChangedPart>& guilty, Geometry = Geometry::linear);

}  // namespace deflect::scene
