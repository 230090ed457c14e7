// A subject is the thing measured, as a value: a machine, or a frame. It provides its instruments, its position at each
// pose, the readings predicted there, its tolerances, and an edited copy of itself. Comparison, diagnosis and reports
// use nothing else of it.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "msa/fields/edit.h"
#include "validation/measurement/measurements.h"
#include "validation/prediction/prediction.h"
#include "validation/subject/place.h"

namespace deflect::frame {
struct FrameDescription;
}

namespace deflect::subject {

/// A point inside a subject whose force is known from statics alone, without a model of what is missing.
///
/// A load F at the measured point causes the force f = gᵀF at the site. By the principle of virtual forces an
/// elongation e there moves the measured point by g e: exactly in a statically determinate structure, otherwise with
/// the distribution of forces in the model. So every reading is a point on the force–elongation curve of every site.
struct Site {
  std::string name;       ///< "leg 3", "shoulder rz"; the same at every pose
  Place place;            ///< a drive, or the line of a leg
  bool rotation = false;  ///< f in Nm and e in rad, else N and m
  Vector6 g = Vector6::Zero();
  Vector6 s = Vector6::Zero();  ///< for a leg's line: the wrench at T of a unit force along it; 0 at joints
  double extension = 0;         ///< m: extension of the site's slide, |L1| of a guideway; 0 without a slide
  /// For a leg's line: (n·a)², where n is its direction and a the axis of its slide; the share across the slide is 1 −
  /// along.
  double along = 1;
};

/// A place inside a frame through which force passes, N or Nm, and what it does when it deforms by m or rad there: the
/// model's distribution of forces. Where the place is `determinate` statics alone says what passes, whatever the
/// stiffnesses are, and a deformation there strains nothing.
struct InnerSite {
  std::string name;  ///< "C1b", "support P0a ux"
  Place place;       ///< a member, of which this is the axial force; a held freedom of a support; a joint_sites()
  bool rotation = false;
  VectorX per_load;  ///< by load channel
  VectorX moves;     ///< by sensor: what is recorded, by unit deformation
  bool determinate = false;
  /// Of a member the diagonal of R = 1 − A (AᵀKA)⁻¹AᵀK (A: elongations of members by displacements, K their
  /// stiffnesses): the share of a misfit's elongation that strains the member itself. 0: determinate; 1: nothing around
  /// it gives way. Over a truss these add up to its degree of static indeterminacy (M. von Scheven, E. Ramm,
  /// M. Bischoff, Quantification of the redundancy distribution in truss and beam structures, Int. J. Solids and
  /// Structures 213 (2021) 41–49). Of a rigid support, which has no stiffness to compare with, 0 or 1.
  double redundancy = 0;
};
struct InnerSites {
  std::vector<InnerSite> all;
  MatrixX response;  ///< by site: what passes more when another is deformed by a unit
};

/// A freedom in which a node of a frame moves under the loads, and what a force on it there does.
struct NodeMotion {
  Place place;         ///< the support or the spring between it and the ground, or else the node itself
  VectorX by_reading;  ///< m or rad
  VectorX moves;       ///< by sensor: what is recorded, by N or Nm
};

/// A number of the subject that varies from one built copy to another: the same in every pose, or of one pose only.
struct Tolerance {
  std::string name;  ///< "modulus", "leg 3 base joint x", "pose 4 leg 1 slider"
  double sigma = 0;  ///< standard deviation: relative, or m
  std::optional<std::size_t> pose = {};
  bool zero = false;  ///< the zero of a sensor's readings, not a property of the subject
  /// How many standard deviations the subject deviates by where a difference is taken (Deviations): 1, or fewer.
  double step = 1;
};

/// That number for a tolerance that changes a number by this share of it. Over a hundredth of the number a difference
/// is a derivative: a stiffness that is 20 % larger moves 17 % less, one that is 1 % larger 0.99 %.
double step_of(double relative);

/// Position (m) and axes of a body of the subject, in W.
struct BodyFrame {
  Vector3 p_W = Vector3::Zero();
  Matrix3 R_W = Matrix3::Identity();
};

/// First-order effect of small deflections at places of a subject as drawn on its readings, by statics.
class Transmissions {
 public:
  virtual ~Transmissions() = default;
  struct Change {
    std::vector<Vector6> readings;
    std::vector<bool> floats;  ///< by reading: play that its load leaves open; where it stands is not in `readings`
  };
  /// The change of each reading when every freedom of the place yields by the law (materials resolved, no history)
  /// under the force that it carries; in one leg only where `leg` is given. Empty where the place is not known.
  virtual std::optional<Change> change(const Place&, std::optional<int> leg, const Law&,
                                       const measurement::Measurements&) const = 0;
  /// The same where they yield by any function of that force, which is 0 where a load leaves them open.
  using Curve = std::function<double(double force)>;
  virtual std::optional<std::vector<Vector6>> change(const Place&, std::optional<int> leg, const Curve&,
                                                     const measurement::Measurements&) const = 0;
  /// The same, up to a factor, where beside what is there a force holds the one freedom of the place: any function of
  /// its motion, which may remember. `at_rest` makes one for each leg and pose, which is called in the order of the
  /// readings with the motion, up to that factor. Empty also at several freedoms or parts.
  virtual std::optional<std::vector<Vector6>> change_beside(const Place&, std::optional<int> leg,
                                                            const std::function<Curve()>& at_rest,
                                                            const measurement::Measurements&) const = 0;
};

class Deviations;

/// A subject at the poses of given measurements.
class Standing {
 public:
  virtual ~Standing() = default;

