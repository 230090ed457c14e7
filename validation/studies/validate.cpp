#include "validation/studies/validate.h"

#include <algorithm>
#include <cmath>

#include "validation/studies/errata_prices.h"
#include "validation/theories/agreement.h"

namespace deflect::studies {

Validation validate(const Mechanism& m, const std::vector<ValidationPoint>& points, double load_N,
                    const std::set<Erratum>& as_printed, const frame::MemberDivision& division,
                    const theories::Theories& theories) {
  Validation v{m.name, theories, as_printed, {}};
  double squares = 0;
  for (const ValidationPoint& point : points) {
    const Configuration c = stand(m, point.pose_mm_deg).configuration;
    std::vector<std::unique_ptr<theories::TheoryAt>> at;
    for (const theories::Theory* theory : theories) at.push_back(theory->at(c, {m.name, division}));
    for (int axis = 0; axis < 3; ++axis) {
      const Vector6 F = load_N * Vector6::Unit(axis);
      ValidationRow row{point, axis, load_N, {}, {}};
      std::vector<theories::Answer> answers;
      for (const auto& theory : at) answers.push_back(theory->answer(F));
      theories::require_agreement(theories, answers, F, c, m.name);
      for (const theories::Answer& answer : answers) row.displacements.push_back(twist_in_mm(answer.displacement));
      if (!as_printed.empty())
        row.as_printed = twist_in_mm(solved_as_printed(analytic::AnalyticModel(c, as_printed), F).displacement);
      row.relative_difference = theories::largest_difference(row.displacements);
      v.max_relative_difference = std::max(v.max_relative_difference, row.relative_difference);
      squares += row.relative_difference * row.relative_difference;
      v.rows.push_back(row);
    }
  }
  v.rms_relative_difference = v.rows.empty() ? 0 : std::sqrt(squares / static_cast<double>(v.rows.size()));
  return v;
}

}  // namespace deflect::studies
