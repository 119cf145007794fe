// SPDX-License-Identifier: Apache-2.0
#include <exception>

#include "apps/python/bindings.h"

namespace vernier::python {
namespace {

const char* class_name(ErrorKind kind) {
  switch (kind) {
    case ErrorKind::usage:
      return "UsageError";
    case ErrorKind::input:
      return "InputError";
    case ErrorKind::output:
      return "OutputError";
    case ErrorKind::memory:
      return "OutOfMemoryError";
  }
  return "Error";
}

}  // namespace

void bind_errors(py::module_&) {
  // The exceptions are classes of vernier/_errors.py, so that each is one of Python's own kinds too.
  py::register_local_exception_translator([](std::exception_ptr thrown) {
    if (!thrown) return;
    try {
      std::rethrow_exception(thrown);
    } catch (const Error& error) {
      const py::object type = py::module_::import("vernier._errors").attr(class_name(error.kind()));
      PyErr_SetString(type.ptr(), error.what());
    }
  });
}

}  // namespace vernier::python
