// Laws (law.h) at the six freedoms of a place of a frame: a support, a spring, an end of a member.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>
#include <vector>

#include "msa/mechanism/law.h"

namespace deflect::frame {

using Freedoms = std::array<bool, 6>;

/// Of one freedom the laws in series, in order, and those beside: each of these acts side by side with the series, or
/// with nothing where the freedom is free. Materials by name. One list, because most places have none.
class FreedomLaws {
 public:
  bool empty() const { return entries_.empty(); }
  bool has(std::size_t freedom, bool beside = false) const {
    return std::any_of(entries_.begin(), entries_.end(),
                       [&](const Entry& e) { return e.freedom == freedom && e.beside == beside; });
  }
  std::vector<Law> at(std::size_t freedom, bool beside = false) const {
    std::vector<Law> out;
    for (const Entry& e : entries_)
      if (e.freedom == freedom && e.beside == beside) out.push_back(e.law);
    return out;
  }
  void set(std::size_t freedom, std::vector<Law> laws, bool beside = false) {
    std::erase_if(entries_, [&](const Entry& e) { return e.freedom == freedom && e.beside == beside; });
    for (Law& law : laws) entries_.push_back({freedom, beside, std::move(law)});
  }
  /// The given freedoms and those that have laws.
  Freedoms or_in(Freedoms out) const {
    for (const Entry& e : entries_) out[e.freedom] = true;
    return out;
  }
  bool operator==(const FreedomLaws&) const = default;

 private:
  struct Entry {
    std::size_t freedom;
    bool beside;
    Law law;
    bool operator==(const Entry&) const = default;
  };
  std::vector<Entry> entries_;
};

}  // namespace deflect::frame
