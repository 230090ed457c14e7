// What Python sees of the library: the module deflect._core. The package around it (deflect/*.py) has the names,
// defaults and units that users meet; here are values and functions. Units as in results: N, Nmm, mm, rad, poses in mm
// and deg.
#pragma once

#include <pybind11/eigen.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "validation/effects/effect.h"
#include "validation/effects/with_effect.h"
#include "validation/measurement/measurements.h"
#include "validation/subject/subject.h"

namespace deflect::python {

/// A text and what messages call it, in place of a file.
using NamedText = std::pair<std::string, std::string>;

/// An effect whose edits a Python function computes. `head`: an effect file with its parameters, whose edits do not
/// count. `edits`: called with the parameters' values, returns (whether they are possible, an effect file with the
/// edits for them or else what is wrong). It is held with the interpreter's lock alone.
struct ComputedEffect {
  NamedText head;
  std::shared_ptr<pybind11::function> edits;

  ComputedEffect(NamedText, pybind11::function);
  effects::Effect effect() const;
};

/// The effects that functions know: the folder of the catalogue, texts of others, and computed ones.
struct EffectSources {
  std::string catalogue;
  std::vector<NamedText> own;
  std::vector<ComputedEffect> computed;

  /// Catalogue and own ones.
  std::vector<effects::Effect> named() const;

  /// These, and the laws at the subject's places.
  std::vector<effects::Effect> known(const subject::Subject&) const;
};

/// An effect by its name, with its leg and the values of parameters.
struct AskedEffect {
  std::string name;
  std::optional<int> leg;
  std::vector<std::pair<std::string, double>> values;
};

/// The effect with its values; those not given are the ones at which a search begins. InputError as instance() of
/// found_effects.h, and for values out of bounds. The effect must outlive it.
effects::EffectInstance instance_of(const effects::Effect&, const AskedEffect&);

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
/// Those of several sessions of one campaign as one (joined.h). InputError for none, and for the same text twice.
measurement::Measurements data_of(const subject::Subject&, const std::vector<NamedText>& sessions);
/// A plan likewise.
measurement::Measurements plan_of(const subject::Subject&, const NamedText&);

void bind_subjects(pybind11::module_&);
void bind_studies(pybind11::module_&);
void bind_measured(pybind11::module_&);
void bind_campaigns(pybind11::module_&);
void bind_structures(pybind11::module_&);

}  // namespace deflect::python
