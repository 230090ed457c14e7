#include "validation/fit/fit_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "msa/base/error.h"
#include "msa/base/index.h"
#include "msa/base/outcome.h"
#include "validation/effects/effect_file.h"
#include "validation/json/json_text.h"

namespace deflect::fit {
namespace {

constexpr const char* remedy = "give the file of 'deflect fit --json'";

class Reader {
 public:
  Reader(const std::string& text, const std::string& origin)
      : origin_(origin), root_(json::parse_json(text, origin, remedy)) {}

  Knowledge read(const subject::Subject& s, const std::vector<effects::Effect>& effects) const {
    Knowledge out;
    if (!root_.is_object() || root_.value("kind", Json()) != "fit") fail("kind", "is not a fit");
    read_parameters(s, effects, out);
    const Json& posterior = member(root_, "posterior", "");
    const std::vector<std::string> names = texts(member(posterior, "names", "posterior."));
    out.posterior.parameters = std::ssize(out.parameters);
    out.posterior.mean = numbers(member(posterior, "mean", "posterior."), "posterior.mean", names.size());
    const Json& rows = member(posterior, "covariance", "posterior.");
    if (!rows.is_array() || rows.size() != names.size() || names.size() < out.parameters.size())
      fail("posterior.covariance", "has not one row for each name");
    out.posterior.covariance.resize(std::ssize(names), std::ssize(names));
    for (std::size_t i = 0; i < rows.size(); ++i)
      out.posterior.covariance.row(as_index(i)) = numbers(rows[i], "posterior.covariance", names.size());
    out.tolerances.assign(names.begin() + std::ssize(out.parameters), names.end());
    out.tolerance_scale = number(root_, "tolerance_scale", "");
    for (const Json& d : member(root_, "discrepancy", ""))
      out.discrepancies.push_back({quantity(d), number(d, "share", "discrepancy.")});
    for (const Json& n : member(root_, "noise", ""))
      out.sigma.emplace_back(quantity(n), number(n, "sigma_SI", "noise."));
    return out;
  }

 private:
  [[noreturn]] void fail(const std::string& where, const std::string& what) const {
    throw InputError(fmt::format("{}: member '{}' {}: {}", origin_, where, what, remedy));
  }
  const Json& member(const Json& in, const char* key, const std::string& where) const {
    if (!in.is_object() || !in.contains(key)) fail(where + key, "is missing");
    return in[key];
  }
  double number(const Json& in, const char* key, const std::string& where) const {
    const Json& x = member(in, key, where);
    if (!x.is_number()) fail(where + key, "is no number");
    return x.get<double>();
  }
  std::vector<std::string> texts(const Json& in) const {
    std::vector<std::string> out;
    for (const Json& each : in) {
      if (!each.is_string()) fail("posterior.names", "has an entry that is no text");
      out.push_back(each.get<std::string>());
    }
    return out;
  }
  VectorX numbers(const Json& in, const char* where, std::size_t count) const {
    if (!in.is_array() || in.size() != count) fail(where, fmt::format("has not {} numbers", count));
    VectorX out(as_index(count));
    for (std::size_t i = 0; i < count; ++i) {
      if (!in[i].is_number()) fail(where, "has an entry that is no number");
      out(as_index(i)) = in[i].get<double>();
    }
    return out;
  }
  measurement::Quantity quantity(const Json& in) const {
    const Json& what = member(in, "quantity", "");
    for (std::size_t i = 0; i < measurement::quantity_rows.size(); ++i)
      if (what == measurement::quantity_rows[i].what) return static_cast<measurement::Quantity>(i);
    fail("quantity", "is unknown");
  }

