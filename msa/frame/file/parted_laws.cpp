#include "msa/frame/file/parted_laws.h"

#include <algorithm>
#include <functional>

#include "msa/base/index.h"

namespace deflect::frame {
namespace {

using Laws = std::vector<Law>;

/// With the stiffnesses of a spring as the laws that they are.
FreedomLaws laws_of(const FrameSpring& s) {
  FreedomLaws out = s.laws;
  for (std::size_t i = 0; i < 6; ++i)
    if (s.stiffness[i]) out.set(i, {LinearLaw{*s.stiffness[i]}});
  return out;
}

/// How many of the laws stay; nullopt: this cannot be.
using Staying = std::function<std::optional<std::size_t>(const Laws&, TakenLaws::At, std::size_t part,
                                                         std::size_t freedom, bool beside)>;

class Parting {
 public:
  Parting(const FrameDescription& f, const Staying& staying) : out_{f, {}}, staying_(staying) {}

  /// `rigid`: where no law yields.
  bool part(FreedomLaws& laws, TakenLaws::At at, std::size_t part, const std::function<bool(std::size_t)>& rigid) {
    for (std::size_t i = 0; i < 6; ++i)
      for (const bool beside : {false, true}) {
        Laws all = laws.at(i, beside);
        const auto count = staying_(all, at, part, i, beside);
        if (!count || *count > all.size()) return false;
        if (*count == all.size()) continue;
        const Laws behind(all.begin() + as_index(*count), all.end());
        all.resize(*count);
        if (!beside && (*count > 0 || rigid(i)))
          out_.taken.push_back({at, part, i, true, {behind}});
        else if (beside)
          for (const Law& law : behind) take_beside(at, part, i, {law});
        else
          take_beside(at, part, i, behind);
        laws.set(i, std::move(all), beside);
      }
    return true;
  }

  std::optional<PartedFrame> all() && {
    using At = TakenLaws::At;
    FrameDescription& f = out_.rest;
    for (std::size_t k = 0; k < f.supports.size(); ++k) {
      FrameSupport& s = f.supports[k].second;
      if (!part(s.laws, At::support, k, [&](std::size_t i) { return s[i]; })) return std::nullopt;
    }
    for (std::size_t k = 0; k < f.springs.size(); ++k) {
      FrameSpring& s = f.springs[k].second;
      FreedomLaws laws = laws_of(s);
      if (!part(laws, At::spring, k, [](std::size_t) { return false; })) return std::nullopt;
      s.laws = std::move(laws);
      s.stiffness = {};
    }
    for (std::size_t k = 0; k < f.members.size(); ++k) {
      FrameMember& m = f.members[k].second;
      const auto rigid = [&](const Freedoms& released) {
        return [&, truss = m.truss](std::size_t i) { return truss ? i < 3 : !released[i]; };
      };
      if (!part(m.start, At::start, k, rigid(m.release_from)) || !part(m.end, At::end, k, rigid(m.release_to)))
        return std::nullopt;
    }
    return std::move(out_);
  }

 private:
  void take_beside(TakenLaws::At at, std::size_t part, std::size_t freedom, Laws chain) {
    if (!out_.taken.empty()) {
      TakenLaws& last = out_.taken.back();
      if (!last.in_series && last.at == at && last.part == part && last.freedom == freedom)
        return last.chains.push_back(std::move(chain));
    }
    out_.taken.push_back({at, part, freedom, false, {std::move(chain)}});
  }

  PartedFrame out_;
  const Staying& staying_;
};

std::size_t leading_linear(const Laws& laws) {
  const auto is = [](const Law& law) { return is_linear(law); };
  return as_size(std::find_if_not(laws.begin(), laws.end(), is) - laws.begin());
}

template <class T>
bool same_names(const Named<T>& a, const Named<T>& b) {
  return a.size() == b.size() &&
         std::equal(a.begin(), a.end(), b.begin(), [](const auto& x, const auto& y) { return x.first == y.first; });
}

const FreedomLaws& laws_at(const FrameDescription& f, TakenLaws::At at, std::size_t part) {
  switch (at) {
    case TakenLaws::At::support:
      return f.supports[part].second.laws;
    case TakenLaws::At::spring:
      return f.springs[part].second.laws;
    case TakenLaws::At::start:
      return f.members[part].second.start;
    case TakenLaws::At::end:
      break;
  }
  return f.members[part].second.end;
}

}  // namespace

PartedFrame without_nonlinear_laws(const FrameDescription& f) {
  const Staying linear = [](const Laws& laws, auto, auto, auto, bool) { return std::optional(leading_linear(laws)); };
  return *Parting(f, linear).all();
}

std::optional<PartedFrame> parted_as(const FrameDescription& f, const FrameDescription& rest) {
  if (!same_names(f.nodes, rest.nodes) || !same_names(f.members, rest.members) ||
      !same_names(f.supports, rest.supports) || !same_names(f.springs, rest.springs))
    return std::nullopt;
  const Staying as_rest = [&](const Laws& laws, TakenLaws::At at, std::size_t part, std::size_t freedom,
                              bool beside) -> std::optional<std::size_t> {
    const std::size_t count = laws_at(rest, at, part).at(freedom, beside).size();
    if (count > leading_linear(laws)) return std::nullopt;
    return count;
  };
  return Parting(f, as_rest).all();
}

}  // namespace deflect::frame
