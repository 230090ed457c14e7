// Errors as Python's exceptions: deflect.InputError, MechanismError (with the motions of what cannot stand),
// NumericalError.
#pragma once

namespace deflect::python {

/// For the module that is being made. To call once.
void translate_errors();

}  // namespace deflect::python
