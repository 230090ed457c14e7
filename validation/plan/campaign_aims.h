// Aims of a whole campaign (foresight.h).
#pragma once

#include "validation/plan/choice.h"
#include "validation/plan/prospect.h"

namespace deflect::plan {

/// Effects apart from tolerances and from each other. Targets: the change that each makes, columns, whitened by noise
/// (Prospect::white). The prospect must outlive it.
class EffectsAim final : public Aim {
 public:
  EffectsAim(const Prospect&, MatrixX targets);
  double value() const override { return value_; }
  double with(std::size_t block) const override;
  void take(std::size_t block) override;
  void drop(std::size_t block) override;
  std::unique_ptr<Aim> copy() const override { return std::make_unique<EffectsAim>(*this); }
  /// To first order in what a block changes of Q.
  double promise(std::size_t block) const override { return estimated(block, false); }
  double loss(std::size_t block) const override { return estimated(block, true); }

 private:
  double soft_least(const MatrixX& Q) const;
  WhiteRows rows(std::size_t block) const;
  double estimated(std::size_t block, bool taken) const;
  void update();

  const Prospect* prospect_;
  std::shared_ptr<const MatrixX> targets_;
  Design design_;
  std::vector<std::pair<Eigen::Index, Eigen::Index>> pairs_;  // the first beside the second
  double value_ = 0;
  MatrixX slope_;  // of the value by Q
};

/// Minus the mean square error of readings in use, V over the tolerances (sensitivity_in_use), once the tolerances are
/// fitted; m².
class PrecisionAim final : public Aim {
 public:
  PrecisionAim(const Prospect&, MatrixX V);
  double value() const override { return value_; }
  double with(std::size_t block) const override;
  void take(std::size_t block) override;
  void drop(std::size_t block) override;
  std::unique_ptr<Aim> copy() const override { return std::make_unique<PrecisionAim>(*this); }
  double loss(std::size_t block) const override;

 private:
  WhiteRows rows(std::size_t block) const;

  const Prospect* prospect_;
  std::shared_ptr<const MatrixX> V_;
  Design design_;
  double value_ = 0;
};

}  // namespace deflect::plan
