// The validation as files and as a table: JSON by the contract of `validate --json`, CSV, text for a person.
// Displacements of the tool point in base axes, mm and rad. JSON and CSV hold numbers that read back exactly;
// a number that is not finite throws NumericalError naming it.
#pragma once

#include <string>

#include "validation/studies/errata_prices.h"
#include "validation/studies/mesh_study.h"
#include "validation/studies/validate.h"

namespace deflect::report {

/// {"device", "theories": [{"name", "title"}, …], "points": [{"point", "pose", "load_axis", "load_N", a member for each
/// theory, "as_printed" where present}, …], "max_relative_difference", "rms_relative_difference"}. "point" is an
/// integer where the label is one. With prices, "errata": [{"erratum", "equations", "smallest", "largest": ratios
/// printed / corrected for loads along x, y, z, null where not finite, or "refused"; "failed_check"}, …]. With a mesh
/// study, "mesh_study": [{"element_mm", "elements_per_leg", "max_relative_difference"}, …].
std::string validation_json(const studies::Validation&, const std::vector<studies::ErratumPrice>& = {},
                            const std::vector<studies::MeshStudyRow>& = {});

/// One line per row: point, x_mm … yaw_deg, load_axis, load_N, analytic_ux_mm … analytic_thz_rad, and so on by theory,
/// as_printed_… (where any row has it; empty where that row has none), relative_difference.
std::string validation_csv(const studies::Validation&);

/// One line per point: deflection along the load by each theory (mm) and the larger relative difference.
/// With the theory as printed, one line per point and load: as printed, corrected, MSA and corrected / as
/// printed, which is how many times too stiff the printed theory is. Ends with the largest and the rms
/// difference.
std::string validation_table(const studies::Validation&);

/// The price of each erratum of the paper, deflection as printed / corrected, as aligned text for a person: name,
/// equations, range of the ratio for loads along x, y, z, what fails.
std::string errata_table(const std::vector<studies::ErratumPrice>&);

/// A line for each size of elements: elements of a leg, largest relative difference of the two theories.
std::string mesh_study_table(const std::vector<studies::MeshStudyRow>&);

/// The price of each erratum as a table: columns erratum, equations, ratio_x_min … ratio_z_max, failed_check, refused.
std::string errata_csv(const std::vector<studies::ErratumPrice>&);

}  // namespace deflect::report
