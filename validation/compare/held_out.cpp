#include "validation/compare/held_out.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "msa/base/index.h"
#include "validation/compare/comparison.h"

namespace deflect::compare {

std::vector<std::size_t> held_out_groups(const ResidualStudy& s) {
  std::vector<std::size_t> out;
  const bool by_load = s.data->instruments.stationary && s.data->poses.size() == 1;
  std::map<std::vector<int>, std::size_t> known;
  for (std::size_t i = 0; i < s.data->readings.size(); ++i) {
    if (!by_load) {
      out.push_back(s.data->readings[i].pose);
      continue;
    }
    std::vector<int> signs;
    for (const double load : s.loads.col(as_index(i))) signs.push_back(load > 0 ? 1 : load < 0 ? -1 : 0);
    out.push_back(known.emplace(signs, known.size()).first->second);
  }
  return out;
}

HeldOut::HeldOut(const ResidualStudy& s, const statistics::Uncertainty& u, const std::vector<bool>& set_aside)
    : study_(&s),
      uncertainty_(&u),
      set_aside_(set_aside),
      quantity_(quantity_of_errors(s.values)),
      group_(held_out_groups(s)) {
  folds_ = std::min<std::size_t>(10, 1 + *std::max_element(group_.begin(), group_.end()));
  const MatrixX& B = u.whitening()->shared();
  if (folds_ < 2 || B.cols() == 0) return;
  std::vector<std::vector<Eigen::Index>> rows(folds_);
  for (std::size_t i = 0; i < s.values.size(); ++i) rows[fold_of(i)].push_back(as_index(i));
  std::vector<MatrixX> taught;
  for (const std::vector<Eigen::Index>& own : rows) {
    const MatrixX part = B(own, Eigen::all);
    taught.push_back(part.transpose() * part);
  }
  for (std::size_t fold = 0; fold < folds_; ++fold) {
    MatrixX information = MatrixX::Identity(B.cols(), B.cols());
    for (std::size_t other = 0; other < folds_; ++other)
      if (other != fold) information += taught[other];
    others_.emplace_back(information);
  }
}

std::size_t HeldOut::fold_of(std::size_t value) const { return group_[study_->values[value].reading] % folds_; }

bool HeldOut::counts(std::size_t value) const {
  return !set_aside_[study_->values[value].reading] && study_->values[value].quantity == quantity_;
}

double HeldOut::rmse(const VectorX& residual) const {
  std::size_t n = 0;
  for (std::size_t i = 0; i < study_->values.size(); ++i) n += counts(i);
  return n > 0 ? std::sqrt(squares(residual).sum() / static_cast<double>(n)) : 0;
}

VectorX HeldOut::squares(const VectorX& residual) const {
  const statistics::Whitening& white = *uncertainty_->whitening();
  const MatrixX& B = white.shared();
  std::vector<VectorX> eta(folds_, VectorX::Zero(B.cols()));
  if (!others_.empty()) {  // where there is one pose, nothing is learnt at others
    // z in the rows of one fold alone.
    MatrixX by_fold = MatrixX::Zero(residual.size(), as_index(folds_));
    const VectorX z = white.within_groups(residual);
    for (std::size_t i = 0; i < study_->values.size(); ++i) by_fold(as_index(i), as_index(fold_of(i))) = z(as_index(i));
    const MatrixX score = B.transpose() * by_fold;
    for (std::size_t fold = 0; fold < folds_; ++fold) {
      VectorX all = VectorX::Zero(B.cols());
      for (std::size_t other = 0; other < folds_; ++other)
        if (other != fold) all += score.col(as_index(other));
      eta[fold] = others_[fold].solve(all);
    }
  }
  VectorX out = VectorX::Zero(as_index(folds_));
  for (std::size_t i = 0; i < study_->values.size(); ++i) {
    if (!counts(i)) continue;
    const auto row = as_index(i);
    const double left = residual(row) - uncertainty_->tolerances().shared.row(row).dot(eta[fold_of(i)]);
    out(as_index(fold_of(i))) += left * left;
  }
  return out;
}

}  // namespace deflect::compare
