#include "integrators/checkpoint.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "core/base/text_file.h"
#include "scene/import/asset_files.h"

namespace vernier {
namespace {

using Json = nlohmann::ordered_json;

static_assert(std::endian::native == std::endian::little, "checkpoints are little-endian");
static_assert(sizeof(RenderResult::Look) == 6 * sizeof(double));

constexpr uint32_t format = 2;
constexpr size_t fingerprint_length = 32;
constexpr uint32_t longest_header = 1 << 20;

/// How a file begins.
struct Preamble {
  std::array<char, 8> magic{'V', 'E', 'R', 'N', 'C', 'K', 'P', 'T'};
  uint32_t format = vernier::format;
  uint32_t header_length = 0;
  std::array<char, fingerprint_length> header_fingerprint{};  ///< hexadecimal, of the header
};
static_assert(sizeof(Preamble) == 16 + fingerprint_length);

std::string fingerprint_of(std::span<const std::byte> bytes) {
  return fingerprint({reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()});
}

/// Constant bytes of constant values.
template <typename Values>
auto bytes_of(Values& values) {
  const std::span span(values);
  if constexpr (std::is_const_v<typename decltype(span)::element_type>)
    return std::as_bytes(span);
  else
    return std::as_writable_bytes(span);
}

/// Calls visit(name, bytes) for each array of a state, in the file's order.
template <typename State, typename Plan, typename Visit>
void for_each_array(State& state, Plan& plan_counts, const Visit& visit) {
  visit("film", state.so_far.film.bytes());
  visit("guide 1", state.guides[0].bytes());
  visit("guide 2", state.guides[1].bytes());
  visit("extra", bytes_of(state.drawn.extra));
  visit("light", bytes_of(state.light));
  visit("plan", bytes_of(plan_counts));
  visit("parts", bytes_of(state.parts));
  visit("looks", bytes_of(state.so_far.convergence));
  visit("bad samples", bytes_of(state.so_far.bad_sample_examples));
}

Json header_of(const RenderIdentity& identity, const RenderState& state) {
  const RenderResult& so_far = state.so_far;
  const SamplePlan::Numbers& pass = state.pass.numbers();
  Json header{{"render", Json::array()},
              {"width", so_far.film.width()},
              {"height", so_far.film.height()},
              {"adaptive", !state.guides[0].bytes().empty()},
              {"done", state.done},
              {"guiding", state.drawn.guiding},
              {"looked_at", state.looked_at},
              {"pass", {{"size", pass.size}, {"odd_half", pass.odd_half}, {"guiding", pass.guiding}}},
              {"seconds", so_far.seconds},
              {"samples", so_far.samples},
              {"rays", {so_far.rays.camera, so_far.rays.bounce, so_far.rays.shadow}},
              {"bad_samples", so_far.bad_samples},
              {"arrays", Json::array()}};
  for (const auto& [name, value] : identity) header["render"].push_back(Json::array({name, value}));
  return header;
}

/// Reads a file from its beginning to its end.
class Reader {
 public:
  explicit Reader(const std::string& path) : path_(path), file_(std::fopen(path.c_str(), "rb")) {
    std::error_code error;
    if (file_) left_ = std::filesystem::file_size(path, error);
    if (!file_ || error)
      throw Error(ErrorKind::input, path, {},
                  fmt::format("cannot be read: {}", error ? error.message() : std::strerror(errno)));
  }

