// Matrix structural analysis (msa/frame/) as a theory: legs condensed once for all poses where the device allows it
// (msa_sweep.h), else the whole structure at each pose.
//
// In the finite shape elements are halved until what that changes, over 3 (errors fall with the square of the length or
// faster), is 1e-6 of the displacement or an element is an eighth of what was given. More than 1e-4 is refused.
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

  /// The structure that was last solved, and its displacements by freedom.
  const frame::MechanismModel& mechanism() { return model().mechanism(); }
  const VectorX& displacements() const { return last_.state.u; }

 private:
  /// Of one linear structure, which needs it once.
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
  bool sweep_tried_ = false, sweep_here_ = false;    // whether it was made; whether it stands at this pose
  std::vector<LegStiffness> legs_;                   // of the sweep
  frame::MemberDivision division_;                   // of model_
  std::unique_ptr<frame::MsaModel> model_, before_;  // before_: as it was before the last of the halvings, if any
  int halvings_ = 0;
  Eigen::Vector2d discretisation_ = Eigen::Vector2d::Zero();  // of last_
  frame::MsaSolution last_;
  std::optional<Stiffness> stiffness_;
  std::optional<AtRest> rest_;
};

}  // namespace deflect::theories
