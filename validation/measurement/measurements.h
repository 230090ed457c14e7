// Measurements of a device: static readings of the TCP's displacement under known loads, and their file.
//
// Inside everything is SI; only the six numbers of a commanded pose stay as they were given. Loads act on the TCP,
// F_T_W = [f; m]; displacements are those of the TCP relative to the unloaded machine, d_T_W = [δ; θ]; both in base
// axes.
//
// The file (CSV, see csv.h) has one row per reading and these columns in any order:
//   pose                                        label; readings with one label share one approach of one pose
//   x_mm y_mm z_mm roll_deg pitch_deg yaw_deg   commanded pose, R = Rz(yaw) Ry(pitch) Rx(roll); all six
//   q1_rad … qn_rad (qi_mm where i slides)      or commanded joint coordinates, all n, instead of the six
//   fx_N fy_N fz_N mx_Nmm my_Nmm mz_Nmm         load; a moment without a column is zero
//   ux_mm uy_mm uz_mm thx_rad thy_rad thz_rad   displacement, at least one column; an empty cell was not measured
//   sigma_u_mm sigma_th_rad                     σ of one reading, > 0; columns and cells may be missing
//   probe_mm, tilt_rad                          reading of a named sensor of the device, any number of them; with one,
//                                               the displacement of T need not be there
//   handle.fx_N … handle.mz_Nmm                 load at a named point of the device, about that point; what has no
//                                               column is zero, and with one the load at T may have none
//   load.snow                                   of a frame: factor on a load case; node.B.fx_N … node.B.mz_Nmm: load at
//                                               a node. What has no column, or an empty cell, is zero
//   F3_N, M1_Nmm, S2_um_per_m                   reading of a sensor of force, moment, strain
//   sequence                                    order of the readings: numbers, no two alike; all rows or none
//   temperature_C                               20 where the column or the cell is missing
//   note…                                       remarks, kept as text
//
// What laboratories write otherwise is read too, and said in `how_read`: names in other cases ("FX_N", "Fx [N]"), other
// units (column_units.h: fx_kgf, ux_in, yaw_rad, temperature_K), a row of units below the names, NaN, #N/A, "-" for
// what was not measured, and poses of one label that scatter by up to 0.05 mm and 0.05 deg (0.001 rad), as encoders
// read them: their mean is the pose.
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "msa/base/spatial.h"
#include "validation/measurement/quantity.h"

namespace deflect::measurement {

/// A named sensor of the subject.
struct SensorChannel {
  std::string name;
  Quantity quantity = Quantity::length;
  std::optional<double> sigma;  ///< SI; of one reading, where the description gives it
};

/// What a subject can be read by and loaded at, beside the tool point T. Their columns begin with these names.
struct Instruments {
  std::vector<SensorChannel> sensors;
  std::vector<std::string> load_points;  ///< of a frame: "node.B", in base axes
  std::vector<std::string> load_cases;   ///< of a frame; column "load.NAME" is a factor on the case
  /// A subject without tool point and commanded poses: a frame. It is read by its sensors, loaded by load cases and at
  /// nodes, and `pose` is a label that may be missing.
  bool stationary = false;
};

/// What a sensor reads of a small displacement of T at a pose, by number of the sensor in Measurements::instruments.
using SensorForm = std::function<Vector6(std::size_t pose, std::size_t sensor)>;

struct Reading {
  std::size_t pose = 0;                               ///< index into Measurements::poses
  Vector6 load = Vector6::Zero();                     ///< F_T_W: N, Nm; of all loads together (place_loads)
  std::array<std::optional<double>, 6> displacement;  ///< d_T_W: m, rad; empty where not measured
  std::optional<double> sigma_u, sigma_th;            ///< m, rad; empty where not given
  std::optional<double> sequence;                     ///< in all readings or in none
  double temperature_C = 20;
  std::vector<std::string> notes;  ///< one per Measurements::note_columns
  std::size_t line = 0;            ///< of the file

