// SPDX-License-Identifier: Apache-2.0
#include "scene/import/image_light.h"

#include <ImathQuat.h>
#include <fmt/format.h>

#include <array>

#include "core/base/parallel.h"
#include "scene/import/ordered_parallel.h"
#include "scene/import/textures.h"

namespace vernier {
namespace {

constexpr const char* extension_name = "EXT_lights_image_based";

/// Linear radiance of a face. Four channels are RGBD: colour over alpha (HDR Images, RGBD).
template <typename T>
Image to_radiance(const BasicImage<T>& pixels) {
  constexpr float most = std::numeric_limits<T>::max();
  Image face(pixels.width, pixels.height, 3);
  const auto is_gray = pixels.channels < 3;
  for (int y = 0; y < face.height; ++y)
    for (int x = 0; x < face.width; ++x) {
      const T* texel = pixels.pixel(x, y);
      const float divisor = pixels.channels == 4 ? float(texel[3]) / most : 1;
      for (int c = 0; c < 3; ++c) {
        const float light = srgb_to_linear(float(texel[is_gray ? 0 : c]) / most);
        face.pixel(x, y)[c] = divisor > 0 ? light / divisor : 0;
      }
    }
  return face;
}

/// Six faces, +x -x +y -y +z -z, each as it is seen from inside: the extension mirrors the usual cube map,
/// which is seen from outside.
class CubeMap {
 public:
  explicit CubeMap(std::array<Image, 6> faces) : faces_(std::move(faces)) {}

  int size() const { return faces_[0].width; }

  Rgb radiance(const Vec3f& w) const {
    const Vec3f a = abs(w);
    const int axis = a.x >= a.y && a.x >= a.z ? 0 : a.y >= a.z ? 1 : 2;
    const float sign = w[axis] < 0 ? -1.f : 1.f;
    const int face = 2 * axis + (w[axis] < 0);
    // To the right and downward, seen from inside.
    const Vec2f place = axis == 0   ? Vec2f(sign * w.z, -w.y)
                        : axis == 1 ? Vec2f(-w.x, sign * w.z)
                                    : Vec2f(-sign * w.x, -w.y);
    return interpolate(faces_[size_t(face)], place / a[axis]);
  }

 private:
  /// At a place in [-1, 1]^2.
  static Rgb interpolate(const Image& face, const Vec2f& place) {
    const float last = float(face.width - 1);
    const float x = std::clamp((place.x + 1) / 2 * float(face.width) - 0.5f, 0.f, last);
    const float y = std::clamp((place.y + 1) / 2 * float(face.width) - 0.5f, 0.f, last);
    const int x0 = int(x), y0 = int(y);
    const int x1 = std::min(x0 + 1, face.width - 1), y1 = std::min(y0 + 1, face.width - 1);
    const float fx = x - float(x0), fy = y - float(y0);
    return (rgb_at(face, x0, y0) * (1 - fx) + rgb_at(face, x1, y0) * fx) * (1 - fy) +
           (rgb_at(face, x0, y1) * (1 - fx) + rgb_at(face, x1, y1) * fx) * fy;
  }

  std::array<Image, 6> faces_;
};

/// The cube turned by `rotation`. Texels along the horizon are as wide as a face's in its middle.
Image to_latitude_longitude(const CubeMap& cube, const Imath::Quatf& rotation) {
  constexpr int largest = 1024;  // face whose detail is kept: a picture of 4096 x 2048
  const int height = 2 * std::min(cube.size(), largest), width = 2 * height;
  const int steps = std::max(2, 2 * cube.size() / largest);  // readings across a texel
  const Imath::Quatf back = rotation.inverse();
  Image picture(width, height, 3);
  parallel_for(size_t(height), [&](size_t row) {
    for (int x = 0; x < width; ++x) {
      Rgb sum(0, 0, 0);
      for (int i = 0; i < steps * steps; ++i) {
        const int column = x * steps + i % steps, line = int(row) * steps + i / steps;
        const float u = (float(column) + 0.5f) / float(width * steps);
        const float v = (float(line) + 0.5f) / float(height * steps);
        const float phi = (2 * u - 1) * pi, theta = v * pi, r = std::sin(theta);
        sum += cube.radiance(back.rotateVector(Vec3f(r * std::cos(phi), std::cos(theta), r * std::sin(phi))));
      }
      for (int c = 0; c < 3; ++c) picture.pixel(x, int(row))[c] = sum[c] / float(steps * steps);
    }
  });
  return picture;
}

class ImageLightReader {
 public:
  ImageLightReader(const Document& document, int index)
      : document_(document),
        light_(document.model().extensions.at(extension_name).Get("lights").Get(size_t(index))),
        place_(fmt::format("/extensions/{}/lights/{}", extension_name, index)) {}