  virtual std::size_t poses() const = 0;
  /// Length of the whole subject, m; weighs rotations against translations.
  virtual double size() const = 0;
  /// Whether it is loaded and read at a tool point T, beside what its named instruments do. The next four describe T;
  /// without one they are zero.
  virtual bool has_tool_point() const { return false; }
  /// tool: T with the axes of its body; base: where the subject is fixed to the ground.
  virtual BodyFrame tool(std::size_t) const { return {}; }
  virtual BodyFrame base(std::size_t) const { return {}; }
  /// Tangent compliance at T without load; where a law is nonlinear (contacts), under a force of 1 N along each of x, y
  /// and z. Where play leaves a motion free under these, under moments of 1 N times size() about each as well; zero
  /// where that leaves one free too.
  virtual Matrix6 compliance(std::size_t) const { return Matrix6::Zero(); }
  /// Empty where no force inside follows from statics.
  virtual std::vector<Site> sites(std::size_t) const { return {}; }
  /// Those of a subject without tool point; none where forces are not proportional to the loads.
  virtual InnerSites inner_sites(const measurement::Measurements&) const { return {}; }
  /// Where the parts of a frame are joined: the bending freedoms of each member end that is not free to turn, and each
  /// spring; not told whether they are determinate. None where a law is not linear.
  virtual std::vector<InnerSite> joint_sites(const measurement::Measurements&) const { return {}; }
  /// Of a frame whose laws are linear.
  virtual std::vector<NodeMotion> node_motions(const measurement::Measurements&) const { return {}; }

  /// Whether a reading depends on the loads before it: friction. Then the order of the readings matters.
  virtual bool has_history() const { return false; }

  /// Predicts the readings of these measurements, which must have the same poses (prediction.h). Of a frame no play is
  /// told that floats.
  virtual prediction::Predicted predicted(const measurement::Measurements&, const prediction::PredictionOptions& = {},
                                          const parallel::Work& = {}) const = 0;
  /// The readings alone.
  std::vector<VectorX> predict(const measurement::Measurements& m, const prediction::PredictionOptions& o = {},
                               const parallel::Work& work = {}) const {
    return predicted(m, o, work).readings;
  }

  /// What the named sensors of these measurements read of a small displacement of the measured point (MeasuredValue).
  virtual measurement::SensorForm sensor_forms(const measurement::Measurements&) const { return nullptr; }

  /// Null where forces at places are not proportional to the load.
  virtual std::unique_ptr<const Transmissions> transmissions() const { return nullptr; }

