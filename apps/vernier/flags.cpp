// SPDX-License-Identifier: Apache-2.0
#include "apps/vernier/flags.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <optional>
#include <set>
#include <string_view>

#include "core/base/quantities.h"
#include "vernier/error.h"

namespace vernier::apps {

namespace {

/// The decimal number that is all of `text`, but for a plus sign in front. CLI11 itself takes 010 for eight,
/// and 0x10 for a number.
template <typename Number>
std::optional<Number> parse_decimal(std::string_view text) {
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return {};
  return value;
}

/// Takes what lies between the two, and hands it to CLI11 as it cannot be misread.
template <typename Number>
CLI::Validator number_between(Number least, Number most, const char* kind) {
  const auto check = [=](std::string& text) {
    const auto value = parse_decimal<Number>(text);
    if (!value || !(*value >= least && *value <= most))
      return fmt::format("'{}' is not a {} from {} to {}", text, kind, least, most);
    text = fmt::format("{}", *value);
    return std::string();
  };
  return {check, ""};
}

CLI::Validator amount_of_memory() {
  const auto check = [](std::string& text) -> std::string {
    try {
      text = fmt::format("{}", parse_bytes(text));
      return {};
    } catch (const Error& error) {
      return error.what();
    }
  };
  return {check, ""};
}

}  // namespace

CLI::Validator real_number(double least, double most) { return number_between(least, most, "number"); }

CLI::Validator whole_number(uint64_t least, uint64_t most) {
  return number_between(least, most, "whole number");
}

void add_threads_flag(CLI::App& command, unsigned& threads) {
  command
      .add_option("-t,--threads,--nthreads", threads, "threads to render on; 0: as many as the machine has")
      ->transform(whole_number(0, 4096))
      ->type_name("N")
      ->capture_default_str();
}

void add_scene_flags(CLI::App& command, std::string& scene, ImportOptions& options) {
  command.add_option("SCENE", scene, "glTF 2.0 scene (.gltf, .glb); - is standard input")->type_name("");
  add_import_flags(command, options);
}

void add_import_flags(CLI::App& command, ImportOptions& options) {
  const std::string group = command.option_defaults()->get_group();
  command.option_defaults()->group("Scene");
  command
      .add_option("--variant", options.variant, "variant of the materials, by name (KHR_materials_variants)")
      ->type_name("NAME");
  command.add_option("--at", options.time, "seconds into an animation (at rest)")
      ->transform(real_number(-1e9, 1e9))
      ->type_name("SECONDS");
  command
      .add_option("--animation", options.animation,
                  "animation that poses the scene, by name or number, or all (all if no two move the same, "
                  "else the first)")
      ->type_name("NAME|N|all");
  command
      .add_option(
          "--max-memory", options.memory.bytes,
          "memory that may be taken: 2G, 500M; textures that do not fit are read from a file in $TMPDIR "
          "or /var/tmp, and a scene that does not is refused (docs/textures.md)")
      ->transform(amount_of_memory())
      ->type_name("SIZE");
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
  const std::string standard_stream = "-";  // of which there are two
  for (const auto& file : read)
    if (file != standard_stream) inputs.insert(place(file));
  for (const auto& file : written) {
    if (file.empty()) continue;
    if (inputs.contains(place(file)))
      throw Error(ErrorKind::usage, file, {}, "is read and would be overwritten; name another output");
    if (!outputs.insert(place(file)).second)
      throw Error(ErrorKind::usage, file, {}, "is named for two outputs; give each a file of its own");
  }
}

void require_readable(const std::string& file) {
  if (::access(file.c_str(), R_OK) != 0)
    throw Error(ErrorKind::input, file, {}, fmt::format("cannot be read: {}", std::strerror(errno)));
}

void require_scene(const std::string& scene, const std::string& command) {
  if (scene.empty())
    throw Error(ErrorKind::usage, fmt::format("missing SCENE (.gltf, .glb); see vernier {} --help", command));
}

}  // namespace vernier::apps
