// SPDX-License-Identifier: Apache-2.0
// AVIF by libavif, since OpenImageIO 2.4 reads it from files alone, not from memory, and to eight bits alone.

#include "core/image/avif.h"

#include <avif/avif.h>
#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "vernier/error.h"

namespace vernier {
namespace {

void check(avifResult result, const std::string& name) {
  if (result == AVIF_RESULT_OK) return;
  if (result == AVIF_RESULT_OUT_OF_MEMORY)
    throw Error(ErrorKind::memory, name, {}, "out of memory decoding an AVIF image");
  throw Error(ErrorKind::input, name, {},
              fmt::format("cannot decode avif image: {}", avifResultToString(result)));
}

template <typename T>
BasicImage<T> to_rgb(const avifImage& source, const std::string& name) {
  const bool has_alpha = source.alphaPlane != nullptr;
  BasicImage<T> image(int(source.width), int(source.height), has_alpha ? 4 : 3);
  avifRGBImage rgb;
  avifRGBImageSetDefaults(&rgb, &source);
  rgb.depth = 8 * sizeof(T);
  rgb.format = has_alpha ? AVIF_RGB_FORMAT_RGBA : AVIF_RGB_FORMAT_RGB;
  // libyuv is faster and rounds as the processor's vector units do: not the same on every machine.
  rgb.chromaUpsampling = AVIF_CHROMA_UPSAMPLING_BILINEAR;
  rgb.avoidLibYUV = AVIF_TRUE;
  rgb.pixels = reinterpret_cast<uint8_t*>(image.values.data());
  rgb.rowBytes = uint32_t(sizeof(T)) * uint32_t(image.width * image.channels);
  check(avifImageYUVToRGB(&source, &rgb), name);
  return image;
}

}  // namespace

CodedImage decode_avif(std::span<const uint8_t> bytes, const ImageHeader& header, const std::string& name) {
  const std::unique_ptr<avifDecoder, decltype(&avifDecoderDestroy)> decoder(avifDecoderCreate(),
                                                                            avifDecoderDestroy);
  if (!decoder) throw Error(ErrorKind::memory, name, {}, "out of memory decoding an AVIF image");
  decoder->maxThreads = 1;  // callers decode many images at once
  decoder->ignoreExif = decoder->ignoreXMP = AVIF_TRUE;
  decoder->strictFlags = AVIF_STRICT_DISABLED;  // files as they are: what browsers show
  decoder->imageSizeLimit =
      uint32_t(std::min<int64_t>(header.width * header.height, AVIF_DEFAULT_IMAGE_SIZE_LIMIT));
  check(avifDecoderSetIOMemory(decoder.get(), bytes.data(), bytes.size()), name);
  check(avifDecoderParse(decoder.get()), name);
  check(avifDecoderNextImage(decoder.get()), name);
  if (decoder->image->depth > 8) return to_rgb<uint16_t>(*decoder->image, name);
  return to_rgb<uint8_t>(*decoder->image, name);
}

}  // namespace vernier
