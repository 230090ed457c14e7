#include "msa/mechanism/device_schema.h"

#include "msa/mechanism/fields.h"

namespace deflect {

Schema device_schema(const std::string& family) {
  Mechanism m;
  return schema_of([&](FieldVisitor& v) { describe(v, m); }, {{"family", family}});
}

Schema law_schema(bool rotation) {
  Law law;
  return schema_of(
      [&](FieldVisitor& v) {
        v.surroundings.rotation = rotation;
        describe(v, law);
      },
      {});
}

}  // namespace deflect