  std::vector<std::optional<double>> sensors;  ///< by Measurements::instruments.sensors: m, rad
  /// Where the file has loads at named points: the loads at those points, each about its point, and at T itself; and
  /// the part of `load` that acts on the platform without passing through the tool joint.
  std::vector<Vector6> at_points;
  std::vector<double> factors;  ///< by Measurements::instruments.load_cases
  Vector6 at_tool = Vector6::Zero(), on_platform = Vector6::Zero();
};

/// The readings of one approach of one commanded pose.
struct PoseGroup {
  std::string label;                      ///< not empty, of this group alone
  Vector6 pose_mm_deg = Vector6::Zero();  ///< as given; pose_from() makes a Pose of it
  VectorX joints;                         ///< or commanded joint coordinates: m, rad
  std::vector<std::size_t> readings;      ///< indices, ascending
};

struct Measurements {
  std::string origin;               ///< file, for messages
  std::vector<bool> joint_rotates;  ///< per joint coordinate: rad, else m; empty where poses are commanded
  std::vector<std::string> note_columns;
  bool temperature_recorded = false;       ///< false: the readings' 20 °C are an assumption
  std::vector<PoseGroup> poses;            ///< in the order of their first readings
  std::vector<Reading> readings;           ///< in the file's order
  std::vector<std::string> how_read = {};  ///< sentences about what was converted, skipped or averaged
  Instruments instruments = {};            ///< that have columns

  bool by_joints() const { return !joint_rotates.empty(); }
};

/// Throws InputError "file:line: column 'name': what, remedy" for whatever the table above does not allow, for one
/// label at two commanded poses and for a sequence number that stands twice.
/// `known`: the instruments whose columns the file may have. Where it has loads at named points, place_loads()
/// (configure_all.h) must follow.
Measurements read_measurements(const std::filesystem::path&, const Instruments& known = {});
Measurements parse_measurements(std::string text, const std::string& origin, const Instruments& known = {});

/// Poses and loads to be measured: the same file, readings not wanted and not looked at.
Measurements read_plan(const std::filesystem::path&, const Instruments& known = {});

/// The file that reads back as the same measurements, lines aside: every number is the shortest that does, which for
/// a value in m or Nm that is no multiple of any double in mm or Nmm may be one unit in the last place off. Columns
/// that would say nothing are left out, but for those of displacements that are `to_fill_in`. Written whole or not at
/// all.
void write_measurements(const std::filesystem::path&, const Measurements&, const std::array<bool, 6>& to_fill_in = {});
std::string measurements_text(const Measurements&, const std::array<bool, 6>& to_fill_in = {});

/// One number of a load: a component at T, at a named point, or a factor on a load case.
struct LoadChannel {
  std::string name;  ///< "fx", "node.B.fz", "load.snow"
  bool moment = false;
};
/// What loads_of() gives. A stationary subject: load cases, then the components at nodes that some reading has. Else
/// the six components at T, in which loads at named points are contained.
std::vector<LoadChannel> load_channels(const Measurements&);
/// The loads of all readings (columns), by load channel; N, Nm, 1.
MatrixX loads_of(const Measurements&);

/// All loads of a reading times a factor.
void scale_load(Reading&, double factor);
/// The loads that a row combines, as numbers: load cases, then what acts at each of the load points, then at T; those
/// that are not zero. The components of a load at one point are one load.
std::vector<std::size_t> loads_of_row(const Reading&);
/// One of them times a factor. Where it acts at a named point of a device, place_loads() (configure_all.h) must follow.
void scale_load(Reading&, std::size_t load, double factor);
/// Each of them times a factor of its own, in their order; of a row without load one factor is asked for as well.
/// place_loads() must follow likewise.
void scale_loads(Reading&, const std::function<double()>& factor);

/// These readings, in this order and as often as they stand there, with all poses.
Measurements repeated(const Measurements&, const std::vector<std::size_t>& readings);

/// The readings of one of the poses alone, in the file's order.
Measurements one_pose(const Measurements&, std::size_t pose);

/// The readings in the order they were taken. Throws InputError where the file has no sequence; `purpose` ("friction")
/// says in the message what needs it.
std::vector<std::size_t> in_sequence(const Measurements&, const std::string& purpose);

}  // namespace deflect::measurement
