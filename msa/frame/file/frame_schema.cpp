#include "msa/frame/file/frame_schema.h"

#include "msa/frame/file/frame_fields.h"

namespace deflect::frame {

Schema frame_schema() {
  FrameDescription f;
  return schema_of([&](FieldVisitor& v) { describe(v, f); }, {});
}

}  // namespace deflect::frame
