// Measurement files made up for tests.
#pragma once

#include <string>

#include "msa/base/error.h"
#include "validation/measurement/measurements.h"

namespace deflect::test {

/// Six commanded numbers, three forces, three translations: what nearly every file has.
inline const std::string usual_header =
    "pose,x_mm,y_mm,z_mm,roll_deg,pitch_deg,yaw_deg,fx_N,fy_N,fz_N,ux_mm,uy_mm,uz_mm";

/// The usual columns, and after them `more` of these.
inline std::string usual_file(const std::string& rows, const std::string& more = "") {
  return usual_header + more + "\n" + rows;
}

/// What parse_measurements says against the text, "data.csv" being its file; "" when it reads it.
inline std::string refusal(const std::string& text) {
  try {
    measurement::parse_measurements(text, "data.csv");
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

}  // namespace deflect::test
