// Built-in devices and the arguments that commands share.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "msa/frame/mechanism/build.h"
#include "msa/mechanism/description.h"
#include "validation/measurement/measurements.h"
#include "validation/parallel/ranks.h"
#include "validation/theories/theories.h"

namespace deflect::cli {

/// Where the program's devices and effects are: share/deflect beside an installed program, the source tree otherwise.
std::filesystem::path data_folder();

/// Names of the built-in devices, and of the frames: published cases and examples; sorted.
std::vector<std::string> device_names();
std::vector<std::string> frame_names();

/// The file of a built-in name, or of a path. InputError with the nearest name, or, where the name is one of the other
/// kind, with the command that takes it.
std::filesystem::path device_file(const std::string& name_or_path);
std::filesystem::path frame_file(const std::string& name_or_path);

/// The device of that name or path, with remarks on what can hardly be meant; InputError as device_file() and
/// read_mechanism() have it.
Mechanism read_device(const std::string& name_or_path);

/// As read_measurements(), told where verbose.
Measurements read_data(const std::string& file);

/// Of large data (20 000 readings): about how much memory the work takes that keeps so many numbers for each that was
/// measured. Where progress is shown, and where verbose.
void tell_size(const Measurements&, double numbers_kept);

/// The number of --threads of this process; 0: all of the machine, with ranks all that this rank has.
int parse_threads(double, const Ranks* = nullptr);

/// As write_text(), told where verbose.
void write_table(const std::filesystem::path&, const std::string& text);

/// Likewise, of a file that the user names: a folder that has to be made for it is said.
void write_file(const std::filesystem::path&, const std::string& text);

/// Says that the folder of a file that is about to be written is not there yet.
void say_new_folder(const std::filesystem::path& file);

/// "1,2.5,-3" → numbers; exactly one of `counts` of them, or InputError naming the option and what it wants.
std::vector<double> parse_list(const std::string& option, const std::string& text,
                               const std::vector<std::size_t>& counts, const std::string& wanted);

/// Three or six of them, the rest zero. `counts` as above.
Vector6 parse_six(const std::string& option, const std::string& text, const std::vector<std::size_t>& counts,
                  const std::string& wanted);

/// Where --pose (mm, deg) puts the mechanism, or --joints by forward kinematics; the home pose, where `or_home` or
/// nothing is driven, without either. Throws InputError for both or none, ModelError when the mechanism cannot stand
/// there.
Stand parse_stand(const Mechanism&, const std::string& pose, const std::string& joints, bool or_home);

/// The wrench of --load in N and Nmm, zero where it is empty.
Vector6 parse_load(const std::string& load);

/// A positive length with unit ("25 mm"), in m; InputError naming the option.
double parse_length(const std::string& option, const std::string& text);

/// "25 mm" for --element-size; the members of the device divided so by Gmsh at its home pose. Empty: one element each.
frame::MemberDivision divide(const Mechanism&, const std::string& element_size);

/// The standard deviation that an option gave in a unit of which `per_SI` make one in SI; none where it is empty.
/// Throws InputError where it is not above zero.
std::optional<double> parse_sigma(const std::string& option, const std::string& text, const std::string& unit,
                                  double per_SI);

/// The whole number that an option gave. Throws InputError where it is none between low and high.
int whole(const std::string& option, double value, double low, double high);

}  // namespace deflect::cli
