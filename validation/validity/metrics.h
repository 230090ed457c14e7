// Measures of agreement between predictions S and measurements D.
//
// Area metric with u-pooling (S. Ferson, W. Oberkampf, L. Ginzburg, Model validation and predictive capability for the
// thermal challenge problem, Comput. Methods Appl. Mech. Engrg. 197 (2008) 2408–2430): each measurement is mapped by
// the distribution function of its own prediction, u_i = F_i(D_i). Where the model is right the u_i are uniform from 0
// to 1, whatever the conditions; the area between their empirical distribution function and the diagonal,
//   d = ∫₀¹ |F_n(u) − u| du,   0 ≤ d ≤ 1/2,
// measures the mismatch. Mapped back through one distribution it is in the quantity's unit; here through the normal one
// with the mean of the quantity's u_val. F_i is normal about S_i with standard deviation u_val.
//
// Bias factor and scatter of fire models (K. McGrattan, B. Toman, Quantifying the predictive uncertainty of complex
// numerical models, Metrologia 48 (2011) 173–180; FDS Validation Guide, NIST SP 1018-3, chapter "Quantifying Model
// Uncertainty"), with M = S and E = D of equal sign:
//   m = mean ln(M/E),   σ_M² + σ_E² = Σ (ln(M/E) − m)²/(n − 1),   δ = exp(m + σ_M²/2 − σ_E²/2),
// σ_E the relative uncertainty of the measurements and of what was measured as input. The true value is then M/δ with
// the relative standard deviation σ_M. As there σ_M is not below σ_E: more accurate than the measurements no model can
// be shown to be.
#pragma once

#include <optional>
#include <vector>

namespace deflect::validity {

/// ∫₀¹ |F_n(u) − u| du of values from 0 to 1; 0 without any.
double area_from_uniform(std::vector<double> u);

/// ∫ |F_n(z) − Φ(z)| dz of values in standard deviations: the area mapped back through the standard normal.
double area_from_normal(std::vector<double> z);

/// Expectation of area_from_uniform for n independent uniform values, √(2/π) (π/8)/√n for large n.
double expected_area(std::size_t n);

struct Bias {
  double factor = 1;                     ///< δ
  double scatter = 0;                    ///< σ_M, relative
  double experiment = 0;                 ///< σ_E, relative
  bool scatter_from_experiment = false;  ///< the data show less: σ_M = σ_E
  std::size_t pairs = 0;
};

struct Pair {
  double S = 0, D = 0;
  double u = 0;  ///< standard uncertainty of D and of the inputs
};

/// Of the pairs of equal sign with |S| above ten times u, whose logarithms mean something; nullopt of fewer than three.
std::optional<Bias> bias_of(const std::vector<Pair>&);

}  // namespace deflect::validity