  std::shared_ptr<const EnvironmentDescription> read(std::vector<Notice>& notices,
                                                     std::vector<std::string>& fingerprints) const {
    const auto& images = light_.Get("specularImages").Get(0);
    std::array<DecodedImage, 6> decoded;
    for_each_in_parallel(6, [&](size_t i) {
      decoded[i] = decode_image(document_, images.Get(i).GetNumberAsInt());
      check(decoded[i], images.Get(i).GetNumberAsInt());
    });
    std::array<Image, 6> faces;
    bool bounded = true;
    for (size_t i = 0; i < 6; ++i) {
      std::visit(
          [&](const auto& face) {
            faces[i] = to_radiance(*face);
            bounded = bounded && face->channels != 4;
          },
          in_memory(*decoded[i].pixels));
      if (!decoded[i].fingerprint.empty()) fingerprints.push_back(decoded[i].fingerprint);
      for (const auto& remark : decoded[i].remarks)
        notices.push_back(
            {Notice::Severity::warning, fmt::format("/images/{}", images.Get(i).GetNumberAsInt()), remark});
    }
    auto environment = std::make_shared<EnvironmentDescription>();
    environment->picture =
        std::make_shared<const Image>(to_latitude_longitude(CubeMap(std::move(faces)), rotation(notices)));
    if (light_.Has("intensity")) environment->scale = float(light_.Get("intensity").GetNumberAsDouble());
    if (bounded)
      notices.push_back(
          {Notice::Severity::info, place_ + "/specularImages",
           "images without alpha hold no light brighter than the light's intensity, so a sun in them is "
           "dimmed; --env FILE takes a picture without that limit"});
    return environment;
  }

 private:
  void check(const DecodedImage& image, int index) const {
    const std::string place = fmt::format("/images/{}", index);
    if (!image.pixels) document_.fail(place, "the light's image cannot be read: " + image.problem);
    const int size = light_.Get("specularImageSize").GetNumberAsInt();
    std::visit(
        [&](const auto& face) {
          if (face->width != size || face->height != size)
            document_.fail(
                place, fmt::format("{0} x {0} pixels expected, the specularImageSize of the light that uses "
                                   "it; there are {1} x {2}",
                                   size, face->width, face->height));
        },
        in_memory(*image.pixels));
  }

  Imath::Quatf rotation(std::vector<Notice>& notices) const {
    if (!light_.Has("rotation")) return {};
    const auto value = [&](size_t i) { return light_.Get("rotation").Get(i).GetNumberAsDouble(); };
    Imath::Quatd rotation(value(3), value(0), value(1), value(2));
    const double largest =
        std::max({std::abs(value(0)), std::abs(value(1)), std::abs(value(2)), std::abs(value(3))});
    if (!(largest > 0)) document_.fail(place_ + "/rotation", "a rotation must not be zero");
    rotation /= largest;  // squares of any numbers might be too large or too small
    if (std::abs(largest * rotation.length() - 1) > 0.01)
      notices.push_back({Notice::Severity::warning, place_ + "/rotation",
                         "the rotation was not of unit length and was scaled"});
    return Imath::Quatf(rotation.normalized());
  }

  const Document& document_;
  const tinygltf::Value& light_;
  std::string place_;
};

}  // namespace

std::shared_ptr<const EnvironmentDescription> read_image_light(const Document& document,
                                                               std::vector<Notice>& notices,
                                                               std::vector<std::string>& fingerprints) {
  const auto& model = document.model();
  if (model.scenes.empty()) return nullptr;
  const auto& extensions = model.scenes[size_t(std::max(model.defaultScene, 0))].extensions;
  const auto use = extensions.find(extension_name);
  if (use == extensions.end()) return nullptr;
  return ImageLightReader(document, use->second.Get("light").GetNumberAsInt()).read(notices, fingerprints);
}

}  // namespace vernier
