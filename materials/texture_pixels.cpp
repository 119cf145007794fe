// SPDX-License-Identifier: Apache-2.0
#include "materials/texture_pixels.h"

#include "core/image/paged_image.h"

namespace vernier {
namespace {

template <typename T>
PixelsInMemory unpacked(const std::shared_ptr<const BasicImage<T>>& image) {
  return image;
}

template <typename T>
PixelsInMemory unpacked(const std::shared_ptr<const PagedImage<T>>& image) {
  return std::make_shared<const BasicImage<T>>(image->unpacked());
}

template <typename T>
std::shared_ptr<PagedFile> file_of(const BasicImage<T>& /*image*/) {
  return nullptr;
}

template <typename T>
std::shared_ptr<PagedFile> file_of(const PagedImage<T>& image) {
  return image.file();
}

template <typename T>
uint64_t bytes_of(const BasicImage<T>& image) {
  return image.values.size() * sizeof(T);
}

template <typename T>
uint64_t bytes_of(const PagedImage<T>& image) {
  return uint64_t(image.width()) * uint64_t(image.height()) * uint64_t(image.channels()) * sizeof(T);
}

}  // namespace

PixelsInMemory in_memory(const TexturePixels& pixels) {
  return std::visit([](const auto& image) { return unpacked(image); }, pixels);
}

TexturePixels in_file(const PixelsInMemory& pixels, const std::shared_ptr<PagedFile>& file) {
  return std::visit(
      [&]<typename T>(const std::shared_ptr<const BasicImage<T>>& image) -> TexturePixels {
        if (!file || bytes_of(*image) < PagedFile::block_bytes) return image;
        return std::make_shared<const PagedImage<T>>(*image, file);
      },
      pixels);
}

std::shared_ptr<PagedFile> file_of(const TexturePixels& pixels) {
  return std::visit([](const auto& image) { return file_of(*image); }, pixels);
}

uint64_t texel_bytes(const TexturePixels& pixels) {
  return std::visit([](const auto& image) { return bytes_of(*image); }, pixels);
}

}  // namespace vernier
