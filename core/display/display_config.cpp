// SPDX-License-Identifier: Apache-2.0
#include "core/display/display_config.h"

#include <OpenColorIO/OpenColorIO.h>

#include <array>
#include <cstdlib>
#include <sstream>

#include "vernier/error.h"

namespace vernier {
namespace {

namespace ocio = OCIO_NAMESPACE;

constexpr const char* linear_rec709 = "Linear Rec.709";

// The matrix takes linear Rec.709 (D65) to ACES2065-1 (AP0, ACES white) with Bradford's adaptation, computed
// from the chromaticities of ITU-R BT.709-6 and SMPTE ST 2065-1. The views called neutral and AgX are
// tone-mapped before they come here.
constexpr const char* built_in_config = R"(ocio_profile_version: 2

name: vernier
description: Vernier's own config. sRGB display; scene-linear Rec.709 in.
environment: {}
search_path: ""
strictparsing: true
luma: [0.2126, 0.7152, 0.0722]

roles:
  aces_interchange: ACES2065-1
  cie_xyz_d65_interchange: CIE-XYZ-D65
  data: Raw
  default: Linear Rec.709
  scene_linear: Linear Rec.709

file_rules:
  - !<Rule> {name: Default, colorspace: default}

displays:
  sRGB:
    - !<View> {name: ACES SDR, view_transform: ACES SDR, display_colorspace: sRGB - Display}
    - !<View> {name: standard, view_transform: Un-tone-mapped, display_colorspace: sRGB - Display}
    - !<View> {name: neutral, view_transform: Un-tone-mapped, display_colorspace: sRGB - Display}
    - !<View> {name: AgX, view_transform: Un-tone-mapped, display_colorspace: sRGB - Display}
    - !<View> {name: raw, colorspace: Raw}

active_displays: [sRGB]
active_views: [ACES SDR, standard, neutral, AgX, raw]

view_transforms:
  - !<ViewTransform>
    name: Un-tone-mapped
    from_scene_reference: !<BuiltinTransform> {style: UTILITY - ACES-AP0_to_CIE-XYZ-D65_BFD}

  - !<ViewTransform>
    name: ACES SDR
    from_scene_reference: !<BuiltinTransform> {style: ACES-OUTPUT - ACES2065-1_to_CIE-XYZ-D65 - SDR-VIDEO_1.0}

display_colorspaces:
  - !<ColorSpace>
    name: CIE-XYZ-D65
    isdata: false

  - !<ColorSpace>
    name: sRGB - Display
    isdata: false
    from_display_reference: !<BuiltinTransform> {style: DISPLAY - CIE-XYZ-D65_to_sRGB}

colorspaces:
  - !<ColorSpace>
    name: ACES2065-1
    isdata: false

  - !<ColorSpace>
    name: Linear Rec.709
    isdata: false
    to_scene_reference: !<MatrixTransform> {matrix: [0.43963298191949124, 0.38298869815155400, 0.17737831992895473, 0, 0.08977644295884223, 0.81343942874898090, 0.09678412829217702, 0, 0.01754117038317271, 0.11154655330238701, 0.87091227631444050, 0, 0, 0, 0, 1]}

  - !<ColorSpace>
    name: Raw
    isdata: true
)";

// Linear Rec.709 under the names that well-known configs give it: ACES configs for OpenColorIO 2 and 1,
// Blender's.
constexpr std::array rec709_names{
    "Linear Rec.709 (sRGB)",      linear_rec709, "lin_rec709",   "lin_rec709_srgb", "Utility - Linear - sRGB",
    "Utility - Linear - Rec.709", "lin_srgb",    "Linear BT.709"};

ocio::ConstConfigRcPtr own_config() {
  std::istringstream text(built_in_config);
  return ocio::Config::CreateFromStream(text);
}

ocio::ConstConfigRcPtr read_config(const std::string& file) {
  try {
    auto config = ocio::Config::CreateFromFile(file.c_str());
    config->validate();
    return config;
  } catch (const ocio::Exception& error) {
    throw Error(ErrorKind::input, file, {},
                std::string("cannot use as an OpenColorIO config: ") + error.what());
  }
}

std::vector<std::string> views_of(const ocio::ConstConfigRcPtr& config) {
  const char* display = config->getDefaultDisplay();
  std::vector<std::string> views{config->getDefaultView(display)};
  if (views.front().empty()) return {};
  for (int i = 0; i < config->getNumViews(display); ++i)
    if (const std::string view = config->getView(display, i); view != views.front()) views.push_back(view);
  return views;
}

ocio::TransformRcPtr display_view(const ocio::ConstConfigRcPtr& config, const std::string& source,
                                  const std::string& view) {
  const auto transform = ocio::DisplayViewTransform::Create();
  transform->setSrc(source.c_str());
  transform->setDisplay(config->getDefaultDisplay());
  transform->setView(view.c_str());
  return transform;
}

// From linear Rec.709, wherever the config has it; null when it cannot be found.
ocio::TransformRcPtr view_of_rec709(const ocio::ConstConfigRcPtr& config, const std::string& view) {
  for (const char* name : rec709_names)
    if (config->getColorSpace(name)) return display_view(config, name, view);
  if (config->hasRole(ocio::ROLE_INTERCHANGE_SCENE)) {
    const auto rec709 = own_config()->getColorSpace(linear_rec709);
    const auto group = ocio::GroupTransform::Create();
    group->appendTransform(rec709->getTransform(ocio::COLORSPACE_DIR_TO_REFERENCE)->createEditableCopy());
    group->appendTransform(display_view(config, ocio::ROLE_INTERCHANGE_SCENE, view));
    return group;
  }
  if (config->hasRole(ocio::ROLE_SCENE_LINEAR)) return display_view(config, ocio::ROLE_SCENE_LINEAR, view);
  return nullptr;
}

}  // namespace

struct DisplayConfig::Wrapped {
  ocio::ConstConfigRcPtr config;
};

DisplayConfig::DisplayConfig(const std::string& file) {
  const char* environment = std::getenv("OCIO");
  name_ = !file.empty() ? file : environment ? environment : "";
  built_in_ = name_.empty();
  const auto config = built_in_ ? own_config() : read_config(name_);
  views_ = views_of(config);
  if (views_.empty())
    throw Error(ErrorKind::input, name_, {}, "the OpenColorIO config has no display with a view");
  wrapped_ = std::make_shared<const Wrapped>(Wrapped{config});
}

DisplayConfig::Transform DisplayConfig::transform(const std::string& view) const {
  const auto& config = wrapped_->config;
  try {
    const auto transform = view_of_rec709(config, view);
    if (!transform)
      throw Error(
          ErrorKind::input, name_, {},
          "cannot tell where linear Rec.709 is; the config needs the role aces_interchange or scene_linear");
    const auto processor =
        config->getProcessor(transform)->getOptimizedCPUProcessor(ocio::OPTIMIZATION_LOSSLESS);
    return [processor](std::span<float> rgb) {
      ocio::PackedImageDesc pixels(rgb.data(), long(rgb.size() / 3), 1, 3);
      processor->apply(pixels);
    };
  } catch (const ocio::Exception& error) {
    throw Error(ErrorKind::input, name_, {}, "cannot make view '" + view + "': " + error.what());
  }
}

}  // namespace vernier
