#include "validation/matrix/check_matrix.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>

#include "msa/base/error.h"
#include "msa/base/index.h"
#include "msa/base/motion_text.h"

namespace deflect::matrix {
namespace {

/// Asymmetry below this is more likely to be the precision of a program than a mistake.
constexpr double numerical_asymmetry = 1e-4;

/// A motion has no sense: the largest component of its direction is positive.
std::string words(const Vector6& twist, double unit_m, double length) {
  Vector6 d = twist;
  d.head<3>() *= unit_m;
  const Vector3 direction =
      d.tail<3>().norm() * length * unit_m < 1e-6 * d.head<3>().norm() ? d.head<3>() : d.tail<3>();
  Eigen::Index most = 0;
  direction.cwiseAbs().maxCoeff(&most);
  if (direction(most) < 0) d = -d;
  return motion_text(d, length * unit_m);
}

MatrixDiagnosis asymmetric(const Matrix6& K, const JudgedMatrix& m) {
  const auto i = as_size(m.row), j = as_size(m.column);
  MatrixDiagnosis d{"asymmetric",
                    fmt::format("it is not symmetric in {} of 15 pairs, most at {} {} ({:.6g}) against {} {} ({:.6g})",
                                m.asymmetric_pairs, wrench_axes[i], displacement_axes[j], K(m.row, m.column),
                                wrench_axes[j], displacement_axes[i], K(m.column, m.row)),
                    "find where it is made: a conservative structure has K = Kᵀ; no single usual mistake leaves this"};
  if (*m.symmetric.measured < numerical_asymmetry)
    d.remedy = fmt::format("if this is the precision of the program that made it: --tolerance {:.0e}",
                           10 * *m.symmetric.measured);
  return d;
}

/// Checks that failed and that no usual mistake explains, in their own words.
std::vector<MatrixDiagnosis> unexplained(const MatrixCheckOptions& o, const JudgedMatrix& m) {
  std::vector<MatrixDiagnosis> list;
  const double length = weighing_length(o.K.values);
  if (!m.symmetric.passes()) list.push_back(asymmetric(o.K.values, m));
  if (!m.positive.passes())
    list.push_back({"indefinite",
                    fmt::format("it pushes on instead of back in the motion {}: eigenvalue {:.3g} of the largest",
                                words(m.softest, o.unit_m, length), *m.positive.measured),
                    "look for a block in another unit, a lost sign, or a structure beyond its stability"});
  const char* size_remedy = "check --unit and --order; for a device that really is so, give its size: --size '0.2 mm'";
  if (!m.length.passes())
    list.push_back({"size", fmt::format("its characteristic length is {:.3g} mm", *m.length.measured), size_remedy});
  if (!m.stiffness.passes())
    list.push_back(
        {"size", fmt::format("its mean translational stiffness is {:.3g} N/mm", *m.stiffness.measured), size_remedy});
  return list;
}

/// What is true of K whatever else is: directions that nothing holds, passive joints that are held.
std::vector<MatrixDiagnosis> motions(const MatrixCheckOptions& o, const JudgedMatrix& m) {
  std::vector<MatrixDiagnosis> list;
  const double length = weighing_length(o.K.values);
  if (!m.free.empty()) {
    std::vector<std::string> free;
    for (const Vector6& twist : m.free) free.push_back(words(twist, o.unit_m, length));
    list.push_back({"free_direction",
                    fmt::format("nothing resists the motion {}, to the digits printed", fmt::join(free, "; nor ")),
                    "hold it, or name the passive joints with --passive if the matrix is that of one leg; where it is "
                    "soft only, print more digits"});
  }
  for (std::size_t j = 0; j < m.passive.size(); ++j)
    if (!m.passive[j].passes())
      list.push_back(
          {"passive_joint_resists",
           fmt::format("it resists passive joint {}, {}, with {:.3g} of its stiffness", j + 1,
                       words(o.passive_twists->values.col(as_index(j)), o.unit_m, length), *m.passive[j].measured),
           "release the passive joints: K − K J (Jᵀ K J)⁻¹ Jᵀ K; check point, order and units of J"});
  return list;
}

std::optional<Eigen::Vector2d> ratio(const Matrix6& K, const Matrix6& R) {
  const double length = weighing_length(R);
  const Matrix6 k = weighed((K + K.transpose()) / 2, length), r = weighed((R + R.transpose()) / 2, length);
  if (Eigen::LLT<Matrix6>(r).info() != Eigen::Success) return {};
  const Vector6 ratios = Eigen::GeneralizedSelfAdjointEigenSolver<Matrix6>(k, r, Eigen::EigenvaluesOnly).eigenvalues();
  if (!ratios.allFinite()) return {};
  return Eigen::Vector2d(ratios(0), ratios(5));
}

MatrixDiagnosis differs(const Explanation& e, const std::optional<Eigen::Vector2d>& range) {
  MatrixDiagnosis d{"differs",
                    fmt::format("it differs from the reference by {:.3g} of its largest entry", e.difference),
                    "compare lengths, sections, moduli and joints of the two models"};
  if (range)
    d.sentence += fmt::format("; along no motion is it softer than {:.4g} or stiffer than {:.4g} times the reference",
                              (*range)(0), (*range)(1));
  if (e.nearest && e.remaining < 0.3 * e.difference)
    d.sentence += fmt::format(". Nearest: {}; that leaves {:.3g}", e.nearest->sentence, e.remaining);
  return d;
}

ElasticStructure in_mm(ElasticStructure s, double unit_m) {
  const double mm = 1e3 * unit_m;
  s.centre_of_stiffness *= mm;
  if (s.centre_of_compliance) *s.centre_of_compliance *= mm;
  s.translational /= mm;
  s.rotational *= mm;
  s.length *= mm;
  return s;
}

}  // namespace

bool MatrixCheck::passes() const {
  return std::all_of(checks.begin(), checks.end(), [](const Check& c) { return c.passes(); });
}

MatrixCheck check_matrix(const MatrixCheckOptions& o) {
  const PrintedMatrix K = with_tolerance(o.K, o.tolerance);
  JudgedMatrix m = judge(K, o.passive_twists ? &*o.passive_twists : nullptr, o.unit_m, o.plausible);
  if (o.passive_twists || !m.free.empty()) m.length.measured = m.stiffness.measured = std::nullopt;  // rounding only
  MatrixCheck out;
  out.K_mm = K.values;
  out.K_mm.topLeftCorner<3, 3>() /= 1e3 * o.unit_m;
  out.K_mm.bottomRightCorner<3, 3>() *= 1e3 * o.unit_m;
  out.checks = {m.symmetric, m.positive, m.holds, m.length, m.stiffness};
  out.checks.insert(out.checks.end(), m.passive.begin(), m.passive.end());
  const double length = weighing_length(K.values);
  const Matrix6 w = weighed(K.values, length);
  if (!w.isZero(0)) out.max_asymmetry = (w - w.transpose()).cwiseAbs().maxCoeff() / w.cwiseAbs().maxCoeff();
  out.weighing_length_mm = 1e3 * o.unit_m * length;
  out.eigenvalues_N_mm = m.eigenvalues * 1e-3 / o.unit_m;
  if (m.symmetric.passes() && m.positive.passes())
    out.structure = in_mm(elastic_structure((K.values + K.values.transpose()) / 2), o.unit_m);

  std::optional<MatrixDiagnosis> difference;
  if (o.reference) {
    const PrintedMatrix R = with_tolerance(*o.reference, o.tolerance);
    const JudgedMatrix reference = judge(R, nullptr, o.unit_m, o.plausible);
    if (!reference.symmetric.passes() || !reference.positive.passes())
      throw InputError("the reference is not symmetric and positive itself: check it by itself first");
    out.checks.push_back(equals_reference(K, R));
    if (!out.checks.back().passes()) {
      out.ratio = ratio(K.values, R.values);
      const Explanation e = explain(K, R, o.unit_m);
      out.explanations = e.diagnosis;
      if (out.explanations.empty()) difference = differs(e, out.ratio);
    }
  }
  if (out.explanations.empty() && !m.sound()) {
    out.explanations = explain(K, o.unit_m, o.plausible);
    out.guessed = m.symmetric.passes() && m.positive.passes();
    if (out.explanations.empty()) out.findings = unexplained(o, m);
  }
  if (difference) out.findings.push_back(*difference);
  for (MatrixDiagnosis& d : motions(o, m)) out.findings.push_back(std::move(d));
  return out;
}

}  // namespace deflect::matrix
