// A spring whose force follows a measured curve (msa/mechanism/table.h has its meaning): F(δ) through corners, straight
// between them and on beyond the ends. SI.
//
// A curve with a memory depends on what pull and push have left, p⁺ and p⁻, as a function of the force
//   δ = c F + p⁺(F) − p⁻(−F),   p(F) = max(A(F), min(B(F), p)),
// which begin() turns into corners of F(δ) for the p before the load.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <vector>

namespace deflect::frame {

struct TableSpring {
  struct Corner {
    double d, f;
  };
  using Corners = std::vector<Corner>;

  struct Memory {
    double c = 0;          ///< compliance between the bounds
    Corners loads, falls;  ///< A and B as corners [p, F], from p = 0 to one common end, where they go on with `beyond`
    double beyond = 0;     ///< dp/dF
  };

  std::shared_ptr<const Corners> corners;          ///< at least two, δ and F rising
  std::shared_ptr<const Memory> memory = nullptr;  ///< null: elastic
  int number = -1;                                 ///< of the first of what is left, see number_slips()
  std::array<double, 2> left{};                    ///< before the load

  void begin(const std::array<double, 2>& before);
  std::array<double, 2> left_after(double f) const;

  double force(double d) const;
  double tangent(double d) const { return at_force(force(d)); }
  double energy(double d) const;  ///< ∫F dδ from where there is no force
  double at_force(double f) const;
  double elongation(double f) const;
  double stored(double f) const;  ///< given back on unloading
  double true_tangent(double d) const { return tangent(d); }
};

}  // namespace deflect::frame
