#include "validation/python/errors.h"

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include "msa/base/error.h"
#include "msa/frame/structure/stability.h"

namespace deflect::python {
namespace {

namespace py = pybind11;

/// Raises deflect.errors.NAME(arguments…).
template <class... Arguments>
void raise(const char* name, const Arguments&... arguments) {
  const py::object type = py::module_::import("deflect.errors").attr(name);
  PyErr_SetObject(type.ptr(), type(arguments...).ptr());
}

py::list motions_of(const frame::CannotStand& e) {
  py::list out;
  for (const frame::FreeMotion& motion : e.motions) {
    py::list bodies;
    for (const frame::MovingBody& body : motion.bodies) bodies.append(body.name);
    py::dict one;
    one["words"] = frame::describe(*e.model, motion);
    one["bodies"] = bodies;
    one["held_by_locking"] = motion.joints;
    out.append(one);
  }
  return out;
}

}  // namespace

void translate_errors() {
  py::register_local_exception_translator([](std::exception_ptr thrown) {
    try {
      std::rethrow_exception(thrown);
    } catch (const InputError& e) {
      raise("InputError", e.what());
    } catch (const frame::CannotStand& e) {
      raise("MechanismError", e.what(), motions_of(e));
    } catch (const ModelError& e) {
      raise("MechanismError", e.what());
    } catch (const NumericalError& e) {
      raise("NumericalError", e.what());
    }
  });
}

}  // namespace deflect::python
