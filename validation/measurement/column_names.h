// Names of columns, the unit being part of the name, and what to say of a name that is none of them.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace deflect::measurement {

using SixNames = std::array<std::string, 6>;

inline const SixNames pose_columns = {"x_mm", "y_mm", "z_mm", "roll_deg", "pitch_deg", "yaw_deg"};
inline const SixNames load_columns = {"fx_N", "fy_N", "fz_N", "mx_Nmm", "my_Nmm", "mz_Nmm"};
inline const SixNames displacement_columns = {"ux_mm", "uy_mm", "uz_mm", "thx_rad", "thy_rad", "thz_rad"};

struct SensorChannel;
/// "probe_mm", "tilt_rad"; "handle.fx_N".
std::string sensor_column(const SensorChannel&);
std::string load_column(const std::string& point, std::size_t component);

/// Columns of remarks, which mean nothing to the program.
inline bool is_note(std::string_view name) { return name.starts_with("note"); }

/// "unknown column 'ux': the unit is missing, did you mean 'ux_mm'?" The nearest of `known`, or all of them where
/// none is near; a name that differs by its unit only is told which unit its numbers must have.
std::string unknown_column(std::string_view name, const std::vector<std::string>& known);

/// Whether the name is one of `known` but for its unit or the size of its letters.
bool is_misspelled(std::string_view name, const std::vector<std::string>& known);

/// The text on one line, or its beginning and "…" where it is too long for a message.
std::string excerpt(std::string_view);

}  // namespace deflect::measurement