  /// Its tolerances, each with the subject that deviates by it.
  virtual std::unique_ptr<const Deviations> deviations(const measurement::Measurements&) const = 0;
};

/// A subject that deviates in one tolerance, by its step. Linear geometry, but for a frame in which
/// equilibrium in the deformed shape changes what tolerances do by more than a hundredth and a sensor's σ: there as the
/// frame is described. Without the sensor's drift, which no tolerance changes.
class Deviations {
 public:
  virtual ~Deviations() = default;
  /// First those common to all poses, then those of each pose in turn.
  virtual const std::vector<Tolerance>& tolerances() const = 0;
  /// The subject as drawn, from which differences are taken.
  virtual const Standing& drawn() const = 0;
  /// Deviates by tolerances()[k].step standard deviations of tolerance k. Where that tolerance belongs to one pose, the
  /// result has this pose only.
  virtual std::unique_ptr<const Standing> with(std::size_t k) const = 0;
};

class Subject {
 public:
  /// Interface that each kind of subject implements.
  class Kind;

  /// A machine, measured at its tool point T.
  Subject(Mechanism);  // NOLINT: a machine is a subject
  /// A frame, loaded by load cases and at nodes, read by its sensors.
  Subject(frame::FrameDescription);  // NOLINT: so is a frame

  const std::string& name() const;
  /// One line about it, from its file.
  const std::string& about() const;
  /// A file that reads back as the subject under another name and line.
  std::string file_text(const std::string& name, const std::string& about) const;
  Geometry geometry() const;
  /// In which equilibrium is really written: finite for a machine that is described as linear, because that is what is
  /// measured; for a frame as described.
  Geometry true_geometry() const;
  /// What its files can have columns for.
  measurement::Instruments instruments() const;
  /// Measurements that were read with these instruments, with all that follows from where their loads act.
  measurement::Measurements placed(measurement::Measurements) const;
  /// Relative standard deviation of a recorded load.
  double load_tolerance() const;
  /// Number of legs; 0 for a subject without legs.
  int legs() const;
  /// The places where effects can act.
  std::vector<Place> places() const;

  /// Throws as configure_all() does where a pose cannot be reached. `known`: where a subject stands that may have the
  /// same kinematics, at the poses of the same measurements; the result is the same with it, and sooner there.
  std::shared_ptr<const Standing> stand(const measurement::Measurements&, const Standing* known = nullptr) const;

  /// A copy under another name.
  Subject named(const std::string&) const;
  /// A copy with the edits made in order, checked like a file. Throws InputError as edited() does.
  Subject edited(const std::vector<Edit>&) const;

  /// The machine or the frame, or null where the subject is none; for code that needs its parts (effects, drawings).
  const Mechanism* machine() const;
  const frame::FrameDescription* frame() const;

 private:
  explicit Subject(std::shared_ptr<const Kind>);
  std::shared_ptr<const Kind> kind_;
};

/// One file for each kind of subject.
class Subject::Kind {
 public:
  virtual ~Kind() = default;
  virtual const std::string& name() const = 0;
  virtual const std::string& about() const = 0;
  virtual std::string file_text(const std::string& name, const std::string& about) const = 0;
  virtual Geometry geometry() const = 0;
  virtual Geometry true_geometry() const { return geometry(); }
  virtual measurement::Instruments instruments() const = 0;
  virtual measurement::Measurements placed(measurement::Measurements m) const { return m; }
  virtual double load_tolerance() const = 0;
  virtual int legs() const { return 0; }
  virtual std::vector<Place> places() const { return {}; }
  virtual std::shared_ptr<const Standing> stand(const measurement::Measurements&, const Standing* known) const = 0;
  virtual std::shared_ptr<const Kind> named(const std::string&) const = 0;
  virtual std::shared_ptr<const Kind> edited(const std::vector<Edit>&) const = 0;
  virtual const Mechanism* machine() const { return nullptr; }
  virtual const frame::FrameDescription* frame() const { return nullptr; }
};

std::shared_ptr<const Subject::Kind> machine_subject(Mechanism);
std::shared_ptr<const Subject::Kind> frame_subject(frame::FrameDescription);

}  // namespace deflect::subject
