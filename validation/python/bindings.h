// What Python sees of the library: the module deflect._core. The package around it (deflect/*.py) has the names,
// defaults and units that users meet; here are values and functions. Units as in results: N, Nmm, mm, rad, poses in mm
// and deg.
#pragma once

#include <pybind11/eigen.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "validation/effects/effect.h"
#include "validation/measurement/measurements.h"
#include "validation/subject/subject.h"

namespace deflect::python {

/// A text and what messages call it, in place of a file.
using NamedText = std::pair<std::string, std::string>;

/// The effects that functions know: the folder of the catalogue, and texts of others.
struct EffectSources {
  std::string catalogue;
  std::vector<NamedText> own;

  /// These, and the laws at the subject's places.
  std::vector<effects::Effect> known(const subject::Subject&) const;
};

/// An effect by its name, with its leg and the values of parameters.
struct AskedEffect {
  std::string name;
  std::optional<int> leg;
  std::vector<std::pair<std::string, double>> values;
};

/// Standard deviations of readings where a file has none; and whether the search for recording mistakes is left out.
struct Noise {
  std::optional<double> sigma_mm, sigma_rad;
  bool as_recorded = false;

  /// SI. InputError unless above zero.
  std::optional<double> translation() const;
  std::optional<double> rotation() const;
};

/// The numbers of an array or a sequence, 1 … 6; those not given are zero. InputError names `what`.
Vector6 six(const char* what, const std::vector<double>& given, std::initializer_list<std::size_t> counts = {3, 6});

/// A wrench (N, Nmm) as a load that a description may carry.
Vector6 load_from(const std::vector<double>& given);

/// Measurements of the subject, from the text of a file.
measurement::Measurements data_of(const subject::Subject&, const NamedText&);
/// A plan likewise.
measurement::Measurements plan_of(const subject::Subject&, const NamedText&);

void bind_subjects(pybind11::module_&);
void bind_studies(pybind11::module_&);
void bind_measured(pybind11::module_&);
void bind_campaigns(pybind11::module_&);

}  // namespace deflect::python
