#include "validation/python/bindings.h"
#include "validation/python/errors.h"

namespace deflect::python {

PYBIND11_MODULE(_core, m) {
  m.doc() = "The library behind the package deflect; its names and units are those of the package.";
  m.attr("version") = DEFLECT_VERSION;
  translate_errors();
  bind_subjects(m);
  bind_studies(m);
  bind_measured(m);
  bind_campaigns(m);
  bind_structures(m);
}

}  // namespace deflect::python
