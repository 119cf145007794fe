// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "apps/bench/bench.h"
#include "apps/bench/bench_reference.h"
#include "apps/vernier/flags.h"
#include "core/base/atomic_file.h"
#include "core/base/parallel.h"
#include "core/base/quantities.h"
#include "integrators/render/render.h"
#include "scene/camera.h"
#include "scene/scene.h"

namespace vernier::apps {
namespace {

using Json = nlohmann::ordered_json;

struct BiasFlags {
  std::string size = "16x16", error, json;
  int spp = 96, pictures = 1000;
  double share = 0.05;
};

/// Radiance whose mean is known: 1 everywhere. Every other stripe of the picture is calm, between 0.5 and
/// 1.5; in the rest few samples have all the light.
class Fireflies : public Integrator {
 public:
  explicit Fireflies(double share) : share_(float(share)) {}

  Estimate estimate(const Scene& /*scene*/, const Ray& ray, Sampler& sampler,
                    const SampleContext&) const override {
    sampler.start_block(1);
    const float u = sampler.next1();
    const bool calm = std::lround(10 * ray.direction.x) % 2 == 0;
    Estimate out;
    out.radiance = Rgb(calm ? 0.5f + u : u < share_ ? 1 / share_ : 0);
    return out;
  }

 private:
  float share_;
};

/// Mean of a picture less the truth.
double error_of_mean(const Image& picture) {
  double sum = 0;
  for (const float value : picture.values) sum += value - 1.0;
  return sum / double(picture.values.size());
}

/// Errors of the means of many pictures, each of a seed of its own.
std::vector<double> measure(const BiasFlags& flags, const RenderSettings& asked) {
  const Scene nothing({}, {});
  CameraDescription view;
  view.yfov = 1.2f;
  const Camera camera(view, asked.width, asked.height);
  const Fireflies integrator(flags.share);
  std::vector<double> errors(static_cast<size_t>(flags.pictures));
  parallel_for(errors.size(), [&](size_t i) {
    RenderSettings options = asked;
    options.seed = i + 1;
    errors[i] = error_of_mean(render(nothing, camera, integrator, options, never_stop).film.image());
  });
  return errors;
}

Json summary(const std::vector<double>& errors) {
  const auto count = double(errors.size());
  double sum = 0, squares = 0;
  for (const double e : errors) sum += e;
  for (const double e : errors) squares += (e - sum / count) * (e - sum / count);
  return {{"pictures", errors.size()},
          {"bias", sum / count},
          {"standard_error", std::sqrt(squares / (count - 1) / count)}};
}

ExitCode run_bench_bias(const BiasFlags& flags, const Program& program) {
  if (!flags.json.empty()) check_writable(flags.json);
  const auto [width, height] = parse_pixel_size(flags.size);
  RenderSettings options;
  options.width = width;
  options.height = height;
  options.limits.spp = flags.spp;
  if (!flags.error.empty()) {
    options.limits.spp = 0;
    options.limits.error = parse_fraction(flags.error);
  }
  Json report = bench_header(program);
  report["width"] = width;
  report["height"] = height;
  report["share"] = flags.share;
  for (const bool adaptive : {true, false}) {
    options.adaptive = adaptive;
    const Json& found = report[adaptive ? "adaptive" : "even"] = summary(measure(flags, options));
    fmt::print("{:<9} bias {:+.4f} %, standard error {:.4f} %\n",
               adaptive ? "adaptive:" : "even:", 100 * found["bias"].get<double>(),
               100 * found["standard_error"].get<double>());
  }
  if (!flags.json.empty()) write_file(flags.json, report.dump(2) + "\n");
  return ExitCode::done;
}

}  // namespace

void register_bench_bias(CLI::App& bench, Program& program) {
  CLI::App* command =
      bench.add_subcommand("bias", "Whether sampling that adapts to what it finds is right in the mean");
  auto flags = std::make_shared<BiasFlags>();
  command->add_option("--pictures", flags->pictures, "pictures, each of a seed of its own")
      ->check(whole_number(2, 100'000'000))
      ->type_name("N")
      ->capture_default_str();
  command->add_option("--size", flags->size, "of a picture")
      ->check(parsed_by(parse_pixel_size))
      ->type_name("WxH")
      ->capture_default_str();
  command->add_option("--spp", flags->spp, "samples a pixel of each picture")
      ->check(whole_number(1, 1 << 30))
      ->type_name("N")
      ->capture_default_str();
  command->add_option("--error", flags->error, "instead: stop each picture at this estimated error")
      ->check(parsed_by(parse_fraction))
      ->type_name("ERROR");
  command->add_option("--share", flags->share, "part of the samples that have light, in every other stripe")
      ->check(CLI::Range(1e-6, 1.0))
      ->type_name("PART")
      ->capture_default_str();
  command->add_option("--json", flags->json, "write the figures as JSON")->type_name("FILE");
  command->callback(
      [&program, flags] { program.run = [&program, flags] { return run_bench_bias(*flags, program); }; });
}

}  // namespace vernier::apps
