// The numbers of a description that a user sets free, by their paths as edits take them: "materials.steel.E",
// "leg.joint_1.rz.stiffness", "leg[4].guideway.bending_factor", "members.*.factor".
//
// A number that the description does not allow to be negative is searched and judged on a logarithmic scale, x = ln p;
// any other on a linear one, x = p. A path that stands for several numbers moves them together: all by one factor.
// A user may set an effect free as well: all its parameters, in their units, by the names "guide_root_compliance.
// stiffness_Nmm_per_rad", of one leg "leg_defect[4].…". The subject lacks the effect; its parameters are searched from
// their start values within their bounds, on their own scales.
//
// Every number is searched within the bounds of the description: as far as it is not refused, and no farther than three
// decades (log), ten times its size (linear) or fifty standard deviations of a prior.
#pragma once

#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "msa/base/units.h"
#include "validation/diagnosis/hypothesis.h"
#include "validation/subject/subject.h"

namespace deflect::fit {

/// Normal in p or, for positive numbers, in ln p with standard deviation deviation/mean. SI.
struct Prior {
  double mean = 0, deviation = 0;
};

/// An effect whose parameters are free; with its leg if and only if its scope is one leg.
struct FreedEffect {
  std::shared_ptr<const effects::Effect> effect;
  std::optional<int> leg;

  std::string name() const;  ///< "guide_root_compliance", "leg_defect[4]"
};

struct FreeParameter {
  std::string path;
  Dimension dimension = Dimension::none;
  std::string unit;       ///< in which results give it, as the file does: "GPa"; empty for a plain number
  double per_unit = 1;    ///< SI value of one of that unit
  double value = 0;       ///< SI, in the description; 1 for a common factor
  bool common = false;    ///< the path stands for numbers of different size: the parameter is their common factor
  bool positive = false;  ///< on a logarithmic scale
  /// SI, or of the common factor: it is searched between these, and the description takes it there.
  double least = -std::numeric_limits<double>::infinity(), most = std::numeric_limits<double>::infinity();
  std::optional<Prior> prior;
  std::vector<std::size_t> numbers;  ///< that it moves, by index among those of the description with its legs resolved
  /// Set for a parameter of an effect, which moves no number of the description: `value` is where the search begins,
  /// `positive` its logarithmic scale, `unit` the parameter's. Numbers are in that unit (per_unit = 1), not SI. All
  /// parameters of an effect stand one after the other, in its order.
  std::optional<FreedEffect> of;

  double coordinate(double p) const;  ///< x of p
  double value_at(double x) const;    ///< p of x
  double scale() const;               ///< of x: a change by so much is a large one
};

/// Width of the range in which its coordinate is searched.
double search_range(const FreeParameter&);

/// A prior as the user writes it: "materials.steel.E=210 GPa ± 5 %", "…=210 GPa +- 10 GPa".
struct PriorText {
  std::string path, mean, deviation;
};
/// InputError where the text is not of that form.
PriorText prior_text(const std::string& given);

/// The parameter at a path, without prior and bounds. `yaml`: text of the subject's file, for the unit; in the
/// preferred unit without. InputError where the path leads to no number.
FreeParameter parameter_at(const subject::Subject&, const std::string& path, const std::string& yaml = "");

/// The parameter with bounds about its value, which the subject has: as far as a search goes, or as the description
/// takes the number, to 1e-9 of the range.
FreeParameter bounded(FreeParameter, const subject::Subject&);

/// The parameters in this subject, with their bounds. `yaml`: text of its file, for the units. InputError "--free PATH:
/// …" where a path leads to no number, two paths move one number, or a number that is zero and may be negative has no
/// prior, which alone tells its scale; "--prior …" for a prior of no free parameter or with a unit that does not fit.
/// `effects`: those among `paths`, by the names that stand there; their parameters come behind all numbers.
std::vector<FreeParameter> free_parameters(const subject::Subject&, const std::vector<std::string>& paths,
                                           const std::vector<std::string>& priors, const std::string& yaml = "",
                                           const std::map<std::string, FreedEffect>& effects = {});

/// The parameters of an effect, without priors other than its own. InputError where the subject has no place for it,
/// the leg does not go with its scope, or it has no parameter.
std::vector<FreeParameter> parameters_of(const subject::Subject&, const FreedEffect&);

/// Whether parameters of effects are among them.
bool has_effects(const std::vector<FreeParameter>&);

/// A prior of an effect's parameter, whose unit may be written or left out. InputError likewise.
Prior prior_in_unit(const PriorText&, const FreeParameter&);

/// The same parameters of the subject with these values.
std::vector<FreeParameter> in_version(std::vector<FreeParameter>, const VectorX& values);

/// The first number that each moves, SI; of an effect's parameter its value.
VectorX first_numbers(const subject::Subject&, const std::vector<FreeParameter>&);

/// The subject with these values (SI, by parameter), to be written.
subject::Subject with_values(const subject::Subject&, const std::vector<FreeParameter>&, const VectorX& values);

/// The same without the effects: the subject about whose numbers hypotheses of all these parameters are (Freed).
subject::Subject with_numbers(const subject::Subject&, const std::vector<FreeParameter>&, const VectorX& values);

/// Indices of the tolerances that free parameters take the place of: those of the same numbers.
std::vector<std::size_t> replaced_tolerances(const subject::Subject&, const std::vector<FreeParameter>&,
                                             const std::vector<subject::Tolerance>&);

/// Indices of the tolerances of a subject that the subject without the effects lacks: those of numbers that the effects
/// bring, which are fitted. They come behind others of the same name.
std::vector<std::size_t> added_tolerances(const std::vector<subject::Tolerance>& without,
                                          const std::vector<subject::Tolerance>& with);

/// What the tolerance that a free parameter takes the place of declares of it: standard deviation of the coordinate.
std::optional<double> declared_deviation(const subject::Subject&, const FreeParameter&);

/// One effect for each number, with one parameter of its own: a factor on the value, or what is added to it, in the
/// unit; and the effects that are free. Their hypothesis refers to this object, which must outlive it.
class Freed {
 public:
  explicit Freed(const std::vector<FreeParameter>&);
  diagnosis::Hypothesis hypothesis() const;
  /// The effects' values from the parameters' and back; SI.
  VectorX effect_values(const VectorX& values) const;
  VectorX values(const VectorX& of_effects) const;

 private:
  std::vector<FreeParameter> parameters_;
  std::vector<effects::Effect> effects_;
};

}  // namespace deflect::fit
