// SPDX-License-Identifier: Apache-2.0
#include <tbb/task_arena.h>

#include <atomic>
#include <utility>

#include "apps/python/background_call.h"
#include "apps/python/bindings.h"

namespace vernier::python {
namespace {

py::dict to_dict(const ErrorEstimate& error) {
  py::dict dict;
  dict["rel_rmse"] = error.rel_rmse;
  dict["low"] = error.low;
  dict["high"] = error.high;
  dict["unreliable"] = error.unreliable;
  return dict;
}

py::dict to_dict(const RayCounts& rays) {
  py::dict dict;
  dict["camera"] = rays.camera;
  dict["bounce"] = rays.bounce;
  dict["shadow"] = rays.shadow;
  return dict;
}

py::dict to_dict(const MissingFigure& figure) {
  py::dict dict;
  dict["share"] = figure.share;
  dict["rel_rmse"] = figure.rel_rmse;
  return dict;
}

py::dict to_dict(const RenderProgress& progress) {
  py::dict dict;
  dict["seconds"] = progress.seconds;
  dict["fraction"] = progress.fraction;
  dict["samples_per_pixel"] = progress.samples_per_pixel;
  dict["samples"] = progress.samples;
  dict["rays"] = to_dict(progress.rays);
  dict["error"] = progress.error ? py::object(to_dict(*progress.error)) : py::none();
  return dict;
}

const char* name_of(StopReason reason) {
  switch (reason) {
    case StopReason::samples:
      return "samples";
    case StopReason::time:
      return "time";
    case StopReason::error:
      return "error";
    case StopReason::interrupted:
      return "interrupted";
  }
  return "";
}

/// A RenderSession on a number of threads of its own.
class Session {
 public:
  /// `threads` 0: as many as the machine has.
  Session(const std::shared_ptr<BuiltScene>& built, const std::string& settings, int threads)
      : arena_(threads > 0 ? threads : tbb::task_arena::automatic),
        session_(built->scene, RenderSettings::from_json(settings)) {}

  const char* run(int spp, double seconds, double error, const py::object& observe) {
    RenderLimits limits;
    limits.spp = spp;
    limits.seconds = seconds;
    limits.error = error;
    session_.set_limits(limits);
    StopReason reason{};
    BackgroundCall call([&](const std::atomic<bool>& stop, BackgroundCall& self) {
      session_.on_progress([&self](const RenderProgress& progress) { self.tell(progress); });
      arena_.execute([&] { reason = session_.run(stop); });
    });
    call.wait(observe.is_none() ? nullptr
                                : std::function<void(const RenderProgress&)>(
                                      [&](const RenderProgress& progress) { observe(to_dict(progress)); }));
    return name_of(reason);
  }

  Picture picture(const std::string& layers) {
    const py::gil_scoped_release unlocked;
    return arena_.execute([&] { return Picture(session_.picture(layers)); });
  }

  RenderStatus status() const { return session_.status(); }
  std::string settings() const { return session_.settings().to_json(); }
  void save(const std::string& path) const { session_.save(path); }

  std::vector<std::string> load(const std::string& path) {
    std::vector<std::string> warnings;
    for (const Notice& notice : session_.load(path)) warnings.push_back(notice.text);
    return warnings;
  }

 private:
  tbb::task_arena arena_;
  RenderSession session_;
};

}  // namespace

py::dict to_dict(const RenderStatus& status) {
  py::dict missing, dict;
  missing["bent"] = to_dict(status.missing.bent);
  missing["depth"] = to_dict(status.missing.depth);
  dict["seconds"] = status.seconds;
  dict["samples_per_pixel"] = status.samples_per_pixel;
  dict["samples"] = status.samples;
  dict["rays"] = to_dict(status.rays);
  dict["error"] = to_dict(status.error);
  dict["missing"] = missing;
  dict["bad_samples"] = status.bad_samples;
  return dict;
}

void bind_session(py::module_& module) {
  module.attr("default_settings") = RenderSettings().to_json();
  py::class_<Session>(module, "Session")
      .def(py::init<const std::shared_ptr<BuiltScene>&, const std::string&, int>(), py::arg("scene"),
           py::arg("settings"), py::arg("threads"), py::call_guard<py::gil_scoped_release>())
      .def("run", &Session::run, py::arg("spp"), py::arg("seconds"), py::arg("error"), py::arg("progress"))
      .def("picture", &Session::picture, py::arg("layers"))
      .def("save", &Session::save, py::arg("path"), py::call_guard<py::gil_scoped_release>())
      .def("load", &Session::load, py::arg("path"), py::call_guard<py::gil_scoped_release>())
      .def_property_readonly("settings", &Session::settings)
      .def_property_readonly("status", [](const Session& session) { return to_dict(session.status()); });
}

}  // namespace vernier::python
