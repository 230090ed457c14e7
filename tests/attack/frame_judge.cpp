#include "tests/attack/frame_judge.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>

#include "msa/base/error.h"
#include "msa/frame/file/frame_analysis.h"
#include "msa/frame/file/frame_file.h"
#include "tests/attack/count.h"
#include "tests/attack/frame_forms.h"

namespace deflect::attack {
namespace {

constexpr double rounding = 32 * std::numeric_limits<double>::epsilon();

/// A note that digits are lost.
bool warns(const std::string& note) { return note.find("digit") != note.npos || note.find("condition") != note.npos; }

/// Forces at the members' ends, moments over `size`, relative to the largest of all members.
double force_difference(const std::vector<Vector6>& left, const std::vector<Vector6>& right, double size) {
  double difference = 0, largest = 0;
  for (std::size_t i = 0; i < right.size(); ++i) {
    Vector6 weight = Vector6::Ones();
    weight.tail<3>().setConstant(1 / size);
    difference = std::max(difference, (left[i] - right[i]).cwiseProduct(weight).norm());
    largest = std::max(largest, right[i].cwiseProduct(weight).norm());
  }
  return largest > 0 ? difference / largest : difference;
}

/// As the ideal frame has them.
void compare(Judgement& out, const frame::FrameResult& result, const DenseSolution& right, const RandomFrame& random,
             const StandingVerdict& verdict) {
  const double unit = random.unit, size = extent(random.ideal);
  for (std::size_t c = 0; c < right.cases.size(); ++c) {
    std::vector<Vector6> u = result.cases[c].displacements, q;
    for (Vector6& d : u) d.head<3>() /= unit;
    for (const frame::MemberForces& m : result.cases[c].members) {
      q.push_back(m.end / (unit * unit));
      q.back().tail<3>() /= unit;
    }
    std::vector<Vector6> expected = right.cases[c].displacements;
    expected.resize(u.size());  // without the oracle's own nodes
    out.error = std::max(out.error, field_difference(u, expected, size, verdict.turns, 1e-6 * right.largest_response));
    double loads = 0;
    for (const auto& [node, w] : random.ideal.loads[c].second.nodes) loads = std::max(loads, w.norm());
    std::vector<Vector6> ends = right.cases[c].ends;
    ends.push_back(Vector6::Constant(loads)), q.push_back(Vector6::Constant(loads));
    out.force_error = std::max(out.force_error, force_difference(q, ends, size));
  }
}

}  // namespace

bool tells_of_holding(const std::vector<std::string>& notes) {
  return std::any_of(notes.begin(), notes.end(),
                     [](const std::string& note) { return note.find("held") != note.npos; });
}

double allowed_error(double condition, bool warned) {
  return std::min(1e-12 + rounding * condition, warned ? 1e-1 : 1e-6);
}

bool digits_left(double condition) { return rounding * condition < 1e-3; }

double field_difference(const std::vector<Vector6>& left, const std::vector<Vector6>& right, double size,
                        const std::vector<bool>& turns, double least) {
  double difference = 0, largest = least;
  for (std::size_t i = 0; i < right.size(); ++i) {
    const Vector6 d = left[i] - right[i];
    const bool whole = !turns[i];
    difference = std::max({difference, d.head<3>().norm(), whole ? size * d.tail<3>().norm() : 0});
    largest = std::max({largest, right[i].head<3>().norm(), whole ? size * right[i].tail<3>().norm() : 0});
    if (!left[i].allFinite()) return std::numeric_limits<double>::infinity();
  }
  return largest > 0 ? difference / largest : difference;
}

Judgement judge(const RandomFrame& random) {
  Judgement out;
  const StandingVerdict verdict = can_stand(random.ideal);
  out.standing = verdict.standing;
  const bool stands = verdict.standing == Standing::stands || verdict.standing == Standing::idle;
  DenseSolution right;
  if (stands) {
    right = solve_dense(random.ideal, verdict.to_hold);
    out.condition = right.condition;
    out.largest_response = right.largest_response;
  }
  const bool digits = random.kind != FrameKind::nearly_singular || digits_left(out.condition);
  try {
    const frame::FrameResult result = frame::analyse(scaled(random.words(), random.unit));
    out.warned = std::any_of(result.notes.begin(), result.notes.end(), warns);
    out.words = frame::failed_check(result);
    if (!stands) {
      out.outcome = out.words.empty() ? Outcome::answered_wrongly : Outcome::refused_rightly;
      out.words += fmt::format(" [{} motions without strain]", verdict.motions);
      return out;
    }
    compare(out, result, right, random, verdict);
    const double worst = std::max(out.error, out.force_error), allowed = allowed_error(out.condition, out.warned);
    if (!out.words.empty())
      out.outcome = digits ? Outcome::refused_wrongly : Outcome::digits_gone;
    else if (!(worst <= allowed) || (verdict.standing == Standing::idle && !tells_of_holding(result.notes)))
      out.outcome = Outcome::answered_wrongly;
    out.words += fmt::format(" error {:.1e}, of forces {:.1e}, condition {:.1e}{}", out.error, out.force_error,
                             out.condition, result.notes.empty() ? "" : ", noted: " + result.notes.front());
  } catch (const ModelError& e) {
    out.words = e.what();
    out.outcome = !stands ? Outcome::refused_rightly : digits ? Outcome::refused_wrongly : Outcome::digits_gone;
  } catch (const NumericalError& e) {
    out.words = e.what();
    out.outcome = !stands ? Outcome::refused_rightly : digits ? Outcome::refused_wrongly : Outcome::digits_gone;
  } catch (const std::exception& e) {
    out.words = e.what();
    out.outcome = Outcome::crashed;
  }
  return out;
}

std::string reproduction(const RandomFrame& random, const Judgement& j) {
  const std::filesystem::path file = failures_folder() / fmt::format("frame-{}.yaml", random.seed);
  std::ofstream(file) << frame::write_frame(scaled(random.words(), random.unit));
  return fmt::format("seed {} ({}), which {}: {}: {}\n  deflect frame {}", random.seed,
                     frame_kind_names[static_cast<int>(random.kind)], standing_names[static_cast<int>(j.standing)],
                     outcome_names[static_cast<int>(j.outcome)], j.words, file.string());
}

}  // namespace deflect::attack
