#include "validation/studies/sweep.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "msa/base/error.h"
#include "msa/base/outcome.h"
#include "msa/mechanism/stand.h"
#include "validation/theories/agreement.h"

namespace deflect::studies {
namespace {

Vector6 row_of(std::span<const double> rows, std::size_t i) {
  return Eigen::Map<const Vector6>(rows.subspan(6 * i, 6).data());
}

void require_rows(const ManyPoses& in) {
  const std::size_t n = in.poses_mm_deg.size() / 6;
  if (in.poses_mm_deg.size() != 6 * n)
    throw InputError(fmt::format("poses: {} numbers, no multiple of six", in.poses_mm_deg.size()));
  if (in.loads_N_Nmm.size() != 6 && in.loads_N_Nmm.size() != 6 * n)
    throw InputError(fmt::format("loads: {} rows for {} poses: give one row for all, or one for each pose",
                                 in.loads_N_Nmm.size() / 6, n));
  const auto require_finite = [](const char* what, std::span<const double> rows) {
    const auto bad = std::find_if(rows.begin(), rows.end(), [](double x) { return !std::isfinite(x); });
    if (bad != rows.end())
      throw InputError(fmt::format("{}, row {}: {} is no finite number", what, (bad - rows.begin()) / 6, *bad));
  };
  require_finite("poses", in.poses_mm_deg);
  require_finite("loads", in.loads_N_Nmm);
}

void write(const ManyAnswers& out, std::size_t i, const Vector6& displacement_mm, const Matrix6& K_mm) {
  using Rows = Eigen::Matrix<double, 6, 6, Eigen::RowMajor>;
  if (!out.displacement_mm_rad.empty())
    Eigen::Map<Vector6>(out.displacement_mm_rad.subspan(6 * i, 6).data()) = displacement_mm;
  if (!out.stiffness_mm.empty()) Eigen::Map<Rows>(out.stiffness_mm.subspan(36 * i, 36).data()) = K_mm;
}

}  // namespace

const Configuration& Sweep::at(const Vector6& pose_mm_deg) {
  moved_ = false;
  here_ = &posing_.at(pose_from(pose_mm_deg));
  return *here_;
}

theories::Answer Sweep::answer(std::size_t theory, const Vector6& F_T_W) {
  if (!std::exchange(moved_, true)) {
    for (const auto& each : at_) each->move_to(*here_);
    if (at_.empty())
      for (const theories::Theory* each : asked_)
        at_.push_back(each->at(*here_, {.device = device_->name, .condense = true}));
  }
  return at_[theory]->answer(F_T_W);
}

void solve_many(const Mechanism& m, const ManyPoses& in, const theories::Theories& theories,
                std::span<const ManyAnswers> out, const parallel::Work& work) {
  require_rows(in);
  const std::size_t n = in.poses_mm_deg.size() / 6, chunk = std::clamp<std::size_t>(n / 64, 16, 1024);
  const bool one_load = in.loads_N_Nmm.size() == 6;
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  const auto one = [&](Sweep& sweep, std::vector<theories::Answer>& answers, std::size_t i) {
    const auto stands = outcome_of<ModelError>([&] { return &sweep.at(row_of(in.poses_mm_deg, i)); });
    if (!stands) {
      if (!in.keep_unreachable) throw ModelError(fmt::format("pose {}: {}", i, stands.why), stands.cause);
      for (const ManyAnswers& each : out) write(each, i, Vector6::Constant(nan), Matrix6::Constant(nan));
      return;
    }
    const Vector6 load = wrench_from_mm(row_of(in.loads_N_Nmm, one_load ? 0 : i));
    answers.clear();
    for (std::size_t t = 0; t < theories.size(); ++t) answers.push_back(sweep.answer(t, load));
    theories::require_agreement(theories, answers, load, **stands, m.name);
    for (std::size_t t = 0; t < theories.size(); ++t)
      write(out[t], i, twist_in_mm(answers[t].displacement), stiffness_in_mm(answers[t].stiffness));
  };
  const auto told = [&](std::size_t done) {
    work.progress(static_cast<double>(std::min(n, done * chunk)) / static_cast<double>(n));
  };
  parallel::for_each_case((n + chunk - 1) / chunk, 1, work.threads,
                          [&](std::size_t k) {
                            Sweep sweep(m, theories);
                            std::vector<theories::Answer> answers;
                            for (std::size_t i = k * chunk; i < std::min(n, (k + 1) * chunk); ++i)
                              one(sweep, answers, i);
                          },
                          work.progress ? std::function<void(std::size_t)>(told) : nullptr);
}

}  // namespace deflect::studies
