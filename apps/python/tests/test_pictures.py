# SPDX-License-Identifier: Apache-2.0
"""What is done with pictures, and what is known of them."""

import importlib.metadata
import importlib.util
import os
import pathlib
import struct
import subprocess
import sys

import numpy as np
import pytest

import vernier

SIZE = (48, 32)


@pytest.fixture(scope="module")
def image(cornell):
    return vernier.render(cornell, size=SIZE, spp=16, aov=["error", "half", "albedo", "normal", "coverage"])


def test_files_give_back_all(image, tmp_path):
    image.save(tmp_path / "a.exr")
    again = vernier.read(tmp_path / "a.exr")
    assert again.pixels.tobytes() == image.pixels.tobytes()
    assert {name: values.tobytes() for name, values in again.layers.items()} == {
        name: values.tobytes() for name, values in image.layers.items()}
    assert again.error == pytest.approx(image.error, rel=1e-5)
    assert again.metadata["vernier:seed"] == "0"


def test_nothing_is_half_written(image, tmp_path):
    with pytest.raises(vernier.OutputError, match="cannot be written"):
        image.save(tmp_path / "none" / "a.exr")
    with pytest.raises(vernier.OutputError, match="end the name in .exr, .png or .jpg"):
        image.save(tmp_path / "a.bmp")
    assert not list(tmp_path.iterdir())


def test_display_values_are_those_of_the_png(image, tmp_path):
    shown = image.to_display(view="standard", exposure=1)
    assert shown.shape == (32, 48, 3) and shown.dtype == np.uint8
    image.save(tmp_path / "a.png", view="standard", exposure=1)
    assert np.array_equal(np.rint(255 * vernier.read(tmp_path / "a.png").pixels).astype(np.uint8), shown)
    linear = np.clip(2 * image.pixels, 0, 1)
    srgb = np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear**(1 / 2.4) - 0.055)
    assert np.abs(shown - 255 * srgb).max() < 1
    assert np.array_equal(vernier.to_display(image.pixels, view="standard", exposure=1), shown)
    with pytest.raises(vernier.UsageError, match="unknown view 'pale'"):
        image.to_display(view="pale")


def test_notebooks_get_a_png(image):
    data = image._repr_png_()
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    assert struct.unpack(">II", data[16:24]) == SIZE
    assert "error" in repr(image) and "%" in repr(image)


def test_transparent_pictures_have_alpha(make_square, tmp_path):
    image = vernier.render(vernier.load(make_square()), size=SIZE, spp=4, env="sky", background="transparent")
    assert image.alpha.shape == (32, 48)
    assert image.alpha.min() == 0 and image.alpha.max() == 1
    assert image.to_display().shape == (32, 48, 4)
    with pytest.raises(vernier.UsageError, match="no alpha"):
        image.save(tmp_path / "a.jpg")


@pytest.mark.skipif(not importlib.util.find_spec("pyoidn"), reason="needs pyoidn: pip install .[denoise]")
def test_open_image_denoise_itself(cornell, image, command, tmp_path):
    clean = image.denoise("oidn")
    truth = vernier.render(cornell, size=SIZE, spp=400, seed=1)
    before, after = (vernier.compare(picture, truth)["relmse"]**0.5 for picture in (image, clean))
    assert after < before / 1.2
    assert clean.error.low < after < clean.error.high
    assert "pyoidn" in os.environ["VERNIER_OIDN"]
    assert vernier.compare(image.denoise("auto"), clean)["relmse"] < 1e-6
    image.save(tmp_path / "noisy.exr")
    done = command("denoise", "noisy.exr", "-o", "clean.exr", "--filter", "oidn")
    assert done.returncode == 0, done.stderr
    assert vernier.compare(vernier.read(tmp_path / "clean.exr"), clean)["relmse"] < 1e-6


def test_denoised_pictures_know_their_error(cornell, image):
    clean = image.denoise()
    truth = vernier.render(cornell, size=SIZE, spp=400, seed=1)
    before, after = (vernier.compare(picture, truth)["relmse"]**0.5 for picture in (image, clean))
    assert after < before
    assert clean.error.rel_rmse == pytest.approx(after, rel=0.5)
    assert clean.denoised_from == pytest.approx(image.error.rel_rmse, rel=0.3)
    assert "noisyError" in clean.layers and "noisyError" not in image.layers
    with pytest.raises(vernier.UsageError, match="unknown filter 'wish'"):
        image.denoise("wish")
    bare = vernier.render(cornell, size=SIZE, spp=4).denoise("median")
    assert bare.denoised_from is None


def test_figures_of_a_comparison(image, tmp_path):
    image.save(tmp_path / "a.exr")
    same = vernier.compare(image, tmp_path / "a.exr")
    assert same["mse"] == 0 and same["differing"] == 0 and same["psnr"] == np.inf
    other = image.pixels + np.float32(0.5)
    figures = vernier.compare(other, image.pixels)
    assert figures["mae"] == pytest.approx(0.5, abs=1e-4)
    assert figures["rmse"] == pytest.approx(0.5, abs=1e-4)
    assert "differing" not in figures
    with pytest.raises(vernier.UsageError, match="pictures of one kind"):
        vernier.compare(image, image.to_display())
    with pytest.raises(vernier.UsageError, match="expected an Image"):
        vernier.compare(image, np.zeros((2, 2)))


def test_merge_refuses_what_does_not_belong_together(cornell, tmp_path):
    session = vernier.Session(cornell, size=(8, 8))
    session.run(spp=2)
    session.save(tmp_path / "a.ckpt")
    with pytest.raises(vernier.UsageError, match="expected two or more"):
        vernier.merge([tmp_path / "a.ckpt"])
    with pytest.raises(vernier.InputError, match="has the seed 0"):
        vernier.merge([tmp_path / "a.ckpt", tmp_path / "a.ckpt"])


def test_module_is_typed(tmp_path):
    """What is installed for type checkers agrees with the module."""
    folder = pathlib.Path(vernier.__file__).parent
    assert (folder / "py.typed").exists()
    pytest.importorskip("mypy", reason="mypy is not installed")
    program = "import vernier\nimage = vernier.render(vernier.load('a.glb'))\nreveal_type(image.error)\n"
    done = subprocess.run([sys.executable, "-m", "mypy", "-c", program, "--cache-dir", "/dev/null"], check=False,
                          capture_output=True, text=True, cwd=tmp_path)
    assert "ErrorEstimate" in done.stdout and done.returncode == 0, done.stdout


def test_stub_names_what_the_module_has():
    stub = (pathlib.Path(vernier.__file__).parent / "_core.pyi").read_text()
    for name in dir(vernier._core):
        if not name.startswith("_"):
            assert f"class {name}:" in stub or f"def {name}(" in stub or f"\n{name}: " in stub, name


def test_version_is_the_librarys():
    try:
        installed = importlib.metadata.version("vernier")
    except importlib.metadata.PackageNotFoundError:
        pytest.skip("vernier is not installed by pip")
    assert vernier.__version__ == installed
