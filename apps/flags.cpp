#include "apps/flags.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <set>

#include "core/base/error.h"

namespace vernier::apps {

CLI::Validator real_number(double least, double most) {
  const auto check = [least, most](std::string& text) {
    double value = 0;
    if (CLI::detail::lexical_cast(text, value) && value >= least && value <= most) return std::string();
    return fmt::format("'{}' is not a number from {} to {}", text, least, most);
  };
  return {check, ""};
}

CLI::Validator whole_number(int least, int most) {
  const auto check = [least, most](std::string& text) {
    int value = 0;
    if (CLI::detail::lexical_cast(text, value) && value >= least && value <= most) return std::string();
    return fmt::format("'{}' is not a whole number from {} to {}", text, least, most);
  };
  return {check, ""};
}

void add_threads_flag(CLI::App& command, unsigned& threads) {
  command.add_option("-t,--threads,--nthreads", threads, "0: all of the machine's")
      ->check(whole_number(0, 4096))
      ->type_name("N")
      ->capture_default_str();
}

void add_scene_flags(CLI::App& command, std::string& scene, ImportOptions& options) {
  command.add_option("SCENE", scene, "glTF 2.0 scene (.gltf, .glb)")->type_name("");
  const std::string group = command.option_defaults()->get_group();
  command.option_defaults()->group("Scene");
  command.add_option("--variant", options.variant, "of the materials, by name (KHR_materials_variants)")
      ->type_name("NAME");
  command.add_option("--at", options.time, "seconds into an animation (at rest)")
      ->check(real_number(-1e9, 1e9))
      ->type_name("SECONDS");
  command
      .add_option(
          "--animation", options.animation,
          "that poses the scene, by name or number, or all (all if no two move the same, else the first)")
      ->type_name("NAME|N|all");
  command.add_flag("--allow-outside-files", options.allow_outside_files,
                   "read files that the scene refers to outside its folder");
  command.add_flag("--strict", options.strict, "refuse a scene that is not honoured exactly");
  command.option_defaults()->group(group);
}

void require_separate_files(const std::vector<std::string>& read, const std::vector<std::string>& written) {
  const auto place = [](const std::string& file) {
    std::error_code unknown;  // a place that cannot be looked at is refused when it is read or written
    const auto path = std::filesystem::weakly_canonical(file, unknown);
    return unknown || file.empty() ? file : path.string();
  };
  std::set<std::string> inputs, outputs;
  for (const auto& file : read) inputs.insert(place(file));
  for (const auto& file : written) {
    if (file.empty()) continue;
    if (inputs.contains(place(file)))
      throw Error(ErrorKind::usage, file, {}, "is read and would be overwritten; name another output");
    if (!outputs.insert(place(file)).second)
      throw Error(ErrorKind::usage, file, {}, "is named for two outputs; give each a file of its own");
  }
}

void require_readable(const std::string& file) {
  if (!std::ifstream(file))
    throw Error(ErrorKind::input, file, {}, fmt::format("cannot be read: {}", std::strerror(errno)));
}

void require_scene(const std::string& scene, const std::string& command) {
  if (scene.empty())
    throw Error(ErrorKind::usage,
                fmt::format("which scene? Give a .gltf or .glb file; see vernier {} --help", command));
}

}  // namespace vernier::apps
