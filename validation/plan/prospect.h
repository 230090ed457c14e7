// The readings that were taken and those that could be, as rows over nuisances: what a plan is computed from.
#pragma once

#include <Eigen/Cholesky>
#include <functional>
#include <optional>

#include "validation/plan/design.h"
#include "validation/plan/possible.h"
#include "validation/statistics/uncertainty.h"

namespace deflect::plan {

/// σ of what neither the description, the file nor its replicates tell; SI.
struct Noise {
  std::optional<double> u, th;
};

/// All measured numbers, their noise, and the subject's tolerances; the numbers of the readings taken come first.
class Prospect {
 public:
  /// Throws InputError where σ of a number is not known. The subject, whose tolerances these are, is copied. Errors of
  /// loads are proportional to what `right` reads; without it, the subject.
  Prospect(const subject::Subject&, Possible, const Noise&, const parallel::Work&,
           const std::optional<subject::Subject>& right = {});

  const Possible& possible() const { return possible_; }
  const measurement::Measurements& readings() const { return possible_.all; }
  Eigen::Index numbers() const { return std::ssize(values_); }
  /// Of the readings taken.
  Eigen::Index known() const { return known_; }

  /// What a subject is predicted to read, in linear geometry, by measured number. In a plan of sequences every block is
  /// predicted from a machine at rest.
  VectorX predicted(const subject::Subject&) const;
  /// The first known() of them.
  VectorX predicted_of_taken(const subject::Subject&) const;

  /// X divided by the noise of readings, which includes the error of their loads.
  MatrixX white(const MatrixX& X) const { return uncertainty_->whitening()->by_noise(X); }
  /// The tolerances that all poses share, likewise, per standard deviation; their names.
  const MatrixX& tolerances() const { return tolerances_; }
  const std::vector<std::string>& names() const { return names_; }

  /// A design that has the readings taken, or every reading there is: targets and nuisances beside the tolerances
  /// (columns, whitened), `prior`: variances of these.
  Design design(const MatrixX& targets, const MatrixX& beside, const VectorX& prior, bool all = false) const;
  /// A change of the readings taken (SI), whitened by noise; what they read beyond the prediction of a subject in the
  /// geometry it really has, likewise, 0 where that is a gross error; and what tolerances leave of either with the
  /// tolerances that are strained for it, the sum of whose squares is λ².
  VectorX white_of_taken(const VectorX& change) const;
  VectorX off_taken(const subject::Subject&) const;
  VectorX left_of_taken(const VectorX& white) const;
  /// First number of a block, and how many it has.
  std::pair<Eigen::Index, Eigen::Index> numbers_of(std::size_t block) const;
  /// The rows of a block for such a design.
  WhiteRows rows(std::size_t block, const MatrixX& targets, const MatrixX& beside) const;

 private:
  /// (1 + O Oᵀ)^(−1/2) of rows that hold those of whole poses, of the readings taken or of all.
  void eliminate_errors_of_poses(MatrixX&) const;

  Possible possible_;
  std::shared_ptr<const subject::Standing> standing_;
  std::vector<measurement::MeasuredValue> values_;
  Eigen::Index known_ = 0;
  std::optional<statistics::Uncertainty> uncertainty_;
  MatrixX tolerances_;
  std::vector<std::string> names_;
  std::vector<statistics::GroupColumns> own_;  // of each pose, whitened by noise
  std::vector<Eigen::Index> first_;            // number of each reading, and the end
  struct Alone {
    measurement::Measurements readings;
    std::shared_ptr<const subject::Standing> standing;
  };
  Alone data_;
  std::vector<Alone> alone_;                    // the blocks of a plan of sequences
  MatrixX taken_;                               // tolerances in the readings taken, less the errors of each pose
  Eigen::LLT<MatrixX> information_{MatrixX()};  // factorised at once: Eigen leaves info() uninitialised before
};

}  // namespace deflect::plan
