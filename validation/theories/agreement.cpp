#include "validation/theories/agreement.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "msa/base/error.h"
#include "validation/theories/turned.h"

namespace deflect::theories {
namespace {

constexpr double linear_bound = 1e-9, contact_bound = 1e-7;

Vector6 in_metres(const Vector6& d, double length) {
  Vector6 out = d;
  out.tail<3>() *= length;
  return out;
}

Matrix6 per_metre(const Matrix6& K, double length) {
  Vector6 weight = Vector6::Ones();
  weight.tail<3>().setConstant(1 / length);
  return weight.asDiagonal() * K * weight.asDiagonal();
}

/// |a − b| against |b|, or against |a| where b vanishes.
double relative(double apart, double size_a, double size_b) {
  const double size = size_b > 0 ? size_b : size_a;
  return apart > 0 ? apart / size : 0;
}

/// Of the ends of two plays, in metres.
double ends_apart(const Vector6& a, const Vector6& b, double size) {
  double apart = 0;
  for (int i = 0; i < 6; ++i) {
    if (std::isinf(a(i)) && a(i) == b(i)) continue;
    const double here = std::abs(a(i) - b(i));
    if (std::isfinite(b(i))) size = std::max(size, std::abs(b(i)));
    apart = std::max(apart, here);
  }
  return relative(apart, size, size);
}

/// f(i, j, what is known of their difference) for every two of which more than their difference is wanted.
template <class F>
void for_each_pair(const Theories& theories, const F& f) {
  for (std::size_t i = 0; i < theories.size(); ++i)
    for (std::size_t j = i + 1; j < theories.size(); ++j)
      if (const double known_to = theories[i]->known_to + theories[j]->known_to; std::isfinite(known_to))
        f(i, j, known_to);
}

std::string words(const Vector6& SI) {
  const Vector6 d = twist_in_mm(SI);
  return fmt::format("({:.6g}, {:.6g}, {:.6g}) mm, ({:.6g}, {:.6g}, {:.6g}) rad", d(0), d(1), d(2), d(3), d(4), d(5));
}

struct Two {
  const Theory &a, &b;
  const Answer &of_a, &of_b;
};

template <class Where>
void refuse_disagreement(const Two& t, const Difference& apart, double bound, const Where& where) {
  constexpr const char* verdict = "One of the two is wrong here: no answer is given";
  if (t.of_a.rigid != t.of_b.rigid)
    throw NumericalError(
        fmt::format("{}: {} and {} disagree: {} motions have an infinite stiffness by {}, {} by {}. {}", where(),
                    t.a.spoken, t.b.spoken, t.of_a.rigid, t.a.spoken, t.of_b.rigid, t.b.spoken, verdict));
  if (apart.largest() <= bound) return;
  throw NumericalError(
      fmt::format("{}: {} and {} disagree: displacements differ by {:.1e}, stiffnesses by {:.1e}{}, bound {:.0e}. {}: "
                  "{}; {}: {}. {}",
                  where(), t.a.spoken, t.b.spoken, apart.displacement, apart.stiffness,
                  apart.play > 0 ? fmt::format(", free play by {:.1e}", apart.play) : "", bound, t.a.title,
                  words(t.of_a.displacement), t.b.title, words(t.of_b.displacement), verdict));
}

}  // namespace

double relative_difference(const Vector6& a, const Vector6& b) {
  const auto relative = [](double difference, double size) {
    return size > 0 ? difference / size : difference > 0 ? std::numeric_limits<double>::infinity() : 0.0;
  };
  const double translation = b.head<3>().norm(), rotation = b.tail<3>().norm();  // mm, rad
  return std::max(relative((a - b).head<3>().norm(), std::max(translation, rotation * 1.0)),
                  relative((a - b).tail<3>().norm(), std::max(rotation, translation / 1000.0)));
}

double largest_difference(const std::vector<Vector6>& all) {
  double largest = 0;
  for (std::size_t i = 0; i < all.size(); ++i)
    for (std::size_t j = i + 1; j < all.size(); ++j) largest = std::max(largest, relative_difference(all[i], all[j]));
  return largest;
}

double Difference::largest() const { return std::max({displacement, stiffness, play}); }

Difference difference(const Answer& a, const Answer& b, double length) {
  const Vector6 d_a = in_metres(a.displacement, length), d_b = in_metres(b.displacement, length);
  const Matrix6 K_a = per_metre(a.stiffness, length), K_b = per_metre(b.stiffness, length);
  const auto ends = [&](const Vector6& in_a, const Vector6& in_b) {
    return ends_apart(in_metres(in_a, length), in_metres(in_b, length), d_b.norm());
  };
  // Where some motions are held rigidly the load may move nothing: what is left is the rounding of coordinates.
  const bool held = b.rigid > 0 && std::max(d_a.norm(), d_b.norm()) < std::numeric_limits<double>::epsilon() * length;
  return {held ? 0 : relative((d_a - d_b).norm(), d_a.norm(), d_b.norm()),
          relative((K_a - K_b).cwiseAbs().maxCoeff(), K_a.cwiseAbs().maxCoeff(), K_b.cwiseAbs().maxCoeff()),
          std::max(ends(a.floating.least, b.floating.least), ends(a.floating.most, b.floating.most))};
}

double agreement_bound(bool linear, double rounding) {
  return bound_with(linear ? linear_bound : contact_bound, rounding);
}

double rounding_of(const Theories& theories, const std::vector<Answer>& answers, double length) {
  double most = rounding_of(answers[reference_of(theories)], length);
  for (const Answer& answer : answers) most = std::max(most, answer.rounding);
  return most;
}

double require_agreement(const Theories& theories, const std::vector<Answer>& answers, const Vector6& F,
                         const Configuration& c, const std::string& device) {
  constexpr double roundings = 10, most = 1e-4;  // of two draws of rounding, what others may be
  double turned = 0;
  for_each_pair(theories, [&](std::size_t i, std::size_t j, double known_to) {
    const Difference apart = difference(answers[i], answers[j], c.size);
    const bool alike = answers[i].rigid == answers[j].rigid;
    if (alike && apart.largest() <= linear_bound + known_to) return;  // the least that any bound is
    double wide = agreement_bound(all_linear(c), rounding_of(theories, answers, c.size)) + known_to;
    if (alike && apart.largest() > wide && apart.largest() <= most + known_to) {
      const double changed = roundings * (changed_by_turning(*theories[i], answers[i], c, F) +
                                          changed_by_turning(*theories[j], answers[j], c, F));
      turned = std::max(turned, std::min(changed, most));
      wide = std::max(wide, turned + known_to);
    }
    const Two two{*theories[i], *theories[j], answers[i], answers[j]};
    refuse_disagreement(two, apart, wide, [&] { return place_text(device, c); });
  });
  return turned;
}

bool require_agreement_deformed(const Theories& theories, const DeformedAnswers& d, const Configuration& c,
                                const std::string& device) {
  constexpr double solved_to = 1e-6, estimate_is_known_to = 10, terms = 4;
  const double from_linear = d.from_linear[reference_of(theories)];
  double bound = solved_to + estimate_is_known_to * d.discretisation;
  if (d.geometry == Geometry::second_order)
    bound += terms * (from_linear * from_linear + std::ranges::min_element(d.answers, {}, &Answer::left_out)->left_out);
  if (std::ranges::any_of(d.answers, &Answer::apart)) bound += from_linear;
  bool in_play = false;
  for_each_pair(theories, [&](std::size_t i, std::size_t j, double known_to) {
    const double apart =
        relative_difference(twist_in_mm(d.answers[i].displacement), twist_in_mm(d.answers[j].displacement));
    if (!(apart > bound + known_to)) return;
    in_play = apart <= bound + known_to + d.play;
    if (in_play) return;
    throw NumericalError(fmt::format(
        "{}: {} and {} disagree in the deformed shape: displacements differ by {:.1e}, bound {:.0e}. One of the two is "
        "wrong here: no answer is given",
        place_text(device, c), theories[i]->spoken, theories[j]->spoken, apart, bound + known_to));
  });
  return in_play;
}

}  // namespace deflect::theories
