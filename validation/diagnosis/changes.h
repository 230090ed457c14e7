// What an effect changes in the residual, before any weighing.
//
// Laws in series at places: their small effect on the readings follows from the forces at the place by statics
// (Transmissions), without a prediction for each law. Readings whose load leaves play open are predicted: an eighth of
// them, and the others where those show it. Of play in one leg they count as in the middle of it. All readings are
// predicted with any other effect.
#pragma once

#include <array>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "validation/diagnosis/observations.h"
#include "validation/effects/with_effect.h"

namespace deflect::diagnosis {

struct Change {
  /// Measured numbers × directions, in the unit of the number. Of an effect whose parameters are all amplitudes: what
  /// it does with each alone, or at several values together. Of a shaped effect: what it does in each of a few shapes.
  /// The first column is at the start values, or they are the sum of all (summed).
  MatrixX columns;
  bool shaped = false;
  bool summed = false;
};

/// Curves of deflection over force f. Contacts, play, springs that harden or soften and one-sided laws are close to
/// sums of powers; a measured curve, with a knee anywhere, is a broken line.
enum class Curves {
  powers,        ///< |f|^p and sign(f)|f|^p, p = 0 (a step, as of play), ½, 1 and 2
  broken_lines,  ///< sign(f), f, and in each sense a bend at six sizes of f between which as many readings lie
  finer_lines    ///< at 60 sizes; fewer where less than ten forces would lie between them, none at six or less
};
inline constexpr std::array curves_tried_first = {Curves::powers, Curves::broken_lines};
inline constexpr std::array all_curves = {Curves::powers, Curves::broken_lines, Curves::finer_lines};

class Changes {
 public:
  /// Statics tells those of the effects that are laws in series with one parameter, at places where it agrees with a
  /// prediction. This is checked for one law at each place on the readings of the first pose, to 1 %.
  Changes(const Observations&, const std::vector<effects::PlacedEffect>&, int threads);

  /// What may happen at a place whether or not a law describes it: columns. At a load of a frame a force along and a
  /// moment about each axis, at each node that it acts on, or, at more than four, at all of them; at a load of a
  /// machine another point, another direction, and another size of each of its components; at a member of a frame an
  /// elongation that grows with the force that passes, one that grows in both senses of it, and a step where it turns,
  /// which a gauge on the member itself does not read; at a member end, a spring or a support the same of each freedom.
  /// At a member of a machine, of every leg or of one: sections that stretch, twist and bend more about each of their
  /// axes, all along it. None at other places.
  MatrixX by_whatever(const subject::Place&, std::optional<int> leg) const;
  /// Whether it is known which forces pass there and what a deflection changes: in a machine by statics, in a frame
  /// whose laws are linear at members, member ends, springs and supports.
  bool knows_forces_at(const subject::Place&) const;
  /// Any curve of deflection δ over force f, in each freedom of the effect's place, and in a group at each part.
  /// Columns of the size of a motion of 1 mm; none where the forces are not known.
  MatrixX by_any_curve(const effects::PlacedEffect&, Curves) const;
  using Curve = subject::Transmissions::Curve;
  /// Whether it is known what a force does that holds the place, which remembers: the place has one freedom, of a joint
  /// of a machine or of a node of a frame, that is not rigid, and the readings have a sequence.
  bool may_be_held(const subject::Place&) const;
  /// What such a force changes, up to a factor. `at_rest` makes one for each leg and pose: called in the sequence of
  /// the readings with the motion, up to a factor, it tells the force.
  std::optional<VectorX> by_holding(const subject::Place&, std::optional<int> leg,
                                    const std::function<Curve()>& at_rest) const;
  /// Of a frame whose readings have a sequence.
  const std::vector<subject::NodeMotion>& node_motions() const { return node_motions_; }
  /// At the start values; nullopt where it has to be predicted.
  std::optional<VectorX> by_statics(const effects::PlacedEffect&) const;
  /// Of any of these effects. Throws where the subject does not stand with it.
  Change by(const effects::PlacedEffect&) const;

 private:
  std::optional<subject::Transmissions::Change> by_force(const effects::PlacedEffect&, const VectorX& values,
                                                         const measurement::Measurements&) const;
  MatrixX by_any_load(const frame::LoadCase&, const std::string& name) const;
  MatrixX by_any_load_of_a_machine(const subject::Place&) const;
  MatrixX by_any_elongation(const subject::Place&) const;
  MatrixX by_any_section(const subject::Place&, std::optional<int> leg) const;
  bool is_known_by_statics(const subject::Place&) const;
  std::vector<const subject::InnerSite*> sites_at(const subject::Place&) const;  // of each part
  std::optional<VectorX> by_curve(const effects::PlacedEffect&, const Curve&) const;
  const subject::NodeMotion* node_motion(const subject::Place&) const;
  bool agrees(const effects::PlacedEffect&) const;
  bool moved_by_play(const effects::EffectInstance&, const std::vector<bool>& readings, VectorX& change) const;
  bool are_seen(const VectorX&) const;
  Change predicted(const effects::PlacedEffect&) const;

  const Observations observations_;
  VectorX null_;  ///< Observations::residual() of its subject
  std::unique_ptr<const subject::Transmissions> transmissions_;
  std::vector<subject::InnerSite> sites_;  ///< of a frame, where force passes
  std::vector<subject::NodeMotion> node_motions_;
  std::map<std::string, bool> known_;  ///< by place: whether statics agrees
};

}  // namespace deflect::diagnosis
