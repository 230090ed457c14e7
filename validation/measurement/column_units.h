// Names of columns as laboratories write them, and what their numbers are in the unit of the contract.
//
//   forces f.            N  mN  daN  kN  kgf  kp  gf  lbf
//   moments m.           Nmm  Ncm  Nm  kNm  kgfmm  kgfcm  kgfm  lbfin  lbfft
//   x y z, u., sigma_u   mm  nm  um  µm  cm  m  in  inch  mil
//   roll pitch yaw, th., sigma_th   deg  rad  mrad  urad  µrad
//   q. of a joint        one of the last two rows; angles become rad, lengths mm
//   temperature          C  K  F
//   strain               um_per_m  um/m  µm/m  µε  mm/m  1  %
//   a sensor's name      as u., th., f., m. or strain, by what it reads;  handle.f., handle.m. at a named point: as f.
//   and m.
//
// The unit follows the stem after "_" or in brackets: "fx_kgf", "Fx [kgf]", "FX (N)". Case does not count where it does
// not tell units apart.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "validation/measurement/measurements.h"

namespace deflect::measurement {

struct NamedColumn {
  std::string name;               ///< of the contract: "fx_N", "q3_rad", "pose"
  std::string unit;               ///< as written, where it is not that of the name
  double factor = 1, offset = 0;  ///< number of the contract = factor · (number + offset)

  bool as_it_stands() const { return factor == 1 && offset == 0; }
};

/// Nothing where the name is none of them; `unit` is that of a row of units, empty without one. A name with a unit of
/// its own and another in the row of units is nothing either.
std::optional<NamedColumn> named_column(std::string_view written, std::string_view unit = {},
                                        const Instruments& known = {});

/// Whether the text could stand in a row of units: a unit of the above, in brackets or not, or "-" or nothing.
bool is_unit(std::string_view text);

}  // namespace deflect::measurement
