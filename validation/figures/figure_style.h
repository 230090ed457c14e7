// How figures are drawn, whatever they show: width on paper and text.
#pragma once

#include <string>

namespace deflect::figures {

/// Of the axes x, y and z: colours by Okabe and Ito, which any colour vision tells apart, and gnuplot's filled points.
inline constexpr const char* colours[] = {"#0072B2", "#D55E00", "#009E73"};
inline constexpr int shapes[] = {7, 5, 13};

struct FigureStyle {
  double width_mm = 0;  ///< on paper; 0: each figure's own
  std::string font = "DejaVu Sans";
  double size_pt = 8;  ///< of numbers and names of axes; titles and notes go with it
};

/// Throws InputError where text of this size does not fit this width, or either is out of all proportion.
void check_size(const FigureStyle&);

/// Throws InputError where fontconfig knows no font of this family, saying what it would take in its place, or where
/// the name cannot be a family's.
void check_font(const std::string& family);

}  // namespace deflect::figures
