#include "validation/fit/undetermined.h"

#include <fmt/format.h>

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

#include "msa/base/index.h"
#include "msa/base/number_words.h"

namespace deflect::fit {
namespace {

constexpr double loose = 0.5, involved = 0.1, alike = 0.05;
/// Below this share of the largest singular value nothing but rounding of the differences is left.
constexpr double rounding = 1e-7;

bool near(double a, double b) { return std::abs(a - b) <= alike * std::max(std::abs(a), std::abs(b)); }

/// "the product of A and B": what two parameters have together along w, orthogonal to what is not determined.
std::string combination(const FreeParameter& a, const FreeParameter& b, double p, double q, double wa, double wb) {
  const auto of = [&](const char* what) {
    return fmt::format("only the {} {} and {} is determined", what, a.path, b.path);
  };
  const bool same_kind = a.dimension == b.dimension;
  if (!a.positive && !b.positive && same_kind) {  // w is over the scales
    if (near(wa / a.scale(), wb / b.scale())) return of("sum of");
    if (near(wa / a.scale(), -wb / b.scale())) return of("difference of");
  }
  // A coordinate over its scale is a relative change.
  if (!(p > 0 && q > 0)) return "";
  if (near(wa, wb)) return of("product of");
  if (near(wa, -wb)) return fmt::format("only the ratio {} / {} is determined", a.path, b.path);
  if (same_kind && near(wa * q, wb * p)) return of("sum of");
  if (same_kind && near(wa * p, wb * q)) return fmt::format("only 1/{} + 1/{} is determined", a.path, b.path);
  return "";
}

/// "A × 1.10 with B × 0.95" for a step by a tenth.
std::string step_words(const std::vector<FreeParameter>& all, const VectorX& v) {
  std::string out;
  const double largest = v.cwiseAbs().maxCoeff();
  const double sign = v.cwiseAbs().maxCoeff() == v.maxCoeff() ? 1 : -1;
  for (Eigen::Index i = 0; i < v.size(); ++i) {
    if (std::abs(v(i)) < involved * largest) continue;
    const FreeParameter& p = nth(all, i);
    const double step = 0.1 * sign * v(i) / largest;
    out +=
        (out.empty() ? "" : " with ") + (p.positive ? fmt::format("{} × {}", p.path, digits_of(std::exp(step), 3))
                                                    : fmt::format("{} {} {}{}{}", p.path, step < 0 ? "−" : "+",
                                                                  digits_of(std::abs(step) * p.scale() / p.per_unit, 3),
                                                                  p.unit.empty() ? "" : " ", p.unit));
  }
  return out;
}

std::string sentence(const std::vector<FreeParameter>& all, const VectorX& values, const VectorX& v) {
  std::vector<std::size_t> some;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (std::abs(v(as_index(i))) >= involved * v.cwiseAbs().maxCoeff()) some.push_back(i);
  if (some.size() == 1) return fmt::format("{} is not determined by these data", all[some[0]].path);
  if (some.size() == 2) {
    const auto i = as_index(some[0]), k = as_index(some[1]);
    const std::string words = combination(nth(all, i), nth(all, k), values(i), values(k), v(k), -v(i));
    if (!words.empty()) return words;
  }
  return fmt::format("these change the readings by less than can be seen: {}", step_words(all, v));
}

}  // namespace

std::vector<Undetermined> undetermined(const MatrixX& J, const std::vector<FreeParameter>& all, const VectorX& values) {
  std::vector<Undetermined> out;
  if (all.empty()) return out;
  const Eigen::JacobiSVD<MatrixX> svd(MatrixX(J.transpose() * J), Eigen::ComputeFullV);
  const VectorX squares = svd.singularValues();
  for (Eigen::Index i = squares.size() - 1; i >= 0; --i) {
    const double size = std::sqrt(std::max(0.0, squares(i)));
    if (size > 1 / loose) continue;
    const VectorX v = svd.matrixV().col(i);
    const bool none = size <= rounding * std::sqrt(squares(0));
    out.push_back({v, none ? INFINITY : 1 / size, sentence(all, values, v)});
  }
  return out;
}

}  // namespace deflect::fit
