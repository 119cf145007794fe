// SPDX-License-Identifier: Apache-2.0
// A valid glTF document that uses most of what there is, with its data in it.
'use strict';
const zlib = require('zlib');

// Buffer views and accessors, filled as they are asked for.
class Data {
  constructor() {
    this.bytes = Buffer.alloc(0);
    this.bufferViews = [];
    this.accessors = [];
  }
  view(bytes, target) {
    const offset = (this.bytes.length + 3) & ~3;
    this.bytes = Buffer.concat([this.bytes, Buffer.alloc(offset - this.bytes.length), bytes]);
    const view = { buffer: 0, byteOffset: offset, byteLength: bytes.length };
    return this.bufferViews.push(target ? { ...view, target } : view) - 1;
  }
  accessor(type, values, { componentType = 5126, target, normalized, bounds = false } = {}) {
    const arrays = { 5121: Uint8Array, 5123: Uint16Array, 5126: Float32Array };
    const array = arrays[componentType].from(values);
    const width = { SCALAR: 1, VEC2: 2, VEC3: 3, VEC4: 4, MAT4: 16 }[type];
    const accessor = {
      bufferView: this.view(Buffer.from(array.buffer), target), componentType, count: array.length / width, type,
    };
    if (normalized) accessor.normalized = true;
    if (bounds)
      for (const end of ['min', 'max'])
        accessor[end] = Array.from({ length: width }, (_, c) => Math[end](...array.filter((_, i) => i % width === c)));
    return this.accessors.push(accessor) - 1;
  }
}

function png() {
  const crc = (bytes) => {
    let sum = ~0;
    for (const byte of bytes) {
      sum ^= byte;
      for (let bit = 0; bit < 8; ++bit) sum = (sum >>> 1) ^ (sum & 1 ? 0xedb88320 : 0);
    }
    return ~sum >>> 0;
  };
  const chunk = (name, content) => {
    const body = Buffer.concat([Buffer.from(name), content]);
    const length = Buffer.alloc(4), check = Buffer.alloc(4);
    length.writeUInt32BE(content.length);
    check.writeUInt32BE(crc(body));
    return Buffer.concat([length, body, check]);
  };
  const header = Buffer.from([0, 0, 0, 1, 0, 0, 0, 1, 8, 2, 0, 0, 0]);
  return Buffer.concat([Buffer.from('\x89PNG\r\n\x1a\n', 'latin1'), chunk('IHDR', header),
    chunk('IDAT', zlib.deflateSync(Buffer.from([0, 200, 100, 50]))), chunk('IEND', Buffer.alloc(0))]);
}

function materials() {
  const transform = { KHR_texture_transform: { offset: [0.5, 0], rotation: 0.3, scale: [2, 2], texCoord: 1 } };
  const texture = { index: 0, texCoord: 0, extensions: transform };
  const layered = {
    KHR_materials_anisotropy: { anisotropyStrength: 0.5, anisotropyRotation: 0.2, anisotropyTexture: texture },
    KHR_materials_clearcoat: {
      clearcoatFactor: 0.5, clearcoatRoughnessFactor: 0.1, clearcoatTexture: texture,
      clearcoatNormalTexture: { index: 0, scale: 0.5 },
    },
    KHR_materials_emissive_strength: { emissiveStrength: 2 },
    KHR_materials_ior: { ior: 1.4 },
    KHR_materials_iridescence: {
      iridescenceFactor: 0.5, iridescenceIor: 1.3, iridescenceThicknessMinimum: 100, iridescenceThicknessMaximum: 300,
      iridescenceThicknessTexture: texture,
    },
    KHR_materials_sheen: { sheenColorFactor: [0.1, 0.2, 0.3], sheenRoughnessFactor: 0.5, sheenColorTexture: texture },
    KHR_materials_specular: { specularFactor: 0.5, specularColorFactor: [1, 0.9, 0.8], specularTexture: texture },
  };
  return [
    {
      name: 'layered', alphaMode: 'MASK', alphaCutoff: 0.4, doubleSided: true, emissiveFactor: [0.1, 0.2, 0.3],
      pbrMetallicRoughness: {
        baseColorFactor: [0.8, 0.7, 0.6, 1], metallicFactor: 0.1, roughnessFactor: 0.4, baseColorTexture: texture,
        metallicRoughnessTexture: { index: 0 },
      },
      normalTexture: { index: 0, scale: 0.5 }, occlusionTexture: { index: 0, strength: 0.5 },
      emissiveTexture: { index: 0 }, extensions: layered,
    },
    {
      name: 'glass',
      extensions: {
        KHR_materials_transmission: { transmissionFactor: 0.9 },
        KHR_materials_volume: { thicknessFactor: 0.1, attenuationDistance: 2, attenuationColor: [0.5, 0.9, 0.5] },
      },
    },
    { name: 'plain', alphaMode: 'BLEND', extensions: { KHR_materials_unlit: {} } },
  ];
}

