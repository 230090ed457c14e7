#include "tests/attack/shape_judge.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <optional>

#include "analytic/model.h"
#include "msa/base/error.h"
#include "msa/frame/mechanism/msa.h"
#include "msa/mechanism/device_file.h"
#include "tests/attack/count.h"
#include "tests/attack/shape_oracle.h"
#include "tests/support/apart.h"
#include "validation/theories/agreement.h"

namespace deflect::attack {
namespace {

using theories::Answer;

/// What one theory says, or why it says nothing.
struct Said {
  std::optional<Answer> linear, finite;
  std::string refuses;
};

constexpr int elements = 4;  // of each member at first; the MSA divides further until 1e-6 is left

Said ask(const theories::Theory& theory, const Configuration& c, const Vector6& F, Geometry geometry, bool linear_too) {
  Said out;
  try {
    const auto at = theory.at(c, {"device", frame::equal_division(c, elements)});
    if (linear_too) out.linear = at->answer(F);
    out.finite = at->answer(F, geometry);
  } catch (const ModelError& e) {
    out.refuses = e.what();
  } catch (const NumericalError& e) {
    out.refuses = e.what();
  }
  return out;
}

/// How far an answer may be off: both theories divide members until they estimate that 1e-6 is left, and are known to
/// ten times what they estimate (README of analytic). What they leave open: `open`.
double allowed(const Answer& a, double size, double open) {
  Vector6 left = Vector6::Zero();
  left(0) = a.discretisation(0), left(3) = a.discretisation(1);
  return 1e-6 + 10 * test::apart(Vector6(a.displacement + left), a.displacement, size) + open;
}

struct Shaped {
  const ShapedDevice& device;
  const Configuration& c = device.at.configuration;
  const Vector6& F = device.random.load;
  std::array<Said, 2> said{};
  ShapeTruth truth{};

  bool jumps() const {
    bool out = false;
    for_each_law(c, [&](const Law& law) { out = out || deflect::jumps(law); });
    return out;
  }

  /// What of the answers is open by what the theories say of themselves: laws that jump beside misfits are taken apart,
  /// and play that the linear geometry leaves open may be at either end.
  double open() const {
    double out = 0;
    for (const Said& s : said) {
      if (!s.linear || !s.finite) continue;
      if (s.linear->apart || s.finite->apart)
        out = std::max(out, test::apart(s.linear->displacement, s.finite->displacement, c.size));
      const Vector6 room = s.linear->floating.most - s.linear->floating.least;
      if (room.allFinite())
        out = std::max(out, test::apart(Vector6(s.finite->displacement + room), s.finite->displacement, c.size));
    }
    return out;
  }

