// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "vernier/error.h"
#include "vernier/image.h"
#include "vernier/material.h"
#include "vernier/texture.h"
#include "vernier/transform.h"

// What a scene file says, before anything is built from it: plain data, metres, radians, +y up, right-handed.

namespace vernier {

using Triangle = std::array<uint32_t, 3>;

// What moves while the shutter is open has `moments`: what it is like then, from the opening to the closing
// of the shutter and evenly spaced; 2^n + 1 of them, at most most_moments, linear in between. None: it stands
// still. What it is like beside, `to_world` or `positions`, is the middle of the shutter.
constexpr size_t most_moments = 33;

/// A mesh at one moment; the arrays are as long as those of its MeshDescription.
struct MeshShape {
  std::vector<Vec3f> positions, normals;
  std::vector<Vec4f> tangents;
};

/// Triangles of one material. Attribute arrays are empty when absent, else as long as positions.
struct MeshDescription {
  std::string name;
  std::vector<Vec3f> positions;
  std::vector<Triangle> triangles;  ///< counter-clockwise seen from the front; every index is in range
  std::vector<Vec3f> normals;       ///< unit; empty: flat shading
  std::vector<Vec4f> tangents;      ///< xyz unit, w = +-1 handedness: bitangent = w cross(n, t)
  std::array<std::vector<Vec2f>, 2> texcoords;
  std::vector<Vec4f> colors;  ///< linear RGBA, multiplies the base colour
  std::vector<MeshShape> moments{};
  /// Sets 2 and up. The first two are interpolated with every point that needs any, these where a texture
  /// reads them.
  std::vector<std::vector<Vec2f>> more_texcoords{};

