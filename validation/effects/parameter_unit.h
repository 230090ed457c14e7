// A parameter name ends with its unit: "stiffness_Nmm_per_rad" is in Nmm/rad.
#pragma once

#include <optional>
#include <string>

namespace deflect::effects {

/// The unit as a description writes it ("Nmm/rad", "1/K"); "" for a plain number; nullopt where the name ends like a
/// unit that is not known. `mm_per_N23` (mm/N^(2/3)) has no unit in descriptions; its uses state one, as in "$c mm".
std::optional<std::string> unit_of_parameter(const std::string& name);

/// The unit as shown to the user: "mm/N^(2/3)".
std::string printed_unit(const std::string& name);

/// "N, Nmm, N_per_mm, …", for messages.
std::string known_parameter_units();

}  // namespace deflect::effects