  /// What small strains leave open.
  double of_strain() const {
    const ShapeTruth other = solve_in_shape(c, F, device.share, Shear::as_way);
    return other.found ? test::apart(other.displacement, truth.displacement, c.size) : 0;
  }
};

void compare_with_truth(ShapeJudgement& out, const Shaped& s) {
  double open = s.open();
  const auto errors = [&] {
    out.of_allowed = 0;
    std::array<double, 2> error{};
    for (std::size_t i = 0; i < 2; ++i)
      if (const auto& a = s.said[i].finite) {
        error[i] = test::apart(a->displacement, s.truth.displacement, s.c.size);
        if (!a->apart) out.of_allowed = std::max(out.of_allowed, error[i] / allowed(*a, s.c.size, open));
      }
    out.closed_form = error[0], out.msa = error[1];
  };
  errors();
  if (out.of_allowed > 1) {
    out.of_strain = 2 * s.of_strain();
    open += out.of_strain;
    errors();
  }
}

/// K of both theories times the judge's compliance is one, to a hundredth of what the shape changes: an element of a
/// quarter of a member errs by θ²/192 of a member that bends by θ, where the shape changes as much as θ. What
/// is open of the second order of the displacement is so twice in its slope. K is symmetric but for the
/// moment and for rounding, which this shows.
void compare_stiffness(ShapeJudgement& out, const Shaped& s) {
  if (s.jumps()) return;  // the closed form's is that of linear geometry there
  Vector6 w = Vector6::Ones();
  w.tail<3>().setConstant(s.c.size);
  const Matrix6 C = w.asDiagonal() * s.truth.compliance * w.asDiagonal();
  const double change = all_linear(s.c) ? (w.asDiagonal() * s.truth.at_rest * w.asDiagonal() - C).norm() / C.norm() : 1;
  for (const Said& said : s.said)
    if (said.finite && said.finite->rigid == 0) {
      const Matrix6 K = w.cwiseInverse().asDiagonal() * said.finite->stiffness * w.cwiseInverse().asDiagonal();
      Matrix6 without_moment = said.finite->stiffness;
      without_moment.bottomRightCorner<3, 3>() += skew(s.F.tail<3>()) / 2;
      const Matrix6 S = w.cwiseInverse().asDiagonal() * without_moment * w.cwiseInverse().asDiagonal();
      const double differences = 1e-13 / s.device.share * S.norm();  // by which the judge has its matrix
      const double rounding = 10 * ((S - S.transpose()).norm() + differences) * C.norm(),
                   left = allowed(*said.finite, s.c.size, 0), error = (C * K * C - C).norm() / C.norm();
      out.compliance = std::max(out.compliance, error / (1e-2 * change + 2 * (left + out.of_strain) + rounding));
    }
}

ShapeClass class_of(const ShapeTruth& truth) {
  if (truth.found && truth.stable) return truth.regular ? ShapeClass::equilibrium : ShapeClass::singular;
  return truth.stable || !truth.regular ? ShapeClass::agreement : ShapeClass::gives_way;
}

/// Whether a refusal is a limit that the theories name, or one that their READMEs do not promise to pass: motions
/// without any compliance in the deformed shape, members that bend too far, passive joints at a dead centre (the judge
/// jumps to another way to assemble them), laws that begin without a stiffness while misfits grow, and what slips and
/// would be held only where the shape has changed.
bool at_a_limit(const Shaped& s) {
  const bool laws = !all_linear(s.c);
  return std::any_of(s.said.begin(), s.said.end(), [&](const Said& said) {
    const auto says = [&](const char* words) { return said.refuses.find(words) != std::string::npos; };
    return says("infinite stiffness") || says("members bend so far") || says("singular position") ||
           (laws && (says("of the misfits") || says("nothing else holds"))) || (said.linear && said.linear->rigid > 0);
  });
}

/// Parts of extreme ratios may be refused in the deformed shape, where very stiff members get no relative coordinates
/// (geometric_solver.h); no answer may be wrong.
bool of_extremes(const Shaped& s) { return s.device.random.kind == DeviceKind::stiff_and_soft; }

/// What the program makes of both answers: it compares them.
Outcome outcome_of(const ShapeJudgement& j, const Shaped& s) {
  const auto &a = s.said[0].finite, &m = s.said[1].finite;
  if (!a || !m)
    return j.kind == ShapeClass::equilibrium && !at_a_limit(s) && !of_extremes(s) ? Outcome::refused_wrongly
                                                                                  : Outcome::refused_rightly;
  const bool agree = j.between <= allowed(*a, s.c.size, s.open()) + allowed(*m, s.c.size, 0);
  if (j.kind == ShapeClass::gives_way) return agree ? Outcome::answered_wrongly : Outcome::refused_rightly;
  if (j.kind == ShapeClass::agreement) return agree ? Outcome::answered : Outcome::refused_rightly;
  const bool right = j.of_allowed <= 1 && j.compliance <= 1;
  if (j.kind == ShapeClass::singular && !agree) return Outcome::refused_rightly;
  return right ? Outcome::answered : Outcome::answered_wrongly;
}

/// Whether the theories differ by the square of the load, as what each leaves out does: at half of it a quarter, with a
/// quarter of that left for the next order. Of short elements, which leave little, and of members that neither stretch
/// nor shear: by these strains, times what they move, the theories differ in the first order (README of analytic).
bool apart_in_second_order(const Configuration& c, const Vector6& F) {
  std::array<double, 2> apart{};
  Configuration with = c;
  for_each_part(with.legs, [](auto& part) {
    if constexpr (requires { part.section; }) part.section.A *= 100, part.beam = BeamTheory::euler_bernoulli;
  });
  for (std::size_t i = 0; i < 2; ++i) {
    const double share = i == 0 ? 0.5 : 0.25;
    with.weight = share * c.weight;
    const auto a = analytic::AnalyticModel(with).solve(share * F, Geometry::second_order);
    const auto m = frame::MsaModel(with, frame::equal_division(c, 32)).solve(share * F, Geometry::second_order);
    if (!a.converged || !m.state.converged) return false;
    apart[i] = test::apart(a.displacement, m.displacement, c.size);
  }
  return apart[1] <= apart[0] / 3 + 1e-7;
}

/// As `solve` does.
double second_order(const ShapedDevice& d, std::string& words) {
  const Configuration& c = d.at.configuration;
  theories::DeformedAnswers deformed{Geometry::second_order, {}, {}};
  for (const theories::Theory* theory : theories::all_theories()) {
    Said said = ask(*theory, c, d.random.load, Geometry::second_order, true);
    if (!said.finite || said.finite->apart || said.linear->apart || said.linear->rigid > 0) return 0;
    deformed.from_linear.push_back(
        theories::relative_difference(twist_in_mm(said.finite->displacement), twist_in_mm(said.linear->displacement)));
    const Vector6 room = said.linear->floating.most - said.linear->floating.least;
    if (room.allFinite())
      deformed.play =
          std::max(deformed.play, theories::relative_difference(twist_in_mm(said.finite->displacement + room),
                                                                twist_in_mm(said.finite->displacement)));
    deformed.answers.push_back(*said.finite);
  }
  try {
    theories::require_agreement_deformed(theories::all_theories(), deformed, c, "device");
  } catch (const NumericalError& e) {
    if (!apart_in_second_order(c, d.random.load)) words += std::string(" second order: ") + e.what();
  }
  return test::apart(deformed.answers[0].displacement, deformed.answers[1].displacement, c.size);
}

}  // namespace

ShapeJudgement judge_in_shape(const std::optional<ShapedDevice>& device) {
  ShapeJudgement out;
  if (!device) return out;
  Shaped s{*device};
  const bool jumps = s.jumps();
  for (std::size_t i = 0; i < 2; ++i) s.said[i] = ask(*theories::all_theories()[i], s.c, s.F, Geometry::finite, jumps);
  s.truth = solve_in_shape(s.c, s.F, device->share);
  out.kind = class_of(s.truth);
  if (out.kind == ShapeClass::equilibrium || out.kind == ShapeClass::singular)
    compare_with_truth(out, s), compare_stiffness(out, s);
  if (s.said[0].finite && s.said[1].finite)
    out.between = test::apart(s.said[0].finite->displacement, s.said[1].finite->displacement, s.c.size);
  out.outcome = outcome_of(out, s);
  std::string second;
  if (device->random.seed % 2 == 0 && out.kind == ShapeClass::equilibrium)
    out.second_order = second_order(*device, second);
  if (!second.empty()) out.outcome = Outcome::answered_wrongly;
  out.words = fmt::format(
      "errors {:.1e} of the closed form, {:.1e} of the MSA, {:.1e} of what is allowed, stiffness {:.1e} of what is "
      "allowed, theories "
      "{:.1e} apart, judge carried {:.3f} {} {}{}",
      out.closed_form, out.msa, out.of_allowed, out.compliance, out.between, s.truth.carried, s.said[0].refuses,
      s.said[1].refuses, second);
  return out;
}

ShapeJudgement judge_in_shape_apart(unsigned seed, bool laws) {
  struct Told {
    Outcome outcome;
    ShapeClass kind;
    double closed_form, msa, between, second_order, of_allowed, compliance;
  };
  const FromChild child = in_child([&] {
    const ShapeJudgement j = judge_in_shape(shaped_device(seed, laws));
    return bytes_of(
               Told{j.outcome, j.kind, j.closed_form, j.msa, j.between, j.second_order, j.of_allowed, j.compliance}) +
           j.words;
  });
  if (!child.died.empty()) return {Outcome::crashed, ShapeClass::agreement, 0, 0, 0, 0, 0, 0, 0, child.died};
  const auto t = from_bytes<Told>(child.told);
  return {t.outcome,      t.kind,       t.closed_form, t.msa, t.between,
          t.second_order, t.of_allowed, t.compliance,  0,     child.told.substr(sizeof t)};
}

std::string reproduction_in_shape(unsigned seed, bool laws, const ShapeJudgement& j) {
  const std::optional<ShapedDevice> d = shaped_device(seed, laws);
  if (!d) return fmt::format("device {}: {}", seed, j.words);
  const std::filesystem::path file = failures_folder() / fmt::format("shaped-{}{}.yaml", laws ? "laws-" : "", seed);
  std::ofstream(file) << write_mechanism(d->random.mechanism);
  Vector6 load = d->random.load;
  load.tail<3>() *= 1e3;
  std::string where = fmt::format("--pose={:.17g}", fmt::join(d->at.pose_mm_deg, ","));
  if (d->posed.size() > 0) {
    std::vector<std::string> q;
    for (const Actuator& a : d->at.configuration.actuators)
      q.push_back(fmt::format("{:.17g}", a.rotation ? a.value : 1e3 * a.value));
    where = fmt::format("--joints={}", fmt::join(q, ","));
  }
  return fmt::format("device {} ({}), {}: {}: {}\n  deflect solve {} {} --geometry finite --load={:.17g}", seed,
                     device_kind_names[static_cast<int>(d->random.kind)], shape_class_names[static_cast<int>(j.kind)],
                     outcome_names[static_cast<int>(j.outcome)], j.words, file.string(), where, fmt::join(load, ","));
}

}  // namespace deflect::attack