function meshes(data) {
  const vertex = { target: 34962 };
  const corners = [0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0];
  const repeated = (values) => Array.from({ length: 4 }, () => values).flat();
  const positions = () => data.accessor('VEC3', corners, { ...vertex, bounds: true });
  const lift = data.accessor('VEC3', repeated([0, 0, 1]), { bounds: true });
  data.accessors[lift].sparse = {
    count: 1, indices: { bufferView: data.view(Buffer.from([2])), byteOffset: 0, componentType: 5121 },
    values: { bufferView: data.view(Buffer.from(Float32Array.of(0, 0, 0.5).buffer)), byteOffset: 0 },
  };
  data.accessors[lift].min[2] = 0.5;
  const attributes = {
    POSITION: positions(), NORMAL: data.accessor('VEC3', repeated([0, 0, 1]), vertex),
    TANGENT: data.accessor('VEC4', repeated([1, 0, 0, 1]), vertex),
    TEXCOORD_0: data.accessor('VEC2', [0, 0, 1, 0, 0, 1, 1, 1], vertex),
    TEXCOORD_1: data.accessor('VEC2', [0, 0, 65535, 0, 0, 65535, 65535, 65535],
      { ...vertex, componentType: 5123, normalized: true }),
    COLOR_0: data.accessor('VEC4', repeated([255, 200, 100, 255]), { ...vertex, componentType: 5121, normalized: true }),
    JOINTS_0: data.accessor('VEC4', repeated([0, 1, 0, 0]), { ...vertex, componentType: 5121 }),
    WEIGHTS_0: data.accessor('VEC4', repeated([0.5, 0.5, 0, 0]), vertex),
  };
  const indices = data.accessor('SCALAR', [0, 1, 2, 2, 1, 3], { componentType: 5123, target: 34963 });
  const targets = [{ POSITION: lift, COLOR_0: data.accessor('VEC4', repeated([0, 0, 0, 0])) }];
  const mappings = [{ material: 1, variants: [0] }];
  return [
    {
      name: 'skinned', weights: [0.5],
      primitives: [{ attributes, indices, material: 0, mode: 4, targets,
        extensions: { KHR_materials_variants: { mappings } } }],
    },
    { name: 'glass', primitives: [{ attributes: { POSITION: positions() }, mode: 5, material: 1 }] },
    {
      name: 'thin',
      primitives: [0, 1, 2, 3].map((mode) => ({ attributes: { POSITION: positions() }, mode, material: 2 })),
    },
  ];
}

function animations(data) {
  const times = data.accessor('SCALAR', [0, 1], { bounds: true });
  const outputs = {
    translation: data.accessor('VEC3', [0, 0, 0, 1, 0, 0]),
    rotation: data.accessor('VEC4', [0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0]),
    scale: data.accessor('VEC3', [1, 1, 1, 2, 2, 2]),
    weights: data.accessor('SCALAR', [0, 1]),
  };
  const curves = { translation: 'LINEAR', rotation: 'CUBICSPLINE', scale: 'STEP', weights: 'LINEAR' };
  const paths = Object.keys(outputs);
  return [{
    name: 'move',
    channels: paths.map((name, sampler) => ({ sampler, target: { node: name === 'weights' ? 0 : 2, path: name } })),
    samplers: paths.map((name) => ({ input: times, output: outputs[name], interpolation: curves[name] })),
  }];
}

function everything() {
  const data = new Data();
  const image = data.view(png());
  const document = {
    asset: { version: '2.0', minVersion: '2.0', generator: 'everything.js', copyright: 'none' },
    scene: 0,
    scenes: [{ name: 'all', nodes: [0, 1, 2, 5, 6, 7, 8] }],
    nodes: [
      { name: 'skinned', mesh: 0, skin: 0, weights: [0.25] },
      { mesh: 1, matrix: [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 2, 0, 0, 1] },
      { name: 'joint', translation: [0, 0, 0], rotation: [0, 0, 0, 1], scale: [1, 1, 1], children: [3, 4] },
      { name: 'tip', translation: [0, 1, 0] },
      { name: 'eye', camera: 0, translation: [0, 0, 5] },
      { camera: 1, translation: [0, 0, 5] },
      { mesh: 2, translation: [0, 2, 0] },
      { extensions: { KHR_lights_punctual: { light: 0 } }, translation: [0, 5, 0] },
      { extensions: { KHR_lights_punctual: { light: 1 } } },
    ],
    cameras: [
      { type: 'perspective', name: 'p', perspective: { yfov: 0.8, aspectRatio: 1.5, znear: 0.1, zfar: 100 } },
      { type: 'orthographic', orthographic: { xmag: 2, ymag: 2, znear: 0, zfar: 100 } },
    ],
    meshes: meshes(data),
    materials: materials(),
    textures: [{ name: 't', source: 0, sampler: 0 }],
    images: [{ name: 'i', bufferView: image, mimeType: 'image/png' }],
    samplers: [{ magFilter: 9729, minFilter: 9987, wrapS: 33071, wrapT: 33648 }],
    skins: [{ name: 's', joints: [2, 3], skeleton: 2, inverseBindMatrices: -1 }],
    animations: animations(data),
    extensions: {
      KHR_lights_punctual: {
        lights: [
          { type: 'spot', color: [1, 0.9, 0.8], intensity: 10, range: 20,
            spot: { innerConeAngle: 0.2, outerConeAngle: 0.5 } },
          { type: 'directional', name: 'sun', intensity: 2 },
        ],
      },
      KHR_materials_variants: { variants: [{ name: 'clear' }] },
    },
  };
  const identity = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];
  document.skins[0].inverseBindMatrices = data.accessor('MAT4', [...identity, ...identity]);
  const used = JSON.stringify(document).match(/(KHR|EXT)_[a-z_]+/g);
  document.extensionsUsed = [...new Set(used)].sort();
  document.extensionsRequired = ['KHR_texture_transform'];
  document.bufferViews = data.bufferViews;
  document.accessors = data.accessors;
  const uri = `data:application/octet-stream;base64,${data.bytes.toString('base64')}`;
  document.buffers = [{ byteLength: data.bytes.length, uri }];
  return document;
}

module.exports = { everything };
