// SPDX-License-Identifier: Apache-2.0
#include "apps/python/bindings.h"

PYBIND11_MODULE(_core, module) {
  using namespace vernier::python;
  module.attr("version") = vernier::version();
  bind_errors(module);
  bind_picture(module);
  bind_scene(module);
  bind_session(module);
}