  size_t texcoord_set_count() const { return texcoords.size() + more_texcoords.size(); }
  std::vector<Vec2f>& texcoord_set(size_t n) {
    return n < texcoords.size() ? texcoords[n] : more_texcoords[n - texcoords.size()];
  }
  const std::vector<Vec2f>& texcoord_set(size_t n) const {
    return n < texcoords.size() ? texcoords[n] : more_texcoords[n - texcoords.size()];
  }
};

/// A mesh placed in the world. Several may share a mesh.
struct InstanceDescription {
  std::string name;
  uint32_t mesh = 0;
  uint32_t material = 0;
  Transform to_world;
  /// Instances of one number are parts of one object, and may enclose a volume together; none: its own.
  std::optional<uint32_t> object{};
  std::string asset{};  ///< name of what it belongs to as a whole: of the node at the top of its tree
  /// Must all mirror the mesh if `to_world` does, and none otherwise.
  std::vector<Transform> moments{};
};

/// Looks along its local -z, +y up. A panorama sees all around as EnvironmentDescription pictures it, in
/// local axes: what lies along +x is in its middle, +z a quarter of its width to the right.
struct CameraDescription {
  enum class Kind { perspective, orthographic, panorama };
  std::string name;
  Kind kind = Kind::perspective;
  float yfov = 0.8f;         ///< perspective: full vertical angle
  float aspect = 0;          ///< width over height; 0: that of the image
  float xmag = 1, ymag = 1;  ///< orthographic: half width and half height in metres
  /// Perspective: of the round opening of a thin lens, metres; 0: a pinhole.
  float lens_radius = 0;
  float focus_distance =
      1;               ///< metres along the axis to the plane that the lens shows sharp; may be infinite
  Transform to_world;  ///< orthonormal
  /// Orthonormal; turns at constant speed in between.
  std::vector<Transform> moments{};
  /// Why no picture can be taken with it, as the text of an Error; empty: one can.
  std::string defect;
};

/// KHR_lights_punctual. Position is the origin; spot and directional lights shine along local -z.
struct PunctualLightDescription {
  enum class Kind { point, spot, directional };
  std::string name;
  Kind kind = Kind::point;
  Rgb color{1, 1, 1};
  float intensity = 1;  ///< candela (point, spot) or lux (directional), taken as W/sr and W/m^2
  float range = std::numeric_limits<float>::infinity();
  float inner_cone = 0, outer_cone = 0.785398163f;  ///< half angles
  Transform to_world;
  std::vector<Transform> moments{};
};

/// Radiance from everywhere, as a latitude-longitude picture: u = atan2(z, x) / 2pi + 1/2, v = acos(y) / pi.
struct EnvironmentDescription {
  std::shared_ptr<const Image> picture;  ///< three channels
  float rotation = 0;                    ///< radians counter-clockwise about +y, applied to the picture
  float scale = 1;
};

/// How one glTF feature of the file is honoured.
struct FeatureUse {
  enum class Status { exact, approximated, ignored };
  std::string name;  ///< extension or property
  Status status = Status::exact;
  std::string note;  ///< how approximated, why ignored; with the clause of the specification where it helps
};

struct SceneDescription {
  std::string source;  ///< file it came from
  /// Tells it from other scenes; of a file, of every byte read: scene file, buffers, images. Whoever builds
  /// one from arrays may call it what they like; nothing goes on from a checkpoint of a scene without.
  std::string hash;
  /// What was chosen of what the file offers, as names and values: a variant, an animation, its time.
  std::vector<std::pair<std::string, std::string>> choices;
  std::vector<MeshDescription> meshes;
  std::vector<MaterialDescription> materials;
  std::vector<Texture> textures;
  std::vector<InstanceDescription> instances;
  std::vector<CameraDescription> cameras;
  std::vector<PunctualLightDescription> lights;
  std::shared_ptr<const EnvironmentDescription> environment;  ///< null: none
  std::vector<FeatureUse> features;
  std::vector<Notice> notices;
};

/// When the shutter opens and closes, in seconds after the time at which an animation poses the scene.
struct Shutter {
  double open = 0, close = 0;
};

/// How much memory may be taken. Where decoded textures would not fit, they are kept in a file without a
/// name, in the folder of TMPDIR or else /var/tmp, and read from it as rays meet them: the same picture,
/// later.
struct MemoryLimit {
  uint64_t bytes = 0;      ///< that the process may hold; 0: as many as it takes
  uint64_t elsewhere = 0;  ///< of these, what is to be left for pictures
  bool has_mips = false;   ///< textures of colors will be read by smaller copies too
};

/// How a file becomes a description.
struct ImportOptions {
  bool strict = false;  ///< anything not honoured exactly is an error
  std::string variant;  ///< of KHR_materials_variants, by name; empty: the materials the file has without
  /// Seconds at which an animation poses the scene. None: the scene is at rest, unless `animation` is named,
  /// which then poses it at 0.
  std::optional<double> time;
  /// Name, index, or "all" of them at once; empty: all when no two set the same thing, else the first.
  std::string animation;
  /// What an animation moves meanwhile gets moments, as many as it takes to follow its course; what else it
  /// changes is that of the middle. None: everything stands still.
  std::optional<Shutter> shutter{};
  /// Files that the scene refers to may lie outside its folder; such a reference is an error otherwise.
  bool allow_outside_files = false;
  MemoryLimit memory{};
};

/// Reads a .gltf or .glb file with all it refers to. Throws Error(input) with the file and JSON pointer, and
/// Error(usage) on a variant or an animation that the file has not.
VERNIER_API SceneDescription import_scene(const std::string& path, const ImportOptions& options = {});

/// Throws Error(input) for the first warning about the scene file: what `strict` means to notices that come
/// up only when the scene is built.
VERNIER_API void refuse_warnings(const std::string& path, std::span<const Notice> notices);

class Scene;

struct SceneOptions {
  std::string accelerator;  ///< empty: the default
};

/// Builds what answers rays. Takes the description's arrays over.
VERNIER_API std::shared_ptr<Scene> build_scene(SceneDescription description,
                                               const SceneOptions& options = {});

/// Puts an environment around a scene, in place of the one it has, if any. Not while anybody renders it.
VERNIER_API void set_environment(Scene& scene, std::shared_ptr<const EnvironmentDescription> environment);

/// What scatters light all over a scene.
struct Fog {
  float density = 0;     ///< per metre: part of the light that a short way takes, over its length
  Rgb albedo{1, 1, 1};   ///< part of it that is scattered rather than absorbed
  float anisotropy = 0;  ///< mean cosine of the deflection, in (-1, 1)
  float radius =
      0;  ///< metres, of the ball about the scene's center that it fills; 0: four times the scene's
};

/// Fills the air of a scene with fog, in place of what is there; of density 0: with nothing. Not while
/// anybody renders it. Throws Error(usage) on what no fog can be.
VERNIER_API void fill_air(Scene& scene, const Fog& fog);

/// What came up when the scene was built.
VERNIER_API const std::vector<Notice>& notices_of(const Scene& scene);

/// From where a scene is seen whole. Without angles from the front, a little to the right and from above;
/// what is flat, from its face.
struct FittedView {
  std::optional<float> azimuth, elevation;  ///< of the viewer about the scene, azimuth 0 on +z, toward +x
  float roll = 0;                           ///< of the camera, clockwise
  float yfov = 0.698131701f;                ///< 40 degrees
  bool orthographic = false;
  float margin = 0.08f;  ///< part of the picture that is left free at either end of its tighter side
};

/// A camera that sees the scene whole, as it stands, in a picture of that width over height; surroundings
/// that are far larger than the rest do not count.
VERNIER_API CameraDescription fitted_camera(const Scene& scene, float aspect, const FittedView& view = {});

/// "studio" or "sky", as --env has them; the studio is turned so that its key light comes from the camera's
/// upper left. Throws Error(usage) that lists the names there are.
VERNIER_API std::shared_ptr<const EnvironmentDescription> built_in_environment(
    const std::string& name, const CameraDescription& camera = {});
/// A latitude-longitude picture from a file. Throws Error(input).
VERNIER_API std::shared_ptr<const EnvironmentDescription> read_environment(const std::string& path);

}  // namespace vernier
