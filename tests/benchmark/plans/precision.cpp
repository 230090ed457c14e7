#include "tests/benchmark/plans/precision.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <cmath>

#include "msa/base/index.h"
#include "msa/mechanism/device_file.h"
#include "tests/support/paths.h"
#include "validation/measurement/random.h"
#include "validation/plan/campaign_aims.h"
#include "validation/plan/foresight.h"
#include "validation/prediction/campaign.h"

namespace deflect::benchmark {
namespace {

using measurement::Measurements;

constexpr std::size_t looked_at = 150;  // blocks among which observability indices choose

plan::Observability indices(const MatrixX& covariance) {
  const MatrixX one = MatrixX::Identity(covariance.rows(), covariance.cols());
  return plan::observability(Eigen::LLT<MatrixX>(covariance).solve(one), 1);
}

/// So many of the blocks, by lot: eigenvalues at every look at each of all of them would take hours.
std::vector<plan::Block> some_of(std::vector<plan::Block> blocks, std::size_t most) {
  measurement::Random random(3);
  for (std::size_t i = 0; i < std::min(most, blocks.size()); ++i) {
    const double at = random.uniform(static_cast<double>(i), static_cast<double>(blocks.size()));
    std::swap(blocks[i], blocks[std::min(blocks.size() - 1, as_size(std::lround(std::floor(at))))]);
  }
  blocks.resize(std::min(most, blocks.size()));
  return blocks;
}

/// O1 … O5 or ln |information|, priors counted in.
class IndexAim final : public plan::Aim {
 public:
  IndexAim(const plan::Prospect& p, int index)
      : prospect_(&p), index_(index), design_(p.design(none(), none(), VectorX(0))) {
    value_ = of(design_);
  }
  double value() const override { return value_; }
  double with(std::size_t block) const override {
    if (index_ == 0) return value_ + design_.log_determinant(rows(block));
    plan::Design next = design_;
    next.take(rows(block));
    return of(next);
  }
  void take(std::size_t block) override {
    value_ = with(block);
    design_.take(rows(block));
  }
  void drop(std::size_t block) override {
    design_.drop(rows(block));
    value_ = index_ == 0 ? value_ - design_.log_determinant(rows(block)) : of(design_);
  }
  std::unique_ptr<Aim> copy() const override { return std::make_unique<IndexAim>(*this); }

 private:
  MatrixX none() const { return MatrixX(prospect_->numbers(), 0); }
  plan::WhiteRows rows(std::size_t block) const { return prospect_->rows(block, none(), none()); }
  double of(const plan::Design& d) const { return index_ == 0 ? 0 : indices(d.covariance()).O[as_size(index_ - 1)]; }

  const plan::Prospect* prospect_;
  int index_;  // 0: D
  plan::Design design_;
  double value_ = 0;
};

plan::Possible as_taken(const Measurements& data) {
  plan::Possible out;
  out.all = data;
  out.taken = data.readings.size();
  return out;
}

}  // namespace

std::string precision_table(const std::string& device, double force, std::optional<double> moment, int threads) {
  const subject::Subject s = read_mechanism(test::source_dir() + "/validation/devices/" + device + ".yaml");
  const Measurements paper = prediction::campaign("paper", *s.machine(), force, 1);
  plan::ForesightOptions o;
  o.limits.moment = moment;
  const parallel::Work work{threads};
  Measurements use = prediction::campaign("random", *s.machine(), force, 77);
  const Measurements data = plan::filled_in(s, paper, o, true);
  plan::Possible possible = plan::possible_campaign(s, data, o.limits, 1);
  possible.all.readings = plan::filled_in(s, possible.all, o, true).readings;
  plan::Possible fewer = possible;
  fewer.blocks = some_of(std::move(fewer.blocks), looked_at);
  const plan::Prospect prospect(s, std::move(possible), {o.sigma_u, {}}, work),
      some(s, std::move(fewer), {o.sigma_u, {}}, work);
  const MatrixX V = plan::sensitivity_in_use(s, use, prospect.names(), o, work);
  const auto row = [&](const std::string& name, const Measurements& readings) {
    const plan::Prospect taken(s, as_taken(plan::filled_in(s, readings, o, true)), {o.sigma_u, {}}, work);
    const MatrixX nothing(taken.numbers(), 0);
    const MatrixX P = taken.design(nothing, nothing, VectorX(0)).covariance();
    const plan::Observability index = indices(P);
    std::string out = fmt::format("| {} | {} | {} | {:.4f} |", name, readings.readings.size(), readings.poses.size(),
                                  1e6 * plan::test_pose_error(P, V));
    for (const double each : index.O) out += fmt::format(" {:.3g} |", each);
    return out + fmt::format(" {:.1f} |\n", index.D_gain);
  };
  std::string out = fmt::format(
      "{}, {} tolerances; before any reading {:.3f} µm rms in use\n\n| campaign | readings | poses | µm rms in use, "
      "fitted | O1 | O2 | O3 | O4 | O5 | ½ ln det |\n|---|---|---|---|---|---|---|---|---|---|\n",
      device, prospect.names().size(), 1e6 * plan::test_pose_error(MatrixX::Identity(V.cols(), V.cols()), V));
  out += row("the paper's nine points", paper);
  const auto chosen = [&](const std::string& name, const plan::Prospect& among, const plan::Aim& aim) {
    const std::vector<plan::Block>& blocks = among.possible().blocks;
    const plan::Choice choice = plan::choose(aim, blocks, {paper.readings.size(), paper.poses.size(), true, {}}, work);
    out += row(fmt::format("{}, of {} readings", name, blocks.size()), plan::as_plan(among.possible(), choice.blocks));
    fmt::print(stderr, "{}", out.substr(out.rfind('\n', out.size() - 2) + 1));
  };
  chosen("test-pose criterion (--aim precision)", prospect, plan::PrecisionAim(prospect, V));
  chosen("D-optimal", prospect, IndexAim(prospect, 0));
  chosen("test-pose criterion", some, plan::PrecisionAim(some, V));
  const char* names[] = {"D-optimal", "O1", "O2", "O3", "O4", "O5"};
  for (int index = 0; index < 6; ++index) chosen(names[index], some, IndexAim(some, index));
  return out;
}

}  // namespace deflect::benchmark
