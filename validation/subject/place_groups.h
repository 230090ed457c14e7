// Groups of places: places of one kind in one leg, in one stage, on one line of supports, or of one section. What one
// of them lacks all of them may lack by the same amount: bearings of one batch, supports on one soil.
#pragma once

#include <functional>
#include <set>
#include <string>
#include <vector>

#include "validation/subject/place.h"

namespace deflect::subject {

/// Collects groups, each set of parts and freedoms once, with names that no place and no other group has.
class Groups {
 public:
  /// The places that are there already.
  explicit Groups(const std::vector<Place>&);

  /// The group of these places, in their order, where there are two or more: `id` and `words` name it. Nothing where
  /// the same set is a group already. Where another place has that id, ".like_FIRST" follows, FIRST its first part.
  void add(const std::vector<Place>& parts, const std::string& id, const std::string& words);

  std::vector<Place> all;

 private:
  std::set<std::string> ids_;
  std::set<std::set<std::string>> sets_;
};

/// The places in parts that are alike, each part in the order of the places, the parts in that of their first. Two
/// places are alike where their keys are equal.
std::vector<std::vector<Place>> parted(const std::vector<Place>&, const std::function<std::string(const Place&)>& key);

/// How a place is held and in which freedoms it acts: what places of a group have in common.
std::string held_as(const Place&);

}  // namespace deflect::subject
