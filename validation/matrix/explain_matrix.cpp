#include "validation/matrix/explain_matrix.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "validation/matrix/elastic_structure.h"
#include "validation/matrix/mistakes.h"

namespace deflect::matrix {
namespace {

/// Whatever the digits allow, an explanation leaves at most this of the matrix and this part of the difference; or, of
/// a mistake that drowns the matrix, the last part.
constexpr double largest_remainder = 0.03, largest_part = 0.1, part_when_drowned = 1e-3;

struct Way {
  const Mistake* mistake;
  const Undo* undo;
};

std::vector<Way> ways(bool last_resort) {
  std::vector<Way> list;
  for (const Mistake& m : mistakes())
    if (m.last_resort == last_resort)
      for (const Undo& undo : m.undo) list.push_back({&m, &undo});
  return list;
}

MatrixDiagnosis diagnosis(const Mistake& m, const Undone& undone) {
  return {m.id, m.sentence + undone.found, m.remedy};
}

/// How far the digits of K can move f(K): each entry by itself, the worst of all added up, to first order.
Matrix6 moved_by_rounding(const PrintedMatrix& K, const Matrix6& at, const std::function<Matrix6(const Matrix6&)>& f) {
  Matrix6 sum = Matrix6::Zero();
  for (Eigen::Index i = 0; i < 6; ++i)
    for (Eigen::Index j = 0; j < 6; ++j) {
      if (!(K.rounding(i, j) > 0)) continue;
      Matrix6 other = K.values;
      other(i, j) += K.rounding(i, j);
      sum += (f(other) - at).cwiseAbs();
    }
  return sum;
}

/// What is left of K − R once mistakes are undone one after the other; nothing where they do not apply.
class MatrixComparison {
 public:
  MatrixComparison(const PrintedMatrix& K, const PrintedMatrix& R, double unit_m)
      : K_(K), R_(R), unit_m_(unit_m), length_(weighing_length(R.values)) {
    scale_ = std::max(weighed(R.values, length_).cwiseAbs().maxCoeff(), std::numeric_limits<double>::min());
    difference_ = relative(K.values - R.values).cwiseAbs().maxCoeff();
  }

  double difference() const { return difference_; }

  std::optional<double> remaining(const std::vector<Way>& sequence, std::vector<Undone>* undone = nullptr) const {
    const auto left = misfit(sequence, K_.values, R_.values, undone);
    if (!left) return {};
    return relative(*left).cwiseAbs().maxCoeff();
  }

  /// The difference is gone, to the digits of both.
  bool explained_by(const std::vector<Way>& sequence) const {
    const auto left = misfit(sequence, K_.values, R_.values, nullptr);
    if (!left) return false;
    const double most = relative(*left).cwiseAbs().maxCoeff();
    if (!(most <= part_when_drowned * difference_ || (most <= largest_remainder && most <= largest_part * difference_)))
      return false;
    const auto misfit_of = [&](const Matrix6& K, const Matrix6& R) {
      return misfit(sequence, K, R, nullptr).value_or(*left);
    };
    const Matrix6 bound = moved_by_rounding(K_, *left, [&](const Matrix6& K) { return misfit_of(K, R_.values); }) +
                          moved_by_rounding(R_, *left, [&](const Matrix6& R) { return misfit_of(K_.values, R); });
    return (left->cwiseAbs().array() <= bound.array()).all();
  }

 private:
  Matrix6 relative(const Matrix6& m) const { return weighed(m, length_) / scale_; }

  std::optional<Matrix6> misfit(const std::vector<Way>& sequence, Matrix6 K, const Matrix6& R,
                                std::vector<Undone>* undone) const {
    for (const Way& way : sequence) {
      const std::optional<Undone> step = (*way.undo)(K, {&R, unit_m_});
      if (!step || !step->K.allFinite()) return {};
      K = step->K;
      if (undone) undone->push_back(*step);
    }
    return K - R;
  }

