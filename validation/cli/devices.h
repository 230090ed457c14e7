// Built-in devices and the arguments that commands share.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "msa/frame/file/frame_description.h"
#include "msa/frame/mechanism/build.h"
#include "msa/mechanism/description.h"
#include "msa/mechanism/stand.h"
#include "validation/cli/command.h"
#include "validation/measurement/measurements.h"
#include "validation/parallel/ranks.h"
#include "validation/subject/subject.h"
#include "validation/theories/theory.h"

namespace deflect::cli {

/// The folder of devices and effects: share/deflect of an installed program, or of the build tree (a link to the
/// source).
std::filesystem::path data_folder();

/// Sorted names of the built-in devices, and of the built-in frames (published cases and examples).
std::vector<std::string> device_names();
std::vector<std::string> frame_names();

/// The file of a built-in name, or the path itself. InputError names the nearest name; for a name of the other kind it
/// names the command that reads it.
std::filesystem::path device_file(const std::string& name_or_path);
std::filesystem::path frame_file(const std::string& name_or_path);

/// Reads the device and remarks on implausible materials. Throws InputError like device_file() and read_mechanism().
Mechanism read_device(const std::string& name_or_path);

/// Reads a frame. Throws InputError like frame_file() and frame::read_frame().
frame::FrameDescription read_frame(const std::string& name_or_path);

/// Reads what is measured: a device, or a frame, told by the file's keys.
subject::Subject read_subject(const std::string& name_or_path);
/// The file of either.
std::filesystem::path subject_file(const std::string& name_or_path);

/// read_measurements() with the instruments of the subject, with a summary if verbose.
measurement::Measurements read_data(const std::string& file, const subject::Subject&);

/// Of several files, which are sessions of one campaign, all readings as one (joined.h).
measurement::Measurements read_sessions(const std::vector<std::string>& files, const subject::Subject&);

/// Poses and loads to be measured with the instruments of the subject.
measurement::Measurements read_plan(const std::string& file, const subject::Subject&);

/// For 20 000 readings or more, prints roughly how much memory the work needs if it keeps `numbers_kept` numbers per
/// measured number. Only if progress is shown or the program is verbose.
void tell_size(const measurement::Measurements&, double numbers_kept);

/// The number of threads from --threads; for 0, all of this rank's threads, or 0 (all of the machine) without ranks.
int parse_threads(double, const parallel::Ranks* = nullptr);

/// write_text(), reported if verbose.
void write_table(const std::filesystem::path&, const std::string& text);

/// The same for a file that the user names; remarks on a folder that it creates.
void write_file(const std::filesystem::path&, const std::string& text);

/// Remarks that the folder of a file to be written does not exist yet.
void say_new_folder(const std::filesystem::path& file);

/// "1,2.5,-3" → numbers. InputError unless their number is one of `counts`; it names the option and `wanted`.
std::vector<double> parse_list(const std::string& option, const std::string& text,
                               const std::vector<std::size_t>& counts, const std::string& wanted);

/// The same as a vector of six, padded with zeros.
Vector6 parse_six(const std::string& option, const std::string& text, const std::vector<std::size_t>& counts,
                  const std::string& wanted);

/// The mechanism at --pose (mm, deg), or at --joints by forward kinematics. Without either: at the home pose, if
/// `or_home` or if it has no actuators. Throws InputError for both options, and for none if one is needed; ModelError
/// if the mechanism cannot assemble there.
Stand parse_stand(const Mechanism&, const std::string& pose, const std::string& joints, bool or_home);

/// --geometry linear, second-order or finite.
Geometry parse_geometry(const std::string& text);

/// --theories analytic,msa: of the table; all where the text is empty.
theories::Theories parse_theories(const std::string& list);
Option theories_option(std::string* list);

/// The wrench of --load in N and Nmm; zero if empty.
Vector6 parse_load(const std::string& load);

/// A positive length with unit ("25 mm"), in m. InputError names the option.
double parse_length(const std::string& option, const std::string& text);

/// The device's members as Gmsh divides them for --element-size ("25 mm") at the home pose; empty: one element each.
frame::MemberDivision divide(const Mechanism&, const std::string& element_size);

/// A standard deviation in SI from an option in a unit of which `per_SI` make one SI unit; none if the option is empty.
/// Throws InputError unless it is above zero.
std::optional<double> parse_sigma(const std::string& option, const std::string& text, const std::string& unit,
                                  double per_SI);

/// The number from an option. Throws InputError unless it is whole and between low and high.
int whole(const std::string& option, double value, double low, double high);

}  // namespace deflect::cli