  /// Those of the effect that parameters[from] is of, in the effect's order.
  std::vector<FreeParameter> read_effect(const Json& all, std::size_t from, const subject::Subject& s,
                                         const std::vector<effects::Effect>& effects) const {
    const Json& of = member(all[from], "of", "parameters.");
    const Json& name = member(of, "effect", "parameters.of.");
    if (!name.is_string()) fail("parameters.of.effect", "is no text");
    if (effects.empty())
      throw InputError(
          fmt::format("{}: parameters of the effect {} were fitted: give the description that was fitted, "
                      "which lacks the effect, and the effect",
                      origin_, name.get<std::string>()));
    FreedEffect freed{std::make_shared<const effects::Effect>(effects::find_effect(effects, name.get<std::string>())),
                      std::nullopt};
    if (of.contains("leg")) {
      if (!of["leg"].is_number_integer()) fail("parameters.of.leg", "is no whole number");
      freed.leg = of["leg"].get<int>();
    }
    std::vector<FreeParameter> out = parameters_of(s, freed);
    for (std::size_t i = 0; i < out.size(); ++i) {
      if (from + i >= all.size() || all[from + i].value("path", Json()) != out[i].path)
        fail("parameters", fmt::format("has not all parameters of {}, one after the other", freed.name()));
      if (!out[i].positive)
        out[i].prior =
            Prior{number(all[from + i], "value", "parameters."), number(all[from + i], "deviation", "parameters.")};
    }
    return out;
  }

  void read_parameters(const subject::Subject& s, const std::vector<effects::Effect>& effects, Knowledge& out) const {
    const Json& all = member(root_, "parameters", "");
    std::vector<double> fitted;
    for (std::size_t i = 0; i < all.size(); ++i) {
      const Json& p = all[i];
      if (p.is_object() && p.contains("of")) {
        for (FreeParameter& own : read_effect(all, i, s, effects)) {
          fitted.push_back(number(all[fitted.size()], "value", "parameters."));
          out.parameters.push_back(std::move(own));
        }
        i = fitted.size() - 1;
        continue;
      }
      const Json& path = member(p, "path", "parameters.");
      if (!path.is_string()) fail("parameters.path", "is no text");
      const double value = number(p, "value", "parameters."), before = number(p, "before", "parameters.");
      const double first = number(p, "first_number_SI", "parameters.");
      const double deviation = number(p, "deviation", "parameters.");
      told_at<InputError>([&] { return fmt::format("{}: ", origin_); },
                          [&] {
                            FreeParameter own = parameter_at(s, path.get<std::string>());
                            if (const Json& unit = member(p, "unit", "parameters.");
                                unit.is_string() && !unit.get<std::string>().empty()) {
                              own.unit = unit.get<std::string>();
                              own.per_unit = parse_quantity("1 " + own.unit, own.dimension);
                            }
                            if (!own.positive) own.prior = Prior{own.per_unit * value, own.per_unit * deviation};
                            take_value(s, own, first, before, value);
                            out.parameters.push_back(bounded(std::move(own), s));
                          });
      fitted.push_back(value * out.parameters.back().per_unit);
    }
    out.values = Eigen::Map<const VectorX>(fitted.data(), std::ssize(fitted));
  }

  /// The subject has the number of before, or the fitted one; what stands there counts from the fit's.
  static void take_value(const subject::Subject& s, FreeParameter& p, double first, double before, double value) {
    const double here = first_numbers(s, {p})(0);
    const auto is = [&](double x) { return std::abs(here - x) <= 1e-9 * std::max(std::abs(x), std::abs(first)); };
    const double after = p.common ? first * value : p.per_unit * value;
    if (!is(first) && !is(after))
      throw InputError(
          fmt::format("{}: the subject has a value that is neither that before the fit nor the fitted one: "
                      "give the description that 'deflect fit' read or wrote",
                      p.path));
    if (p.common) p.value = is(after) ? value : before;
  }

  std::string origin_;
  Json root_;
};

}  // namespace

Knowledge read_fit(const std::string& json, const std::string& origin, const subject::Subject& s,
                   const std::vector<effects::Effect>& effects) {
  return Reader(json, origin).read(s, effects);
}

}  // namespace deflect::fit
