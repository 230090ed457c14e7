#include "tests/attack/device_judge.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <limits>
#include <optional>

#include "analytic/model.h"
#include "msa/base/error.h"
#include "msa/frame/mechanism/msa.h"
#include "msa/mechanism/device_file.h"
#include "tests/attack/count.h"
#include "tests/support/apart.h"
#include "tests/support/sanitizers.h"
#include "tests/support/theories.h"
#include "validation/studies/solve.h"

namespace deflect::attack {
namespace {

using namespace studies;

DeviceClass class_of(const DeviceTruth& truth) {
  if (!truth.clear) return DeviceClass::unclear;
  if (!truth.held) return DeviceClass::moves;
  if (truth.rigid_directions == 6) return DeviceClass::rigid;
  if (truth.rigid_directions > 0) return DeviceClass::partly_rigid;
  return truth.idle > 0 ? DeviceClass::idle : DeviceClass::stands;
}

bool must_answer(DeviceClass c) { return c == DeviceClass::stands || c == DeviceClass::idle; }
bool may_answer(DeviceClass c) { return must_answer(c) || c == DeviceClass::partly_rigid || c == DeviceClass::unclear; }

Vector6 in_m(Vector6 mm_rad) {
  mm_rad.head<3>() /= 1e3;
  return mm_rad;
}

/// Relative; where the right displacement is zero, to what the load could make of the softest direction. Of that the
/// directions of axes, rounded, leave a part of about 1e-16, which is no error.
double displacement_error(const Vector6& d, const Vector6& right, const Matrix6& D, const Vector6& load, double size) {
  Vector6 w = Vector6::Ones();
  w.tail<3>().setConstant(size);
  const Matrix6 weighed = w.asDiagonal() * D * w.asDiagonal();
  const double least = 1e-6 * weighed.norm() * load.cwiseQuotient(w).norm();
  const double rounding = 8 * std::numeric_limits<double>::epsilon() * 1e6 * least;
  const double difference = std::max(0.0, w.cwiseProduct(d - right).norm() - rounding),
               length = std::max(w.cwiseProduct(right).norm(), least);
  return difference == 0 ? 0 : difference / length;
}

/// To how much of its size the program says that the answer is known; 0 where it says nothing.
double known_to(const std::vector<std::string>& notes) {
  const std::string words = "the answer is known to about ";
  for (const std::string& note : notes)
    if (const auto at = note.find(words); at != note.npos) return std::stod(note.substr(at + words.size()));
  return 0;
}

void compare(DeviceJudgement& out, const SolveResult& r, const DeviceTruth& truth, const RandomDevice& random,
             double size) {
  const Vector6 right = truth.flexibility * random.load;
  for (const TheorySolution* theory : {&test::analytic(r), &test::msa(r)}) {
    const double error =
        displacement_error(in_m(theory->displacement_mm_rad), right, truth.flexibility, random.load, size);
    out.error = std::isfinite(error) ? std::max(out.error, error) : 1e300;
    if (out.kind == DeviceClass::partly_rigid) continue;
    const Matrix6 K = stiffness_from_mm(theory->stiffness_mm);
    out.stiffness_error = std::max(out.stiffness_error, test::apart(K, truth.stiffness, size));
  }
  out.displacement = in_m(test::msa(r).displacement_mm_rad);
  out.between = test::apart(in_m(test::analytic(r).displacement_mm_rad), out.displacement, size);
}

/// Where the program refuses because theories differ or fail a check: how far each is off.
std::string by_theory(const Configuration& c, const Vector6& F, const DeviceTruth& truth) {
  if (!truth.held || truth.rigid_directions > 0) return "";
  const Vector6 right = truth.flexibility * F;
  const auto off = [&](const char* name, const Vector6& d, const Matrix6& K) {
    return fmt::format(" [{}: displacement {:.1e}, stiffness {:.1e} off]", name, test::apart(d, right, c.size),
                       test::apart(K, truth.stiffness, c.size));
  };
  std::string out;
  try {
    const analytic::AnalyticModel analytic(c);
    const analytic::AnalyticSolution a = analytic.solve(F);
    out += off("closed form", a.displacement, analytic.stiffness(a));
  } catch (const std::runtime_error&) {  // said by the program already
  }
  try {
    frame::MsaModel msa(c);
    const frame::MsaSolution m = msa.solve(F);
    out += off("MSA", m.displacement, msa.stiffness(m.state).K);
  } catch (const std::runtime_error&) {
  }
  return out;
}

void refused(DeviceJudgement& out, const std::string& words, bool by_model) {
  out.words = words;
  if (out.kind == DeviceClass::unclear || (!must_answer(out.kind) && by_model))
    out.outcome = Outcome::refused_rightly;
  else
    out.outcome = Outcome::refused_wrongly;
}

/// What can be sent as bytes.
struct Sent {
  Outcome outcome;
  DeviceClass kind;
  double condition, error, stiffness_error, between;
  std::array<double, 6> displacement;
};

Sent without_words(const DeviceJudgement& j) {
  Sent s{j.outcome, j.kind, j.condition, j.error, j.stiffness_error, j.between, {}};
  std::copy(j.displacement.begin(), j.displacement.end(), s.displacement.begin());
  return s;
}

DeviceJudgement with_words(const std::string& bytes) {
  const auto s = from_bytes<Sent>(bytes);
  DeviceJudgement j{s.outcome, s.kind, s.condition, s.error, s.stiffness_error, s.between, {}, bytes.substr(sizeof s)};
  std::copy(s.displacement.begin(), s.displacement.end(), j.displacement.begin());
  return j;
}

}  // namespace

DeviceJudgement judge(const RandomDevice& random) {
  DeviceJudgement out;
  std::optional<Stand> placed;
  DeviceTruth truth;
  try {
    const Stand& at = placed.emplace(stand(random.mechanism, mm_deg_from(home_pose(random.mechanism))));
    truth = solve_by_forces(at.configuration);
    out.kind = class_of(truth);
    out.condition = truth.condition;
    Vector6 load = random.load;
    load.tail<3>() *= 1e3;
    const SolveResult r = solve(random.mechanism, at, load, {});
    if (!may_answer(out.kind)) {
      out.outcome = Outcome::answered_wrongly;
      out.words = fmt::format("idle {}, rigid directions {}", truth.idle, truth.rigid_directions);
      return out;
    }
    if (out.kind == DeviceClass::unclear) return out;
    compare(out, r, truth, random, at.configuration.size);
    const double allowed = std::max(allowed_error(out.condition, false), known_to(r.notes));
    if (!(out.error <= allowed && out.stiffness_error <= 1e-9 + 10 * allowed)) out.outcome = Outcome::answered_wrongly;
    if (out.kind == DeviceClass::idle && !tells_of_holding(r.notes)) out.outcome = Outcome::answered_wrongly;
    out.words = fmt::format("displacement {:.1e}, stiffness {:.1e}, theories {:.1e} off, condition {:.1e}, {}",
                            out.error, out.stiffness_error, out.between, out.condition, r.notes);
  } catch (const ModelError& e) {
    refused(out, e.what(), true);
  } catch (const NumericalError& e) {
    refused(out, e.what() + by_theory(placed->configuration, random.load, truth), false);
  } catch (const std::exception& e) {
    out.words = e.what();
    out.outcome = Outcome::crashed;
  }
  return out;
}

DeviceJudgement judge_agreement(const RandomDevice& random) {
  DeviceJudgement out;
  out.kind = DeviceClass::unclear;
  try {
    const Stand at = stand(random.mechanism, mm_deg_from(home_pose(random.mechanism)));
    Vector6 load = random.load;
    load.tail<3>() *= 1e3;
    const SolveResult r = solve(random.mechanism, at, load, {});
    out.between =
        test::apart(in_m(test::analytic(r).displacement_mm_rad), in_m(test::msa(r).displacement_mm_rad), random.unit);
    if (!(out.between <= std::max(1e-6, known_to(r.notes)))) out.outcome = Outcome::answered_wrongly;
    out.words = fmt::format("theories {:.1e} apart", out.between);
  } catch (const ModelError& e) {
    out.outcome = Outcome::refused_rightly;
    out.words = e.what();
  } catch (const NumericalError& e) {
    out.words = e.what();
    out.outcome = Outcome::refused_rightly;
    for (const char* excuse : {"did not converge", "not solved", "fails a check"})
      if (out.words.find(excuse) != std::string::npos) out.outcome = Outcome::refused_wrongly;
  } catch (const std::exception& e) {
    out.words = e.what();
    out.outcome = Outcome::crashed;
  }
  return out;
}

FromChild in_child(const std::function<std::string()>& tell) {
  std::array<int, 2> ends{};
  if (::pipe(ends.data()) != 0) throw std::runtime_error("no pipe");
  const pid_t child = ::fork();
  if (child == 0) {
    constexpr rlim_t most = 20 * test::times_slower;  // seconds of the processor, whatever else runs
    const rlimit seconds{most, most};
    ::setrlimit(RLIMIT_CPU, &seconds);
    ::alarm(600 * test::times_slower);
    const std::string told = tell();
    ::_exit(::write(ends[1], told.data(), told.size()) == std::ssize(told) ? 0 : 1);
  }
  ::close(ends[1]);
  FromChild out;
  std::array<char, 4096> buffer;
  for (ssize_t n; (n = ::read(ends[0], buffer.data(), buffer.size())) > 0;)
    out.told.append(buffer.data(), static_cast<std::size_t>(n));
  ::close(ends[0]);
  int status = 0;
  ::waitpid(child, &status, 0);
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
    out.died = WIFSIGNALED(status) ? fmt::format("signal {}", WTERMSIG(status)) : "no answer";
  return out;
}

DeviceJudgement judge_apart(const RandomDevice& random, DeviceJudgement (*how)(const RandomDevice&)) {
  const FromChild child = in_child([&] {
    const DeviceJudgement j = how(random);
    return bytes_of(without_words(j)) + j.words;
  });
  if (child.died.empty()) return with_words(child.told);
  DeviceJudgement out;
  out.outcome = Outcome::crashed;
  out.words = child.died;
  return out;
}

std::string reproduction(const RandomDevice& random, const DeviceJudgement& j) {
  const std::filesystem::path file = failures_folder() / fmt::format("device-{}.yaml", random.seed);
  std::ofstream(file) << write_mechanism(random.mechanism);
  Vector6 load = random.load;
  load.tail<3>() *= 1e3;
  return fmt::format("device {} ({}), which {}: {}: {}\n  deflect solve {} --pose={:.17g} --load={:.17g}", random.seed,
                     device_kind_names[static_cast<int>(random.kind)], device_class_names[static_cast<int>(j.kind)],
                     outcome_names[static_cast<int>(j.outcome)], j.words, file.string(),
                     fmt::join(mm_deg_from(home_pose(random.mechanism)), ","), fmt::join(load, ","));
}

}  // namespace deflect::attack
