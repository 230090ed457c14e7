// Iso-curves of a field on a grid, and where their values stand so that they can be read.
#pragma once

#include <string>
#include <vector>

namespace deflect::figures {

/// A point of the plane, in the units of the grid's coordinates.
struct PlanePoint {
  double x = 0, y = 0;
};
using Polyline = std::vector<PlanePoint>;

/// Values at (x[i], y[j]), x fastest; NaN where there is none. Coordinates rise.
struct GridField {
  std::vector<double> x, y, values;

  double at(std::size_t i, std::size_t j) const { return values[j * x.size() + i]; }
};

/// Where the field, linear along the edges of its cells, has the value `level`; each curve once, closed ones with their
/// first point again at the end. Cells with a corner without value have no curve.
std::vector<Polyline> iso_curves(const GridField&, double level);

/// A value that stands on its curve, in the middle of a box that no curve crosses.
struct CurveLabel {
  PlanePoint at;
  double level = 0, half_width = 0, half_height = 0;

  bool covers(const PlanePoint& p) const;
};

/// All curves of one field on paper.
class LabelledCurves {
 public:
  /// `wide`, `tall`: the panel in mm; of text `letter_mm` a letter is wide and `line_mm` a line high.
  LabelledCurves(const GridField& field, double wide, double tall, double letter_mm, double line_mm);

  void add(double level);  ///< before its labels; a level that was not added has no curves
  /// On each curve of the level that is long enough, apart from other labels. With `tight` on shorter curves too, where
  /// need be beside the curve, so that the label keeps within the panel.
  void label(double level, bool tight = false);

  const std::vector<CurveLabel>& labels() const { return labels_; }
  /// Curves of the level without what labels cover.
  std::vector<Polyline> visible(double level) const;

 private:
  struct Curves {
    double level;
    std::vector<Polyline> lines;
  };
  const std::vector<Polyline>& curves_of(double level) const;
  bool fits(const CurveLabel&) const;
  PlanePoint moved_inside(const CurveLabel&) const;

  const GridField& field_;
  double mm_x_, mm_y_, letter_, line_;  ///< mm of paper for one unit; of text
  std::vector<Curves> all_;
  std::vector<CurveLabel> labels_;
};

/// The values as gnuplot's matrix, a line for each y, which it reads several times as fast as points one by one.
std::string matrix_rows(const GridField&);
/// The columns x, y, value of that matrix, "matrix using …"; coordinates are evenly spaced.
std::string matrix_columns(const GridField&);

/// What is drawn over the colours of a panel, as gnuplot's rows: curves as x, y, colour; values as x, y, text, colour.
struct CurveRows {
  std::string thin, heavy, values;
};

/// The curves of the levels `iso`; those of `index` are heavy and carry their values, and where none of them passes
/// another one carries its own. Black on light colours, that is from the value `light` on, and white on dark ones.
CurveRows curve_rows(LabelledCurves, const std::vector<double>& iso, const std::vector<double>& index, double light);

}  // namespace deflect::figures
