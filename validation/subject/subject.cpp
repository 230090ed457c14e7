#include "validation/subject/subject.h"

#include <algorithm>
#include <utility>

#include "msa/frame/file/frame_description.h"

namespace deflect::subject {

double step_of(double relative) {
  constexpr double small = 0.01, least = 0.05;
  return relative > small ? std::max(small / relative, least) : 1;
}

Subject::Subject(Mechanism m) : kind_(machine_subject(std::move(m))) {}
Subject::Subject(frame::FrameDescription f) : kind_(frame_subject(std::move(f))) {}
Subject::Subject(std::shared_ptr<const Kind> kind) : kind_(std::move(kind)) {}

const std::string& Subject::name() const { return kind_->name(); }
const std::string& Subject::about() const { return kind_->about(); }
std::string Subject::file_text(const std::string& name, const std::string& about) const {
  return kind_->file_text(name, about);
}
Geometry Subject::geometry() const { return kind_->geometry(); }
Geometry Subject::true_geometry() const { return kind_->true_geometry(); }
measurement::Instruments Subject::instruments() const { return kind_->instruments(); }
measurement::Measurements Subject::placed(measurement::Measurements m) const { return kind_->placed(std::move(m)); }
double Subject::load_tolerance() const { return kind_->load_tolerance(); }
int Subject::legs() const { return kind_->legs(); }
std::vector<Place> Subject::places() const { return kind_->places(); }
std::shared_ptr<const Standing> Subject::stand(const measurement::Measurements& m, const Standing* known) const {
  return kind_->stand(m, known);
}
Subject Subject::named(const std::string& name) const { return Subject(kind_->named(name)); }
Subject Subject::edited(const std::vector<Edit>& edits) const { return Subject(kind_->edited(edits)); }
const Mechanism* Subject::machine() const { return kind_->machine(); }
const frame::FrameDescription* Subject::frame() const { return kind_->frame(); }

}  // namespace deflect::subject
