// Shapes that a residual can have, each with the physics that causes it; the model-free tests of `compare` look for
// them. A pattern is a set of columns over the measured numbers on which the residual is regressed (uncertainty.h). No
// pattern models a part: a good fit shows where and how the model fails, but not yet why.
//
// f is a site's force under the reading's load, g e the displacement of T by the site's elongation e (Site, subject.h):
//   elastic          e ∝ f, alike at all sites: a compliance is missing
//   elastic by site  e ∝ f, each site its own factor
//   step             e ∝ sign f: free travel, whatever the force
//   power            e ∝ sign f |f|^⅔: contact
//   one-sided        e ∝ |f|: yields in one sense only
//   hysteresis       e ∝ −sign of the last change of f; for legs' lines also a friction element in parallel with the
//                    leg. It takes up changes of f to ±r (stop operator; five values of r from 2 to 40 % of the largest
//                    f) and moves T by C s times its force
//   base tilt        the whole machine turns about x, y of the base under the load's moment there
//   tool             T moves against the platform along its axes under the load
//   deformed shape   the change of the prediction by equilibrium in the deformed shape; its size is known: amplitude 1
//   weight           a constant force along −z at T
//   offset           the same displacement in every reading
//   drift            growth with the rank in the sequence; temperature: growth with the temperature
//   load gain        prediction times a factor; load axes, sensor axes: small rotations of either
//
// A subject without tool point (a frame) has, of these, load gain, and by channel offset, drift, temperature and
//   sensor gain      the prediction of one channel times a factor
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
  sensor_gain,
  elastic_at,  ///< one site alone
  elastic_along_slides,
  elastic_across_slides,
};

/// The name of a pattern in JSON and tables, and the physics that causes it. Its sentence is in finding_text.cpp.
struct PatternRow {
  PatternId id;
  const char *name, *title;
};
const PatternRow& row_of(PatternId);

struct Pattern {
  PatternId id;
  std::vector<std::string> columns;  ///< what each amplitude belongs to
  std::string unit;                  ///< of the amplitudes
  MatrixX rows;                      ///< over the measured numbers
};

/// The patterns that the data and the mechanism allow, in the order of the list above.
std::vector<Pattern> patterns_of(const ResidualStudy&);

/// The displacements by given elongations at all sites, summed into one column per reading.
Columns site_column(const ResidualStudy&,
                    const std::function<double(std::size_t reading, std::size_t site)>& elongation);

/// The same over the measured numbers.
VectorX rows_of_sites(const ResidualStudy&,
                      const std::function<double(std::size_t reading, std::size_t site)>& elongation);

/// The same with one column for each site.
Columns site_columns(const ResidualStudy&,
                     const std::function<double(std::size_t reading, std::size_t site)>& elongation);

/// What any linear effect does to the readings of a subject without tool point: each channel answers each load in its
/// own way. One column for each pair that is read four times or more, over the measured numbers.
MatrixX linear_answers(const ResidualStudy&);

}  // namespace deflect::compare
