#include "msa/frame/file/frame_schema.h"

#include "msa/frame/file/frame_fields.h"

namespace deflect::frame {

Schema frame_schema() {
  FrameDescription f;
  Schema schema = schema_of([&](FieldVisitor& v) { describe(v, f); }, {});
  for (SchemaField& field : schema.levels.front().cases.front().fields) {
    if (field.key == "supports") field.alone = "holds";
    if (field.key == "springs")
      for (SchemaField& freedom : schema.levels[field.level].cases.front().fields)
        if (freedom.kind == FieldKind::one_or_list) freedom.alone = "stiffness";
  }
  return schema;
}

}  // namespace deflect::frame
