// Shapes that a residual can have, each with the physics that leaves it: what the model-free tests of `compare` look
// for. A pattern is a set of columns over the measured numbers, in which residuals are regressed (uncertainty.h); none
// of them is a model of a part, so that a fit to one says where and how the model fails and not yet why.
//
// With a site's force f under the reading's load and g e what its elongation e does at T (sites.h):
//   elastic          e ∝ f, alike at all sites: a compliance is missing
//   elastic by site  e ∝ f, each site its own factor
//   step             e ∝ sign f: free travel, whatever the force
//   power            e ∝ sign f |f|^⅔: contact
//   one-sided        e ∝ |f|: gives in one sense only
//   hysteresis       e ∝ −sign of the last change of f; and along legs' lines a friction element beside the leg, which
//                    takes over changes of f up to ±r (stop operator, five r from 2 to 40 % of the largest f) and moves
//                    T as C s does under that force
//   base tilt        the whole machine turns about x, y of the base under the load's moment there
//   tool             T moves against the platform along its axes under the load
//   deformed shape   what equilibrium in the deformed shape changes in the prediction, known in size: amplitude 1
//   weight           a constant force along −z at T
//   offset           the same displacement in every reading
//   drift            growth with the rank in the sequence; temperature: with the temperature
//   load gain        prediction times a factor; load axes, sensor axes: small rotations of either
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "validation/compare/residual_study.h"

namespace deflect::compare {

using Columns = std::vector<Eigen::Matrix<double, 6, Eigen::Dynamic>>;  ///< by reading

enum class PatternId {
  elastic,
  elastic_by_site,
  step,
  power,
  one_sided,
  hysteresis,
  base_tilt,
  tool,
  weight,
  offset,
  drift,
  temperature,
  load_gain,
  load_axes,
  sensor_axes,
  elastic_at,  ///< one site alone
  elastic_along_slides,
  elastic_across_slides,
};

/// What a pattern is called in JSON and tables, and the physics that leaves it. Its sentence is in finding_text.cpp.
struct PatternRow {
  PatternId id;
  const char *name, *title;
};
const PatternRow& row_of(PatternId);

struct Pattern {
  PatternId id;
  std::vector<std::string> columns;  ///< what each amplitude belongs to
  std::string unit;                  ///< of the amplitudes
  Columns by_reading;
};

/// Those that the data and the mechanism allow, in the order of the list above.
std::vector<Pattern> patterns_of(const ResidualStudy&);

/// e(site, f, extension) at every site, all together in one column.
Columns site_column(const ResidualStudy&,
                    const std::function<double(std::size_t reading, std::size_t site)>& elongation);

/// The same over the measured numbers.
VectorX rows_of_sites(const ResidualStudy&,
                      const std::function<double(std::size_t reading, std::size_t site)>& elongation);

/// `elongation` in a column of each site's own.
Columns site_columns(const ResidualStudy&,
                     const std::function<double(std::size_t reading, std::size_t site)>& elongation);

}  // namespace deflect::compare
