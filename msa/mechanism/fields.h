// The list of fields of every struct in a device's description (field_visitor.h); reader, writer and schema share it.
#pragma once

#include <cstddef>
#include <string>
#include <type_traits>
#include <vector>

#include "msa/fields/field_visitor.h"
#include "msa/mechanism/description.h"

namespace deflect {

void describe(FieldVisitor&, Mechanism&);
void describe(FieldVisitor&, Material&);
void describe(FieldVisitor&, Section&);
void describe(FieldVisitor&, Part&);
void describe(FieldVisitor&, Law&);
/// A joint beside the legs.
void describe(FieldVisitor&, Joint&);
void describe(FieldVisitor&, Variation&);
/// The part at that index of a chain.
void describe(FieldVisitor&, Named<Part>& chain, std::size_t);
void describe(FieldVisitor&, Mount&);
void describe(FieldVisitor&, Misfit&);
void describe(FieldVisitor&, LegDeviation&);
void describe(FieldVisitor&, LoadPoint&);
void describe(FieldVisitor&, Placement&);
void describe(FieldVisitor&, PolygonSpace::Corner&);

/// E, and nu or G.
void describe_elastic(FieldVisitor&, Material&);
void describe_geometry(FieldVisitor&, Geometry&);
/// The field `stiffness`: {rows: [[…]], units}, symmetric and positive definite. `where_free`: the remedy where it is
/// not.
void describe_stiffness(FieldVisitor&, std::optional<Matrix6>& stiffness, const char* where_free);
/// Beam theory of a member. The section, where given, must have the properties that the theory needs.
void describe_beam_theory(FieldVisitor&, BeamTheory&, const Section*, const std::string& section_name);

/// Only the field `leg` of a mechanism; the rest of it is in FieldVisitor::surroundings.
void describe_leg(FieldVisitor&, Named<Part>&);
Surroundings surroundings_of(const Mechanism&);

template <class T>
class NamedElements final : public Elements {
 public:
  explicit NamedElements(Named<T>& list) : list_(list) {}
  std::size_t size() const override { return list_.size(); }
  std::string name(std::size_t i) const override { return list_[i].first; }
  void add(const std::string& name) override { list_.emplace_back(name, T()); }
  void describe_element(FieldVisitor& v, std::size_t i) override {
    if constexpr (std::is_same_v<T, Part>)
      describe(v, list_, i);
    else
      describe(v, list_[i].second);
  }

 private:
  Named<T>& list_;
};

template <class T>
class ListElements final : public Elements {
 public:
  explicit ListElements(std::vector<T>& list) : list_(list) {}
  std::size_t size() const override { return list_.size(); }
  std::string name(std::size_t) const override { return ""; }
  void add(const std::string&) override { list_.emplace_back(); }
  void describe_element(FieldVisitor& v, std::size_t i) override { describe(v, list_[i]); }

 private:
  std::vector<T>& list_;
};

}  // namespace deflect
