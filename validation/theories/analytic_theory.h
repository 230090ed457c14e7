// The closed form (analytic/) as a Theory. Condensed once for all poses where the device allows it (pose_sweep.h).
// Where its laws allow, displacements are affine in load and temperature; else each load is solved anew.
#pragma once

#include <optional>

#include "analytic/model.h"
#include "analytic/pose_sweep.h"
#include "validation/theories/theory.h"

namespace deflect::theories {

const Theory& analytic_theory();

class AnalyticAt final : public TheoryAt {
 public:
  explicit AnalyticAt(const Configuration&, const TheoryOptions& = {});

  void move_to(const Configuration&) override;
  Answer answer(const Vector6& F_T_W, const Conditions& = {}) override;
  Prediction predict(const Vector6& F_T_W, const Conditions&) override;
  void expect_many(bool warmer_or_colder) override;
  bool affine() const override { return affine_.has_value(); }
  Assembled assembled() override;

  const analytic::AnalyticModel& model();

 private:
  struct Affine {
    Vector6 rest, per_kelvin = Vector6::Zero();
    Matrix6 C;
    bool converged = true;
    std::vector<Vector6> inside_rest, inside_per_kelvin;  ///< by TheoryOptions::inside
    std::vector<Matrix6> inside_C;
  };

  analytic::PoseSweep* sweep();
  std::vector<Vector6> inside_affine(const Vector6& F_T_W, double warmer) const;
  double energy_at_rest();
  double energy_by_turning(const Vector6& F_T_W, double energy, const Conditions&) const;
  Asked asked() const;
  std::vector<std::string> floating(const analytic::AnalyticSolution&);
  Answer linear_answer(const analytic::AnalyticSolution&, const Vector6& load, const Conditions&);

  const Configuration* configuration_;
  TheoryOptions options_;
  std::optional<analytic::PoseSweep> sweep_;       // made on first use
  bool sweep_tried_ = false, sweep_here_ = false;  // whether making it was tried; whether it is at this pose
  std::vector<LegStiffness> legs_;                 // of the sweep
  std::optional<analytic::AnalyticModel> model_;   // of this pose
  std::optional<double> energy_at_rest_;           // of the assembled mechanism, whose legs may be strained
  std::optional<AtRest> rest_;
  std::optional<Affine> affine_;
};

}  // namespace deflect::theories
