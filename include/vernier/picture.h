// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "vernier/export.h"
#include "vernier/image.h"
#include "vernier/result.h"

// What is done with pictures once they are rendered: shown, denoised, compared, merged, read and written.

namespace vernier {

/// How scene-linear values become display values.
///
/// The built-in config has one display, sRGB, with the views
/// - "ACES SDR" (default): ACES 1.x output transform for 100-nit video, by OpenColorIO's built-in transform;
/// - "standard": the sRGB transfer function, values above 1 clipped, no tone mapping;
/// - "neutral": the Khronos PBR Neutral tone mapper, for faithful product colour, then as standard;
/// - "AgX": the base look of AgX, which takes the color of bright light; "raw": the values themselves.
/// In a config of the user's, linear Rec.709 is the colour space of one of its customary names ("Linear
/// Rec.709 (sRGB)", "Utility - Linear - sRGB", ...), else reached through the role aces_interchange, else
/// taken to be the role scene_linear. Values that are not numbers become 0 and others are limited to +-65504,
/// after exposure.
struct DisplayOptions {
  std::string view = {};    ///< view name; empty: the config's default view of its default display
  std::string config = {};  ///< OpenColorIO config file; empty: $OCIO, else Vernier's built-in config
  float exposure = 0;       ///< stops: values are multiplied by 2^exposure first
};

/// Names of the views of the default display of that config, the default first.
VERNIER_API std::vector<std::string> display_views(const DisplayOptions& options = {});

/// R, G and B of a scene-linear picture, and straight alpha if it has one, as 8-bit display values. The first
/// letters of a view's name suffice. Throws Error(usage) on an unknown one and Error(input) on an unusable
/// config.
VERNIER_API Image8 to_display(const LayeredImage& picture, const DisplayOptions& options = {});

/// All channels of a picture file and the texts in its header. Throws Error(input).
VERNIER_API LayeredImage read_picture(const std::string& path);
/// Replaces a file wholly or not at all: .exr with all channels as they are; .png and .jpg as `display` shows
/// the colour, with alpha in .png. Its header holds the picture's texts. Throws Error(output), and
/// Error(usage) when the kind of file has no alpha and the picture has.
VERNIER_API void write_picture(const std::string& path, const LayeredImage& picture,
                               const DisplayOptions& display = {});
/// The bytes of such a file; `format` is "exr", "png" or "jpg".
VERNIER_API std::vector<unsigned char> encode_picture(const std::string& format, const LayeredImage& picture,
                                                      const DisplayOptions& display = {});

/// The relative RMSE of a picture, sqrt(mean((x - r)^2 / (r^2 + 0.01))) over the pixels that count, with the
/// ends of a 95 % interval.
struct DenoisedError {
  double noisy = 0;  ///< before denoising
  double rel_rmse = 0, low = 0, high = 0;
};

/// Layers that denoising wants of a render: what guides it, and the halves that its error is known by.
inline constexpr const char* layers_for_denoising = "error,half,albedo,normal,coverage";

/// Filters the noise out of a picture's colour and leaves its alpha; `filter` is one of `vernier denoise`.
/// What the picture's layer `error` held goes on as `noisyError`, beside the error after filtering, which is
/// returned; without the layer `half` it is not known. Throws Error(usage).
VERNIER_API std::optional<DenoisedError> denoise(LayeredImage& picture, const std::string& filter = "nlm");

/// The figures of `vernier compare` by name, "relmse", "flip", ...; those that ask for layers which the
/// pictures lack are left out. Throws Error(usage) when the two cannot be compared.
VERNIER_API std::map<std::string, double> compare(const LayeredImage& picture, const LayeredImage& reference);

/// Renders of one picture by different seeds, put together.
struct MergedRender {
  LayeredImage picture;
  RenderStatus status;
};

/// Of two or more files that RenderSession::save() wrote, with those of `layers` that need no scene. Throws
/// Error(input) when they are not of one picture or two have the same seed.
VERNIER_API MergedRender merge(const std::vector<std::string>& checkpoints, const std::string& layers = "");

}  // namespace vernier
