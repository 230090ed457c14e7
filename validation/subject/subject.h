// A thing that is measured, as a value: a machine at its tool point, or a frame at one of its nodes. It says where it
// stands, what its readings should be there, what it may be off by, and what it is with an edit. Comparison, diagnosis
// and reports know no more of it.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "msa/fields/edit.h"
#include "msa/frame/file/frame_description.h"
#include "validation/measurement/measurements.h"
#include "validation/prediction/prediction.h"
#include "validation/subject/place.h"

namespace deflect::subject {

/// Where force can be looked at inside a subject without a model of what is missing: statics alone.
///
/// A load F at the measured point puts the force f = gᵀF on a site; by the principle of virtual forces an elongation e
/// there moves the point by g e, in a determinate structure exactly, otherwise with the forces that the model shares
/// out. So every reading is a point on a force–elongation curve of every site.
struct Site {
  std::string name;       ///< "leg 3", "shoulder rz"; the same at every pose
  Place place;            ///< what it is: a drive, or the line of a leg
  bool rotation = false;  ///< f in Nm and e in rad, else N and m
  Vector6 g = Vector6::Zero();
  Vector6 s = Vector6::Zero();  ///< of a leg's line: the wrench at T of a unit force along it; 0 at joints
  double extension = 0;         ///< m: how far the site's slide is out, |L1| of a guideway; 0 without one
  double along = 1;  ///< of a leg's line: (n·a)², a the axis of its slide; across the slide it is 1 − along
};

/// A number of the subject that is off from piece to piece: in every pose, or in one.
struct Tolerance {
  std::string name;  ///< "modulus", "leg 3 base joint x", "pose 4 leg 1 slider"
  double sigma = 0;  ///< standard deviation: relative, or m
  std::optional<std::size_t> pose = {};
  bool zero = false;  ///< where a sensor counts from: no part of the subject
};

/// A body of the subject where it stands: position (m) and axes in W.
struct BodyFrame {
  Vector3 p_W = Vector3::Zero();
  Matrix3 R_W = Matrix3::Identity();
};

/// What statics makes of the loads at the places of a subject as drawn: to first order, what a small deflection at a
/// place does to its readings.
class Transmissions {
 public:
  virtual ~Transmissions() = default;
  /// By reading, the change when every freedom of the place gives way by the law (its materials resolved, no history)
  /// under the force that it carries; in one leg where `leg` is given. Nothing where the place is not known.
  virtual std::optional<std::vector<Vector6>> change(const Place&, std::optional<int> leg, const Law&,
                                                     const measurement::Measurements&) const = 0;
};

class Deviations;

/// A subject where it stands at the poses of some measurements.
class Standing {
 public:
  virtual ~Standing() = default;

  virtual std::size_t poses() const = 0;
  /// Of the whole, m: weighs rotations.
  virtual double size() const = 0;
  /// The measured point with the axes of its body; where the subject stands on the ground.
  virtual BodyFrame tool(std::size_t pose) const = 0;
  virtual BodyFrame base(std::size_t pose) const = 0;
  /// None where nothing inside can be looked at.
  virtual std::vector<Site> sites(std::size_t pose) const = 0;
  /// Tangent compliance at the measured point at rest; contacts as under 1 N each way.
  virtual Matrix6 compliance(std::size_t pose) const = 0;

  /// The readings of these measurements, which have the same poses: prediction.h.
  virtual std::vector<Vector6> predict(const measurement::Measurements&, const prediction::PredictionOptions& = {},
                                       const parallel::Work& = {}) const = 0;

  /// Null where forces at places are more than shares of the load.
  virtual std::unique_ptr<const Transmissions> transmissions() const { return nullptr; }

  /// What it is off by from piece to piece.
  virtual std::unique_ptr<const Deviations> deviations(const measurement::Measurements&) const = 0;
};

/// A subject with one of its tolerances off by a standard deviation: in linear geometry, without the sensor's drift,
/// which no tolerance changes.
class Deviations {
 public:
  virtual ~Deviations() = default;
  /// Those of all poses, then those of each pose in turn.
  virtual const std::vector<Tolerance>& tolerances() const = 0;
  /// Without any, for differences.
  virtual const Standing& drawn() const = 0;
  /// With tolerance k; of its pose alone where it is of one.
  virtual std::unique_ptr<const Standing> with(std::size_t k) const = 0;
};

class Subject {
 public:
  /// What a kind of subject is behind it.
  class Kind;

  /// A machine, measured at its tool point T.
  Subject(Mechanism);  // NOLINT: a machine is a subject
  /// A frame, loaded and measured at a node. InputError where there is no such node.
  Subject(frame::FrameDescription, std::string node);

  const std::string& name() const;
  Geometry geometry() const;
  /// Relative standard deviation of a recorded load.
  double load_tolerance() const;
  /// How many legs it has; 0 of a subject that has none.
  int legs() const;
  /// Where effects can act in it.
  std::vector<Place> places() const;

  /// Throws as configure_all() where it cannot stand. `known`: where a subject stands that may have the same
  /// kinematics, at the poses of the same measurements; the result is the same with it, and sooner there.
  std::shared_ptr<const Standing> stand(const measurement::Measurements&, const Standing* known = nullptr) const;

  /// With the edits one after the other, checked like a file. InputError as edited().
  Subject edited(const std::vector<Edit>&) const;

  /// The machine, of a subject that is one: for what acts on parts of machines (effects, drawings).
  const Mechanism* machine() const;

 private:
  explicit Subject(std::shared_ptr<const Kind>);
  std::shared_ptr<const Kind> kind_;
};

/// How a kind of subject is made: one file for each.
class Subject::Kind {
 public:
  virtual ~Kind() = default;
  virtual const std::string& name() const = 0;
  virtual Geometry geometry() const = 0;
  virtual double load_tolerance() const = 0;
  virtual int legs() const { return 0; }
  virtual std::vector<Place> places() const { return {}; }
  virtual std::shared_ptr<const Standing> stand(const measurement::Measurements&, const Standing* known) const = 0;
  virtual std::shared_ptr<const Kind> edited(const std::vector<Edit>&) const = 0;
  virtual const Mechanism* machine() const { return nullptr; }
};

std::shared_ptr<const Subject::Kind> machine_subject(Mechanism);
std::shared_ptr<const Subject::Kind> frame_subject(frame::FrameDescription, std::string node);

}  // namespace deflect::subject
