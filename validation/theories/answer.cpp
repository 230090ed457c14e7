#include "validation/theories/answer.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>

#include "msa/base/error.h"
#include "msa/mechanism/law.h"
#include "msa/mechanism/stand.h"

namespace deflect::theories {
namespace {

void enforce(const std::string& failure, const Asked& asked, const char* what) {
  if (!failure.empty())
    throw NumericalError(fmt::format("{}: the {} {} fails a check: {}", place_text(asked.device, asked.at),
                                     asked.theory, what, failure));
}

bool from_rest(const Conditions& c) {
  return c.warmer == 0 && std::all_of(c.slips.begin(), c.slips.end(), [](double slip) { return slip == 0; });
}

/// Parts carry forces before any load.
bool strained_at_rest(const Configuration& c) {
  const auto preloaded = [](const PlacedJoint& joint) {
    return std::any_of(joint.preload.begin(), joint.preload.end(), [](double force) { return force != 0; });
  };
  bool found = preloaded(c.base) || preloaded(c.tool) ||
               std::any_of(c.legs.begin(), c.legs.end(), [](const PlacedLeg& l) { return !l.misfit.isZero(0); });
  for_each_part(c.legs, [&](const auto& part) {
    if constexpr (requires { part.preload; }) found = found || preloaded(part);
  });
  return found;
}

}  // namespace

double bound_with(double least, double rounding) {
  constexpr double roundings = 100;
  return std::max(least, roundings * rounding);
}

double rounding_of(const Answer& answer, double length) {
  constexpr double epsilon = std::numeric_limits<double>::epsilon(), most = 1e-7;
  Vector6 inverse = Vector6::Ones();
  inverse.tail<3>().setConstant(1 / length);
  const Matrix6 weighed = inverse.asDiagonal() * answer.stiffness * inverse.asDiagonal();
  const Vector6 all = Eigen::SelfAdjointEigenSolver<Matrix6>(weighed, Eigen::EigenvaluesOnly).eigenvalues();
  const double lost = epsilon * all(5);  // in the rounding of the largest
  if (!(lost > 0)) return 0;
  Eigen::Index softest = answer.rigid;
  while (!answer.floating.loose.empty() && softest < 5 && all(softest) < lost) ++softest;
  return std::min(0.1 * lost / std::max(all(std::min<Eigen::Index>(softest, 5)), lost), most);
}

std::string place_text(const std::string& device, const Configuration& c) {
  Vector6 pose = mm_deg_from(c.pose);
  for (double& value : pose)
    if (std::abs(value) < 1e-9) value = 0;  // the rounding of a rotation taken apart
  return fmt::format("{} at ({:.6g})", device, fmt::join(pose, ", "));
}

Vector6 with_weight(const Vector6& F, const Configuration& c) {
  Vector6 load = F;
  load.head<3>() += c.weight;
  return load;
}

double total(const std::vector<std::pair<std::string, double>>& energies) {
  double sum = 0;
  for (const auto& [part, energy] : energies) sum += energy;
  return sum;
}

AtRest at_rest(const Configuration& c) {
  AtRest out{strained_at_rest(c), any_history(c)};
  for_each_law(c, [&](const Law& law) { out.softens = out.softens || std::holds_alternative<TableLaw>(law); });
  return out;
}

void enforce_stiffness(const StiffnessChecks& checks, const Asked& asked) {
  enforce(checks.failure, asked, "stiffness");
}

std::string failure_of(const Answer& answer, const Found& found, const AtRest& rest, const Conditions& conditions) {
  return response_failure({found.load, answer.displacement, found.reaction, found.energy, found.linear,
                           from_rest(conditions), rest.strained, rest.history, rest.softens, answer.rigid > 0},
                          bound_with(checked_to, found.rounding));
}

void check_answer(const Answer& answer, const Asked& asked, const Found& found, const AtRest& rest,
                  const Conditions& conditions) {
  enforce(failure_of(answer, found, rest, conditions), asked, "response");
}

/// Shapes are known to 1e-12, forces and stiffness to that times the ratio of the stiffest to the softest part: of a
/// member in short elements some 1e4.
Answer deformed_answer(Answer answer, const Asked& asked, const Found& found, const Matrix6& rounding) {
  constexpr double known_to = 1e-7;
  Matrix6 K = answer.stiffness;
  K.bottomRightCorner<3, 3>() += skew(found.load.tail<3>()) / 2;
  answer.checks = check_stiffness(K, {}, known_to, rounding);
  enforce_stiffness(answer.checks, asked);
  Vector6 balance = -found.load;
  balance.head<3>() = found.reaction.head<3>();
  enforce(response_failure({found.load, answer.displacement, balance, 0, false}, known_to), asked, "response");
  return answer;
}

}  // namespace deflect::theories
