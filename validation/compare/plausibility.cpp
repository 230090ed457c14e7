#include "validation/compare/plausibility.h"

#include <fmt/format.h>

#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>

#include "validation/compare/uncertainty.h"

namespace deflect {
namespace {

constexpr double suspicious = 0.25, cured = 1.0 / 3;

struct Guess {
  std::string sentence;
  double misfit = 0;  // root of Σ (measured − corrected prediction)², relative to the measured
};

/// Measured translations and rotations weigh alike when rotations count times a length.
class Judge {
 public:
  explicit Judge(const ResidualStudy& s) : s_(s) {
    for (const MeasuredValue& v : s.values) measured_ += square(weight(v) * v.value);
  }

  double misfit(const std::vector<Vector6>& predicted) const {
    double sum = 0;
    for (const MeasuredValue& v : s_.values)
      sum += square(weight(v) * (v.value - predicted[v.reading](static_cast<Eigen::Index>(v.component))));
    return measured_ > 0 ? std::sqrt(sum / measured_) : 0;
  }

  double weight(const MeasuredValue& v) const { return v.component < 3 ? 1 : s_.machines.front().size; }

 private:
  static double square(double x) { return x * x; }

  const ResidualStudy& s_;
  double measured_ = 0;
};

/// What was read if the truth went through this matrix on its way into the file.
std::vector<Vector6> mapped(const ResidualStudy& s, const Matrix6& M) {
  std::vector<Vector6> out;
  for (const Vector6& d : s.predicted) out.push_back(M * d);
  return out;
}

/// The prediction, linear, for loads that went through this matrix.
std::vector<Vector6> with_loads(const ResidualStudy& s, const Matrix6& M) {
  std::vector<Vector6> out = s.predicted;
  for (std::size_t i = 0; i < out.size(); ++i) {
    const Reading& r = s.data->readings[i];
    out[i] += s.compliance[r.pose] * (M * r.load - r.load);
  }
  return out;
}

void add_axes(const ResidualStudy& s, const Judge& judge, std::vector<Guess>& guesses) {
  std::array<int, 3> order = {0, 1, 2};
  constexpr const char* names = "xyz";
  do {
    for (int signs = 0; signs < 8; ++signs) {
      Matrix3 P = Matrix3::Zero();
      std::string words;
      for (int k = 0; k < 3; ++k) {
        const double sign = (signs >> k) & 1 ? -1 : 1;
        P(k, order[static_cast<std::size_t>(k)]) = sign;
        words += fmt::format("{}{} = {}{}", k ? ", " : "", names[k], sign < 0 ? "−" : "",
                             names[order[static_cast<std::size_t>(k)]]);
      }
      if (P.isIdentity()) continue;
      const std::string what =
          (-P).isIdentity() ? "have the opposite sign" : fmt::format("stand in other axes (recorded {})", words);
      guesses.push_back({fmt::format("displacements that {}: turn the columns u… (and th…) back", what),
                         judge.misfit(mapped(s, rotate_twist(P)))});
      if (!(-P).isIdentity())  // the same as the above for a linear device
        guesses.push_back({fmt::format("loads that {}: turn the columns f… and m… back", what),
                           judge.misfit(with_loads(s, rotate_twist(P)))});
    }
  } while (std::next_permutation(order.begin(), order.end()));
}

void add_units(const ResidualStudy& s, const Judge& judge, std::vector<Guess>& guesses) {
  const auto displacement = [&](double t, double r, const std::string& what) {
    Matrix6 M = Matrix6::Identity();
    M.topLeftCorner<3, 3>() *= t;
    M.bottomRightCorner<3, 3>() *= r;
    guesses.push_back({what, judge.misfit(mapped(s, M))});
  };
  displacement(1e-3, 1, "displacements in m: ux_mm … want mm");
  displacement(1e3, 1, "displacements in µm: ux_mm … want mm");
  displacement(1 / 25.4, 1, "displacements in inches: ux_mm … want mm");
  displacement(1, 180 / pi, "rotations in degrees: thx_rad … want rad");
  displacement(1, 1e3, "rotations in mrad: thx_rad … want rad");
  const auto load = [&](double f, double m, const std::string& what) {
    Matrix6 M = Matrix6::Identity();
    M.topLeftCorner<3, 3>() *= f;
    M.bottomRightCorner<3, 3>() *= m;
    guesses.push_back({what, judge.misfit(with_loads(s, M))});
  };
  load(9.80665, 9.80665, "loads in kgf: fx_N … want N, 1 kgf = 9.80665 N");
  load(1 / 9.80665, 1 / 9.80665, "loads multiplied by g where they were in N already");
  load(4.4482216152605, 4.4482216152605, "loads in lbf: fx_N … want N, 1 lbf = 4.448 N");
  load(1e3, 1e3, "loads in kN: fx_N … want N");
  load(1, 1e3, "moments in Nm: mx_Nmm … want Nmm");
}

/// A load about another point P: moments about T are then M + p_TP × f. The one point that explains the residual best.
void add_point(const ResidualStudy& s, const Judge& judge, std::vector<Guess>& guesses) {
  MatrixX X(static_cast<Eigen::Index>(s.values.size()), 3);
  VectorX y(X.rows());
  for (std::size_t i = 0; i < s.values.size(); ++i) {
    const MeasuredValue& v = s.values[i];
    const Reading& r = s.data->readings[v.reading];
    const auto row = static_cast<Eigen::Index>(i), k = static_cast<Eigen::Index>(v.component);
    // C [0; p × f] = −C_·θ [f]× p
    X.row(row) = -judge.weight(v) * s.compliance[r.pose].row(k).tail<3>() * skew(r.load.head<3>());
    y(row) = judge.weight(v) * (v.value - s.predicted[v.reading](k));
  }
  const Eigen::ColPivHouseholderQR<MatrixX> qr(X);
  if (qr.rank() < 3) return;
  const Vector3 p = qr.solve(y);
  if (!(p.norm() > 1e-3)) return;
  Matrix6 M = Matrix6::Identity();
  M.bottomLeftCorner<3, 3>() = skew(p);
  guesses.push_back(
      {fmt::format("forces that act at another point, T + ({:.3g}, {:.3g}, {:.3g}) mm in base axes: enter the "
                   "moment about T that comes of it",
                   1e3 * p.x(), 1e3 * p.y(), 1e3 * p.z()),
       judge.misfit(with_loads(s, M))});
}

/// Replicates that differ by more than ten standard deviations of a difference.
std::vector<std::string> contradictions(const ResidualStudy& s) {
  std::vector<std::string> out;
  for (const std::vector<std::size_t>& group : replicates(*s.data))
    for (std::size_t k = 0; k < 3; ++k) {
      std::size_t low = group[0], high = group[0];
      for (const std::size_t i : group) {
        const auto& u = s.data->readings[i].displacement;
        if (!u[k]) continue;
        if (!s.data->readings[low].displacement[k] || *u[k] < *s.data->readings[low].displacement[k]) low = i;
        if (!s.data->readings[high].displacement[k] || *u[k] > *s.data->readings[high].displacement[k]) high = i;
      }
      const Reading &a = s.data->readings[low], &b = s.data->readings[high];
      if (!a.sigma_u || !b.sigma_u || !a.displacement[k] || !b.displacement[k]) continue;
      const double apart = *b.displacement[k] - *a.displacement[k];
      if (apart > 10 * std::hypot(*a.sigma_u, *b.sigma_u))
        out.push_back(
            fmt::format("lines {} and {} contradict each other: u{}_mm differs by {:.3g} at the same pose and "
                        "load, {:.0f} of its standard deviations",
                        std::min(a.line, b.line), std::max(a.line, b.line), "xyz"[k], 1e3 * apart,
                        apart / std::hypot(*a.sigma_u, *b.sigma_u)));
    }
  return out;
}

}  // namespace

std::vector<std::string> what_data_look_like(const ResidualStudy& s) {
  std::vector<std::string> out;
  const Judge judge(s);
  const double misfit = judge.misfit(s.predicted);
  if (misfit > suspicious) {
    std::vector<Guess> guesses;
    add_axes(s, judge, guesses);
    add_units(s, judge, guesses);
    add_point(s, judge, guesses);
    const double least = std::min_element(guesses.begin(), guesses.end(), [](const Guess& a, const Guess& b) {
                           return a.misfit < b.misfit;
                         })->misfit;
    std::string words;  // explanations that do as well: for a linear device kN and µm are the same
    for (const Guess& guess : guesses)
      if (guess.misfit <= 1.02 * least + 1e-9) words += (words.empty() ? "" : "; or ") + guess.sentence;
    if (least < cured * misfit)
      out.push_back(
          fmt::format("these data look like {}; the misfit would fall from {:.0f} to {:.0f} % of what was measured",
                      words, 100 * misfit, 100 * least));
  }
  std::vector<std::string> contradicting = contradictions(s);
  constexpr std::size_t most = 5;
  if (contradicting.size() > most) {
    const std::size_t more = contradicting.size() - most;
    contradicting.resize(most);
    contradicting.push_back(fmt::format("{} more such pairs", more));
  }
  out.insert(out.end(), contradicting.begin(), contradicting.end());
  return out;
}

}  // namespace deflect
