#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
#include <cctype>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include "core/base/error.h"
#include "core/image/image_io.h"

namespace vernier {
namespace {

namespace fs = std::filesystem;

Error output_error(const std::string& file, const std::string& problem) {
  return Error(ErrorKind::output, file, {}, problem);
}

// A new empty file in the folder of `path`, removed at the end unless it was given its final name. A process
// that is killed leaves at most this file, never a partial one called `path`.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string& path) : final_(fs::path(path)) {
    std::error_code error;
    // Through a symbolic link the file it points to is replaced, not the link.
    if (fs::is_symlink(final_, error)) final_ = fs::weakly_canonical(final_, error);
    static std::atomic<unsigned> counter{0};
    int descriptor = -1;
    do {
      const std::string name =
          ".vernier-" + std::to_string(getpid()) + "-" + std::to_string(counter++) + ".tmp";
      temporary_ = final_.parent_path() / name;
      descriptor = ::open(temporary_.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0666);
    } while (descriptor < 0 && errno == EEXIST);
    if (descriptor < 0) throw output_error(path, fmt::format("cannot write image: {}", std::strerror(errno)));
    ::close(descriptor);
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile() {
    if (!temporary_.empty()) ::unlink(temporary_.c_str());
  }

  std::string path() const { return temporary_.string(); }

  void give_final_name() {
    if (::rename(temporary_.c_str(), final_.c_str()) != 0)
      throw output_error(final_.string(), fmt::format("cannot replace file: {}", std::strerror(errno)));
    temporary_.clear();
  }

 private:
  fs::path final_, temporary_;
};

void write_image(const std::string& path, const std::string& target, const char* format,
                 const OIIO::ImageSpec& spec, const void* pixels, OIIO::Filesystem::IOProxy* proxy) {
  const auto output = OIIO::ImageOutput::create(format);
  if (!output)
    throw output_error(path, fmt::format("this OpenImageIO cannot write {}: {}", format, OIIO::geterror()));
  if (proxy) output->set_ioproxy(proxy);
  if (!output->open(target, spec) || !output->write_image(spec.format, pixels) || !output->close())
    throw output_error(path, fmt::format("cannot write image: {}", output->geterror()));
}

void set_metadata(OIIO::ImageSpec& spec, const Metadata& metadata, bool as_lines) {
  std::string lines;
  for (const auto& [name, value] : metadata) {
    spec.attribute(name, value);
    lines += fmt::format("{}: {}\n", name, value);
  }
  if (as_lines && !lines.empty()) spec.attribute("ImageDescription", lines);
}

// Encoded in memory first: on a full disk libpng's writer says nothing and libjpeg's ends the process.
std::vector<unsigned char> encode_image8(const std::string& path, const char* format, const Image8& image,
                                         const Metadata& metadata) {
  if (image.empty()) throw output_error(path, "image has no pixels");
  OIIO::ImageSpec spec(image.width, image.height, image.channels, OIIO::TypeUInt8);
  spec.attribute("oiio:ColorSpace", "sRGB");
  spec.attribute("oiio:UnassociatedAlpha", 1);
  const bool jpeg = std::strcmp(format, "jpeg") == 0;
  if (jpeg) {
    spec.attribute("compression", "jpeg:95");
    spec.attribute("jpeg:subsampling", "4:4:4");
  }
  set_metadata(spec, metadata, jpeg);
  std::vector<unsigned char> bytes;
  OIIO::Filesystem::IOVecOutput memory(bytes);
  write_image(path, fmt::format("memory.{}", format), format, spec, image.values.data(), &memory);
  return bytes;
}

void write_bytes(const std::string& path, const std::string& target,
                 const std::vector<unsigned char>& bytes) {
  std::FILE* file = std::fopen(target.c_str(), "wb");
  const bool written = file && std::fwrite(bytes.data(), 1, bytes.size(), file) == bytes.size();
  const int write_error = errno;
  const bool closed = file && std::fclose(file) == 0;
  if (!written || !closed)
    throw output_error(path,
                       fmt::format("cannot write image: {}", std::strerror(written ? errno : write_error)));
}

// OpenImageIO's name of the format that a path's extension asks for; null when it is none of ours.
const char* format_of(const std::string& path) {
  std::string extension = fs::path(path).extension().string();
  for (char& c : extension) c = char(std::tolower(static_cast<unsigned char>(c)));
  if (extension == ".exr") return "openexr";
  if (extension == ".png") return "png";
  if (extension == ".jpg" || extension == ".jpeg") return "jpeg";
  return nullptr;
}

}  // namespace

void write_exr(const std::string& path, const Image& image, const std::vector<std::string>& channel_names,
               const Metadata& metadata) {
  if (image.empty() || channel_names.size() != size_t(image.channels))
    throw output_error(path, fmt::format("image has {} channels and {} channel names", image.channels,
                                         channel_names.size()));
  OIIO::ImageSpec spec(image.width, image.height, image.channels, OIIO::TypeFloat);
  spec.channelnames = channel_names;
  spec.alpha_channel = spec.channelindex("A");
  spec.attribute("compression", "zip");
  // Red, green, blue and white of Rec.709 (ITU-R BT.709-6, 1.3 and 1.4).
  const float chromaticities[8] = {0.64f, 0.33f, 0.30f, 0.60f, 0.15f, 0.06f, 0.3127f, 0.3290f};
  spec.attribute("chromaticities", OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8), chromaticities);
  // An empty date is left out; without it OpenImageIO writes the time of day, and no two files are alike.
  spec.attribute("DateTime", "");
  set_metadata(spec, metadata, false);
  TemporaryFile file(path);
  write_image(path, file.path(), "openexr", spec, image.values.data(), nullptr);
  file.give_final_name();
}

void write_image8(const std::string& path, const Image8& image, const Metadata& metadata) {
  const char* format = format_of(path);
  if (!format || std::strcmp(format, "openexr") == 0)
    throw output_error(path, "cannot write 8-bit values to this kind of file; use .png or .jpg");
  const std::vector<unsigned char> bytes = encode_image8(path, format, image, metadata);
  TemporaryFile file(path);
  write_bytes(path, file.path(), bytes);
  file.give_final_name();
}

std::vector<unsigned char> encode_png(const Image8& image) {
  return encode_image8("picture", "png", image, {});
}

void check_writable_image(const std::string& path) {
  if (!format_of(path))
    throw output_error(path, "cannot write this kind of image; end the name in .exr, .png or .jpg");
  std::error_code error;
  const fs::path folder = fs::path(path).has_parent_path() ? fs::path(path).parent_path() : fs::path(".");
  if (!fs::exists(folder, error))
    throw output_error(path, fmt::format("folder '{}' does not exist; create it first", folder.string()));
  if (!fs::is_directory(folder, error))
    throw output_error(path, fmt::format("'{}' is not a folder", folder.string()));
  if (fs::is_directory(path, error)) throw output_error(path, "is a folder; name a file in it");
  if (::access(folder.c_str(), W_OK | X_OK) != 0)
    throw output_error(path,
                       fmt::format("cannot write in folder '{}': {}", folder.string(), std::strerror(errno)));
  if (fs::exists(path, error) && ::access(path.c_str(), W_OK) != 0)
    throw output_error(path, fmt::format("cannot replace the file: {}", std::strerror(errno)));
}

}  // namespace vernier
