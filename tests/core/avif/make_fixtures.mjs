// SPDX-License-Identifier: Apache-2.0
// Makes the .avif files of this folder, lossless, with npm's sharp (0.35.5): node make_fixtures.mjs
import sharp from "sharp";

const size = 16;
const options = { lossless: true, chromaSubsampling: "4:4:4" };

function texels(Values, channels, texel) {
  const values = new Values(size * size * channels);
  for (let y = 0; y < size; ++y)
    for (let x = 0; x < size; ++x) values.set(texel(x, y), channels * (y * size + x));
  return sharp(values, { raw: { width: size, height: size, channels } });
}

await texels(Uint8Array, 3, (x, y) => [17 * x, 17 * y, 128]).avif(options).toFile("rgb.avif");
await texels(Uint8Array, 4, (x, y) => [17 * x, 17 * y, 128, 255 - 10 * y]).avif(options).toFile("rgba.avif");
// Sixteen bits in, of which the upper ten stay.
await texels(Uint16Array, 3, (x, y) => [256 * (16 * x + y), 256 * (16 * y + x), 64 * (255 - x)])
  .toColourspace("rgb16")
  .avif({ ...options, bitdepth: 10 })
  .toFile("ten_bits.avif");