  PrintedMatrix K_, R_;
  double unit_m_, length_, scale_ = 1, difference_ = 0;
};

MatrixDiagnosis described(const MatrixComparison& comparison, const std::vector<Way>& sequence) {
  std::vector<Undone> undone;
  comparison.remaining(sequence, &undone);
  MatrixDiagnosis d = diagnosis(*sequence.front().mistake, undone.front());
  for (std::size_t i = 1; i < sequence.size(); ++i) {
    const MatrixDiagnosis next = diagnosis(*sequence[i].mistake, undone[i]);
    d = {d.id + "+" + next.id, d.sentence + "; and then " + next.sentence, d.remedy + "; then " + next.remedy};
  }
  return d;
}

bool has(const std::vector<MatrixDiagnosis>& list, const char* id) {
  return std::any_of(list.begin(), list.end(), [id](const MatrixDiagnosis& d) { return d.id == id; });
}

/// Distance of a device from one of 0.2 m and 1e6 N/m, in powers of e.
double implausibility(const JudgedMatrix& m) {
  if (!m.length.measured) return 0;
  return std::abs(std::log(*m.length.measured / 200)) + std::abs(std::log(*m.stiffness.measured / 1e3));
}

}  // namespace

std::vector<MatrixDiagnosis> explain(const PrintedMatrix& K, double unit_m, const PlausibleSize& plausible) {
  const JudgedMatrix given = judge(K, nullptr, unit_m, plausible);
  const bool only_size = given.symmetric.passes() && given.positive.passes();
  std::vector<std::pair<double, MatrixDiagnosis>> found;
  for (const Mistake& m : mistakes()) {
    for (const Undo& undo : m.undo) {
      const MistakeContext context{nullptr, unit_m};
      const std::optional<Undone> undone = undo(K.values, context);
      if (!undone || !undone->K.allFinite()) continue;
      PrintedMatrix repaired{undone->K, moved_by_rounding(K, undone->K, [&](const Matrix6& other) {
                               const auto again = undo(other, context);
                               return again ? again->K : undone->K;
                             })};
      const Matrix6 change = (undone->K - K.values).cwiseAbs();
      if ((change.array() <= (repaired.rounding + K.rounding).array()).all()) continue;  // nothing was undone
      const JudgedMatrix judged = judge(repaired, nullptr, unit_m, plausible);
      if (!judged.sound() || !(*judged.symmetric.measured <= largest_remainder)) continue;
      found.emplace_back(only_size ? implausibility(judged) : 0, diagnosis(m, *undone));
      break;
    }
  }
  std::stable_sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<MatrixDiagnosis> list;
  for (auto& [distance, d] : found) list.push_back(std::move(d));
  return list;
}

Explanation explain(const PrintedMatrix& K, const PrintedMatrix& R, double unit_m) {
  const MatrixComparison comparison(K, R, unit_m);
  Explanation out;
  out.difference = out.remaining = comparison.difference();
  const std::vector<Way> usual = ways(false);
  std::optional<Way> nearest;
  for (const Way& way : usual) {
    const std::optional<double> left = comparison.remaining({way});
    if (left && *left < out.remaining) out.remaining = *left, nearest = way;
    if (!has(out.diagnosis, way.mistake->id) && comparison.explained_by({way}))
      out.diagnosis.push_back(described(comparison, {way}));
  }
  // Two mistakes that commute explain K in either order: the first order is enough.
  for (std::size_t i = 0; i < usual.size() && out.diagnosis.empty(); ++i)
    for (std::size_t j = 0; j < usual.size() && out.diagnosis.empty(); ++j)
      if (usual[i].mistake != usual[j].mistake && comparison.explained_by({usual[i], usual[j]}))
        out.diagnosis.push_back(described(comparison, {usual[i], usual[j]}));
  if (out.diagnosis.empty())
    for (const Way& way : ways(true))
      if (comparison.explained_by({way})) out.diagnosis.push_back(described(comparison, {way}));
  if (!out.diagnosis.empty())
    out.remaining = 0;
  else if (nearest)
    out.nearest = described(comparison, {*nearest});
  return out;
}

Check equals_reference(const PrintedMatrix& K, const PrintedMatrix& R) {
  const double length = weighing_length(R.values);
  const double scale = std::max(weighed(R.values, length).cwiseAbs().maxCoeff(), std::numeric_limits<double>::min());
  const Matrix6 difference = weighed(K.values - R.values, length).cwiseAbs() / scale;
  const Matrix6 allowed = weighed(K.rounding + R.rounding, length) / scale;
  Eigen::Index i = 0, j = 0;
  (difference.array() / (allowed.array() + 1e-300)).maxCoeff(&i, &j);
  Check check{"equals_reference", "|K − R| / |R|", difference(i, j)};
  check.at_most = allowed(i, j);
  return check;
}

}  // namespace deflect::matrix
