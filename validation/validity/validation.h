// How far to trust a model where it will be used: validation in the words of the standards (errors.h, metrics.h,
// domain.h, sensitivity.h, maturity.h).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "validation/validity/domain.h"
#include "validation/validity/maturity.h"
#include "validation/validity/metrics.h"
#include "validation/validity/numerical.h"
#include "validation/validity/sensitivity.h"

namespace deflect::validity {

/// One measured quantity: a component of T's displacement, or a sensor.
struct ChannelValidity {
  std::string name;
  measurement::Quantity quantity = measurement::Quantity::length;
  std::size_t numbers = 0;
  double mean_E = 0, rms_E = 0, rms_D = 0;                  ///< SI
  double num = 0, input = 0, noise = 0, load = 0, val = 0;  ///< root mean squares of the uncertainties
  double within = 0;                                        ///< share of the numbers with |E| ≤ k u_val
  Agreement agreement;
  std::vector<double> u;  ///< of u-pooling, sorted
  double area = 0;        ///< of u against the diagonal
  double area_SI = 0;     ///< mapped back: in the quantity's unit
  std::optional<Bias> bias;
};

/// Calibration data beside the validation data.
struct Calibration {
  std::string data;
  std::size_t readings = 0, poses_shared = 0;
  double rms_E = 0, validation_rms_E = 0;  ///< of the quantity of errors, SI
};

struct Use {
  fit::PredictedPlan predicted;  ///< with the discrepancy that this validation found
  std::vector<UsePoint> points;
};

struct ValidationStudy {
  std::string device, data;
  compare::Comparison comparison;
  bool calibrated = false;  ///< u_input has parameters of a fit
  std::size_t theories = 0;
  double theories_differ = 0;  ///< by how much, of the predictions of a quantity: root mean squares, the largest
  std::vector<ComparisonError> errors;  ///< by measured number
  std::vector<MeshOrder> mesh;          ///< how u_num falls with the size of the elements
  Agreement agreement;
  std::vector<ChannelValidity> channels;
  std::vector<double> u;  ///< of all numbers, sorted
  double area = 0, expected_area = 0;
  std::vector<fit::Discrepancy> discrepancies;  ///< beyond u_val; 0 where the model agrees
  std::vector<Range> domain;
  std::vector<WithoutGroup> without;
  std::vector<Sameness> same;
  std::optional<Calibration> calibration;
  std::optional<Use> use;
  std::size_t assumed = 0;  ///< numbers of the description that are marked as assumed
};

struct ValidationOptions {
  compare::ComparisonOptions comparison;
  std::optional<fit::Knowledge> fit;           ///< of the calibration
  std::vector<fit::FreeParameter> parameters;  ///< whose sameness is tested; those of the fit where there are none
  const measurement::Measurements* calibration = nullptr;
  const measurement::Measurements* use = nullptr;  ///< a plan
};

/// The study keeps a reference to the data, which must outlive it. InputError where calibration and validation share a
/// reading under load: what a model was fitted to cannot validate it.
ValidationStudy validate(const subject::Subject&, const measurement::Measurements&, const ValidationOptions& = {},
                         const parallel::Work& = {});

}  // namespace deflect::validity
