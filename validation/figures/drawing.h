// A machine or a frame as its file draws it: unloaded, before any solution, also where it cannot stand or its loops do
// not close.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "msa/base/spatial.h"
#include "msa/frame/file/frame_description.h"
#include "msa/mechanism/configuration.h"

namespace deflect::figures {

/// The box around a section in the member's local y and z, m; of a round one both are its diameter; zero where the file
/// gives no shape.
struct SectionOutline {
  double size_y = 0, size_z = 0;
  bool round = false;
};
SectionOutline outline_of(const Section&);

/// A straight member with its section: axes are its local x (along it), y, z as columns. Sizes are those of the box
/// around the section, m; of a round one both are its diameter; zero where the file gives no shape.
struct DrawnMember {
  std::string leg, part, section, material;
  Vector3 start, end;
  Matrix3 axes = Matrix3::Identity();
  double size_y = 0, size_z = 0;
  bool round = false;
};

/// A joint of a machine with its axes; letters of the joint table by freedom, and which of them have a law.
struct DrawnJoint {
  std::string leg, part, letters;
  Vector3 at;
  Matrix3 axes = Matrix3::Identity();
  std::array<bool, 6> elastic{};

  bool driven() const { return letters.find('a') != letters.npos; }
};

/// A frame of reference, or a node of a frame with what holds and what loads it.
struct DrawnPoint {
  std::string name, held;
  Vector3 at;
  Matrix3 axes = Matrix3::Identity();
};

/// A named sensor or a point of load of a machine.
struct DrawnInstrument {
  std::string name, words;  ///< "sensor on the platform", "load on the tool"
  Vector3 at;
  std::optional<Vector3> axis;  ///< along which, or about which, a sensor reads
};

/// A motion that nothing resists; displacements of the points, largest a tenth of the machine's size, m.
struct DrawnMotion {
  std::string words;
  std::vector<Vector3> displacements;
};

/// What a frame's file holds beside members and nodes: a spring, laws at a support or an end of a member, a load case,
/// a sensor.
struct DrawnEntry {
  enum class Kind { spring, law, load, sensor };
  static constexpr std::array kinds = {Kind::spring, Kind::law, Kind::load, Kind::sensor};
  Kind kind = Kind::spring;
  std::string name, words;  ///< "support A", "ry: linear"
};
inline constexpr std::array<const char*, 4> entry_kinds = {"spring", "law", "load case", "sensor"};
inline constexpr std::array<const char*, 4> entry_lists = {"springs", "laws", "loads", "sensors"};

struct MachineDrawing {
  std::string name, about;
  bool frame = false;
  Vector6 pose_mm_deg = Vector6::Zero();  ///< of the tool point, of a machine
  std::vector<Actuator> driven;           ///< with their coordinates
  std::vector<Vector3> points;            ///< m, base axes
  struct Line {
    int a = 0, b = 0;  ///< points
    int member = -1;   ///< among the members; −1: a rigid piece
  };
  std::vector<Line> lines;
  std::vector<DrawnMember> members;
  std::vector<DrawnJoint> joints;
  std::vector<DrawnPoint> frames;  ///< base and tool of a machine; of a frame its nodes
  std::vector<DrawnInstrument> instruments;
  std::vector<DrawnEntry> entries;   ///< of a frame
  std::vector<DrawnMotion> motions;  ///< where it cannot stand
  std::string trouble;               ///< why, or which loops are open; "" where all is well

  double size() const;  ///< diagonal of the box around the points, m
};

/// At a pose, or at home: where the loops do not close there, each leg alone with its joints at home.
MachineDrawing drawing_of(const Mechanism&, const std::optional<Configuration>& at = {});
MachineDrawing drawing_of(const frame::FrameDescription&);

}  // namespace deflect::figures
