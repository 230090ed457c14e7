// How well each machine is diagnosed: the same questions to all of them, entries and laws at places hidden alike.
//
// A set is measured on a machine within its tolerances, by the MSA in the deformed shape, with σ of a reading a
// fiftieth of the rms displacement; the diagnosis uses the closed form. In every fourth set nothing is hidden; in the
// others one effect, by turns an entry of the catalogue and a law at a place, drawn by lot, at λ = 4, 8 and 16 in turn.
// Beside it stands what an exact Bayes oracle makes of the same sets (oracle.h), and how well the place is found where
// the hidden law has been taken out of the candidates at its place.
//
// Effects that the data cannot tell from the hidden one (2 Δ ln L < 9) are its class: naming any of them counts as
// right, and so does a tie that holds one of them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "validation/json/json_text.h"

namespace deflect::benchmark {

struct MachineSet {
  std::string device, effect, site, verdict;  ///< effect: empty where nothing is hidden
  std::vector<std::string> missing, tied, alike;
  double lambda = 0, probability = 0, seconds = 0;
  int intervals = 0, covering = 0;
  std::string skipped;
  bool oracle_right = false;
  std::size_t oracle_reported = 0;  ///< how many effects the oracle keeps
  double bias = 0;                  ///< of the effect's first value, in standard deviations, where it is named
  bool named = false;
  /// Where the law was left out: places told and those that hold the hidden one's part.
  int told = 0, told_rightly = 0;
  bool left_out = false, place_found = false;
};

struct MachineRow {
  std::string device;
  std::size_t candidates = 0;  ///< that act
  std::vector<MachineSet> sets;
};

/// Of the built-in devices of those names ("all": every one), so many sets each; in parallel, the same for any number
/// of threads. InputError on an unknown name.
std::vector<MachineRow> diagnose_machines(const std::vector<std::string>& devices, std::size_t sets, std::uint64_t seed,
                                          int threads);

/// One row for each machine, and one for all.
std::string machines_table(const std::vector<MachineRow>&);
Json machines_json(const std::vector<MachineRow>&);

}  // namespace deflect::benchmark