  uintmax_t left() const { return left_; }
  void read(std::span<std::byte> bytes) {
    if (bytes.empty()) return;  // an empty array need not be anywhere, and fread wants a place
    if (bytes.size() > left_ || std::fread(bytes.data(), 1, bytes.size(), file_.get()) != bytes.size())
      damaged("it is cut short");
    left_ -= bytes.size();
  }
  [[noreturn]] void damaged(const std::string& how) const {
    throw Error(ErrorKind::input, path_, {},
                fmt::format("is damaged: {}; use another checkpoint or render without --resume", how));
  }
  [[noreturn]] void refuse(const std::string& reason) const {
    throw Error(ErrorKind::input, path_, {}, reason);
  }

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::string path_;
  std::unique_ptr<std::FILE, Close> file_;
  uintmax_t left_ = 0;
};

Json read_header(Reader& reader) {
  Preamble preamble;
  if (reader.left() < sizeof(preamble)) reader.refuse("is not a checkpoint of 'vernier render'");
  reader.read(std::as_writable_bytes(std::span(&preamble, 1)));
  if (preamble.magic != Preamble().magic) reader.refuse("is not a checkpoint of 'vernier render'");
  if (preamble.format != format)
    reader.refuse(
        fmt::format("is a checkpoint of format {}; this version reads format {}", preamble.format, format));
  if (preamble.header_length > longest_header) reader.damaged("its header is too long");
  std::string text(preamble.header_length, ' ');
  reader.read(std::as_writable_bytes(std::span(text)));
  if (fingerprint_of(std::as_bytes(std::span(text))) !=
      std::string_view(preamble.header_fingerprint.data(), fingerprint_length))
    reader.damaged("its header has changed");
  return Json::parse(text);
}

/// Sizes are checked against each other and the file before memory is taken for them.
void read_state(Reader& reader, const Json& header, Checkpoint& checkpoint) {
  for (const Json& pair : header.at("render"))
    checkpoint.identity.emplace_back(pair.at(0).get<std::string>(), pair.at(1).get<std::string>());
  const Json& arrays = header.at("arrays");
  uintmax_t bytes = 0;
  for (const Json& array : arrays) bytes += array.at("bytes").get<uint64_t>();
  if (bytes != reader.left())
    reader.damaged(fmt::format("{} bytes follow its header, expected {}", reader.left(), bytes));
  const int width = header.at("width"), height = header.at("height");
  constexpr int most = 1 << 16;
  if (width < 1 || height < 1 || width > most || height > most ||
      uintmax_t(width) * uintmax_t(height) > bytes)
    reader.damaged("the size of its picture");

  checkpoint.state = std::make_shared<RenderState>(width, height, header.at("adaptive").get<bool>());
  RenderState& state = *checkpoint.state;
  RenderResult& so_far = state.so_far;
  state.done = header.at("done");
  header.at("guiding").get_to(state.drawn.guiding);
  state.looked_at = header.at("looked_at");
  so_far.seconds = header.at("seconds");
  so_far.samples = header.at("samples");
  const Json& rays = header.at("rays");
  so_far.rays = {rays.at(0), rays.at(1), rays.at(2)};
  so_far.bad_samples = header.at("bad_samples");

  SamplePlan::Numbers pass;
  const Json& pass_header = header.at("pass");
  pass.width = width;
  pass.size = pass_header.at("size");
  pass.odd_half = pass_header.at("odd_half");
  pass.guiding = pass_header.at("guiding");
  const auto count = [&](size_t array, size_t element) {
    return arrays.at(array).at("bytes").get<uint64_t>() / element;
  };
  if (count(5, sizeof(uint16_t)) > 0) pass.counts.resize(state.drawn.extra.size());
  if (pass.size > 0) state.parts.resize(size_t(state.tile_count()));
  so_far.convergence.resize(count(7, sizeof(RenderResult::Look)));
  so_far.bad_sample_examples.resize(count(8, sizeof(BadSample)));

  size_t i = 0;
  for_each_array(state, pass.counts, [&](const char* name, std::span<std::byte> array) {
    const Json& described = arrays.at(i++);
    if (described.at("name") != name || described.at("bytes") != array.size())
      reader.damaged(fmt::format("its '{}' has not the size that this build gives it", name));
    reader.read(array);
    if (described.at("fingerprint") != fingerprint_of(array))
      reader.damaged(fmt::format("its '{}' has changed", name));
  });
  state.pass = SamplePlan(std::move(pass));
}

}  // namespace

void write_checkpoint(const std::string& path, const RenderIdentity& identity, const RenderState& state) {
  Json header = header_of(identity, state);
  std::vector<std::span<const std::byte>> parts(2);
  for_each_array(state, state.pass.numbers().counts, [&](const char* name, std::span<const std::byte> array) {
    header["arrays"].push_back(
        {{"name", name}, {"bytes", array.size()}, {"fingerprint", fingerprint_of(array)}});
    parts.push_back(array);
  });
  const std::string text = header.dump(-1, ' ', false, Json::error_handler_t::replace);
  Preamble preamble;
  preamble.header_length = uint32_t(text.size());
  fingerprint_of(std::as_bytes(std::span(text))).copy(preamble.header_fingerprint.data(), fingerprint_length);
  parts[0] = std::as_bytes(std::span(&preamble, 1));
  parts[1] = std::as_bytes(std::span(text));
  write_file_safely(path, parts);
}

Checkpoint read_checkpoint(const std::string& path) {
  Reader reader(path);
  Checkpoint checkpoint;
  try {
    read_state(reader, read_header(reader), checkpoint);
  } catch (const Json::exception& error) {
    reader.damaged(error.what());
  }
  return checkpoint;
}

std::string take(RenderIdentity& identity, const std::string& name) {
  const auto found =
      std::find_if(identity.begin(), identity.end(), [&](const auto& pair) { return pair.first == name; });
  if (found == identity.end()) return {};
  std::string value = std::move(found->second);
  identity.erase(found);
  return value;
}

void require_same_render(const std::string& path, const RenderIdentity& checkpoint,
                         const RenderIdentity& wanted) {
  const auto value = [](const RenderIdentity& identity, const std::string& name) {
    const auto found =
        std::find_if(identity.begin(), identity.end(), [&](const auto& pair) { return pair.first == name; });
    return found == identity.end() ? std::string("none") : found->second;
  };
  RenderIdentity all = wanted;
  for (const auto& pair : checkpoint)
    if (value(wanted, pair.first) == "none") all.push_back(pair);
  std::string differences;
  for (const auto& [name, any] : all)
    if (value(checkpoint, name) != value(wanted, name))
      differences += fmt::format("{}{} was {}, is {}", differences.empty() ? "" : "; ", name,
                                 value(checkpoint, name), value(wanted, name));
  if (!differences.empty())
    throw Error(ErrorKind::input, path, {}, fmt::format("is of another render: {}", differences));
}

}  // namespace vernier
