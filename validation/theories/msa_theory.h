// Matrix structural analysis (msa/frame/) as a Theory. Legs are condensed once for all poses where the device allows it
// (msa_sweep.h); else the whole structure is solved at each pose.
//
// In finite geometry elements are halved until the estimated discretisation error is 1e-6 of the displacement, or
// elements have an eighth of their first length. The estimate is a third of the change by the last halving, because
// errors fall with the square of the length or faster. An error of more than 1e-4 is refused.
#pragma once

#include <memory>
#include <optional>

#include "msa/frame/mechanism/msa.h"
#include "msa/frame/mechanism/msa_sweep.h"
#include "validation/theories/theory.h"

namespace deflect::theories {

const Theory& msa_theory();

class MsaAt final : public TheoryAt {
 public:
  explicit MsaAt(const Configuration&, const TheoryOptions& = {});

  void move_to(const Configuration&) override;
  Answer answer(const Vector6& F_T_W, const Conditions& = {}) override;
  Prediction predict(const Vector6& F_T_W, const Conditions&) override;
  void expect_many(bool) override {}
  bool affine() const override { return false; }
  Assembled assembled() override;
  std::optional<Structure> structure() override;
  std::vector<std::string> notes() const override;

  /// The structure solved last, and its displacements by degree of freedom.
  const frame::MechanismModel& mechanism() { return model().mechanism(); }
  const VectorX& displacements() const { return last_.state.u; }

 private:
  /// Computed once for a linear structure.
  struct Stiffness {
    VectorX tangents;
    Matrix6 K = Matrix6::Zero();
    int rigid = 0;
    StiffnessChecks checks;
  };

  frame::MsaModel& model();
  frame::MsaSweep* sweep();
  Asked asked() const;
  void halve();
  void refine(const Vector6& F, const Conditions&);
  Answer deformed();
  const Stiffness& stiffness();
  Answer linear_answer(const Conditions&);

  const Configuration* configuration_;
  TheoryOptions options_;
  std::optional<frame::MsaSweep> sweep_;
  bool sweep_tried_ = false, sweep_here_ = false;    // whether making it was tried; whether it is at this pose
  std::vector<LegStiffness> legs_;                   // of the sweep
  frame::MemberDivision division_;                   // of model_
  std::unique_ptr<frame::MsaModel> model_, before_;  // before_: the model before the last halving, if any
  int halvings_ = 0;
  Eigen::Vector2d discretisation_ = Eigen::Vector2d::Zero();  // of last_
  frame::MsaSolution last_;
  std::optional<Stiffness> stiffness_;
  std::optional<AtRest> rest_;
};

}  // namespace deflect::theories
