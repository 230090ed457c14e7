#include "validation/subject/subject.h"

#include <utility>

namespace deflect::subject {

Subject::Subject(Mechanism m) : kind_(machine_subject(std::move(m))) {}
Subject::Subject(frame::FrameDescription f, std::string node) : kind_(frame_subject(std::move(f), std::move(node))) {}
Subject::Subject(std::shared_ptr<const Kind> kind) : kind_(std::move(kind)) {}

const std::string& Subject::name() const { return kind_->name(); }
Geometry Subject::geometry() const { return kind_->geometry(); }
double Subject::load_tolerance() const { return kind_->load_tolerance(); }
int Subject::legs() const { return kind_->legs(); }
std::vector<Place> Subject::places() const { return kind_->places(); }
std::shared_ptr<const Standing> Subject::stand(const measurement::Measurements& m, const Standing* known) const {
  return kind_->stand(m, known);
}
Subject Subject::edited(const std::vector<Edit>& edits) const { return Subject(kind_->edited(edits)); }
const Mechanism* Subject::machine() const { return kind_->machine(); }

}  // namespace deflect::subject
