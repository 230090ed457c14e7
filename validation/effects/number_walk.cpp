#include "validation/effects/number_walk.h"

#include "msa/mechanism/fields.h"

namespace deflect::effects {
namespace {

class NumberWalk final : public FieldVisitor {
 public:
  explicit NumberWalk(const std::function<void(std::size_t, double&)>& f) : f_(f) {}

  void quantity(const char*, double& x, const Quantity&, const char*) override { f_(index_++, x); }
  void quantity_if_given(const char*, std::optional<double>& x, const Quantity&, const char*) override {
    if (x) f_(index_++, *x);
  }
  void vector3(const char*, Vector3& x, Dimension, const char*) override {
    for (double& each : x) f_(index_++, each);
  }
  void matrix(const char*, MatrixX& x, Eigen::Index, Need, const char*) override {
    for (double& each : x.reshaped()) f_(index_++, each);
  }
  void integer(const char*, int&, int, int, const char*) override {}
  void text(const char*, std::string&, Need, const char*) override {}
  void texts(const char*, std::vector<std::string>&, Need, const char*) override {}
  void word(const char*, std::string&, const Words&, const char*) override {}
  void any(const char*, std::string&, const char*) override {}
  void word_or_object(const char*, std::string&, const Words&, bool more, const std::function<void()>& fields,
                      const char*) override {
    if (more) fields();
  }
  void object(const char*, Need, bool absent, const std::function<void()>& fields, const char*) override {
    if (!absent) fields();
  }
  void entries(const char*, Elements& all, Need, const char*) override { each(all); }
  void list(const char*, Elements& all, const char*) override { each(all); }
  void one_or_list(const char*, Elements& all, const char*) override { each(all); }
  void keys(const std::vector<std::string>&) override {}
  std::size_t alternative(const std::vector<std::string>&, std::size_t current) override { return current; }
  void require(bool, const char*, const std::string&) override {}

 private:
  void each(Elements& all) {
    for (std::size_t i = 0; i < all.size(); ++i) all.describe_element(*this, i);
  }

  const std::function<void(std::size_t, double&)>& f_;
  std::size_t index_ = 0;
};

}  // namespace

void for_each_number(Mechanism& m, const std::function<void(std::size_t, double&)>& f) {
  NumberWalk walk(f);
  describe(walk, m);
  walk.surroundings = surroundings_of(m);
  for (Named<Part>& leg : m.legs) describe_leg(walk, leg);
}

std::vector<double> numbers_of(const Mechanism& m) {
  Mechanism copy = m;
  std::vector<double> out;
  for_each_number(copy, [&](std::size_t, double& x) { out.push_back(x); });
  return out;
}

}  // namespace deflect::effects
