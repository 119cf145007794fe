# SPDX-License-Identifier: Apache-2.0
"""Pictures: their values, their error, and what is done with them."""

from __future__ import annotations

import importlib.util
import math
import os
from pathlib import Path
from types import MappingProxyType
from typing import Any, Mapping, NamedTuple, Sequence, Union

import numpy as np

from . import _core
from ._errors import UsageError
from ._notices import Notice


class ErrorEstimate(NamedTuple):
    """How wrong a picture probably is, without a reference.

    ``rel_rmse`` is sqrt(mean((x - r)^2 / (r^2 + 0.01))) of the picture x and the truth r, over the pixels that show a
    surface; ``low`` and ``high`` are the ends of a 95 % interval. ``unreliable`` is the part of the pixels whose figure
    is not to be trusted. All are not a number while too little is known. ``float()`` gives ``rel_rmse``.
    """

    rel_rmse: float
    low: float
    high: float
    unreliable: float = 0.0

    def __float__(self) -> float:
        return float(self.rel_rmse)

    def __str__(self) -> str:
        if not math.isfinite(self.rel_rmse):
            return "not known"
        return f"{100 * self.rel_rmse:.3g} % ({100 * self.low:.3g} to {100 * self.high:.3g} %)"


class MissingFigure(NamedTuple):
    """``share`` of all light, by luminance, that a picture leaves out; ``rel_rmse``: the least error that this makes."""

    share: float
    rel_rmse: float


class Missing(NamedTuple):
    """Known bias, which the error does not contain: light of lamps through glass that bends it, at most; and paths
    longer than the depth limit."""

    bent: MissingFigure
    depth: MissingFigure


def _offer_oidn() -> None:
    """Tells the library, which does not know Python's path, where the package pyoidn has Open Image Denoise."""
    spec = importlib.util.find_spec("pyoidn")
    library = Path(spec.origin).parent / "oidn/lib/libOpenImageDenoise.so.2" if spec and spec.origin else None
    if library and library.exists():
        os.environ.setdefault("VERNIER_OIDN", str(library))


_LAYER_NAMES = {"N": "normal", "Z": "depth", "P": "position", "UV": "uv"}
_COMPONENTS = ("RGB", "XYZ", "UV", "rgba")


def _layers(names: Sequence[str], values: np.ndarray) -> dict[str, np.ndarray]:
    """Channels A.R, A.G, A.B (or others of _COMPONENTS) are the layer A of several values a pixel, others one each."""
    layers: dict[str, np.ndarray] = {}
    index = 0
    while index < len(names):
        stem = names[index].rpartition(".")[0]
        count = max(len(group) if [*names[index:index + len(group)]] == [f"{stem}.{c}" for c in group] else 1
                    for group in _COMPONENTS)
        if count > 1:
            layers[_LAYER_NAMES.get(stem, stem)] = values[..., index:index + count]
        elif names[index] not in ("R", "G", "B", "A"):
            layers[_LAYER_NAMES.get(names[index], names[index])] = values[..., index]
        index += count
    return layers


def _text_error(texts: Mapping[str, str], figure: str, interval: str) -> ErrorEstimate | None:
    """The error that a picture's header tells."""
    try:
        low, high = map(float, texts[interval].split())
        return ErrorEstimate(float(texts[figure]), low, high, float(texts.get("vernier:unreliablePixels", "0")))
    except (KeyError, ValueError):
        return None


class Image:
    """A picture with its error. Its arrays look into the picture's own memory and cannot be written to: copy() them.

    Attributes:
        pixels: (height, width, 3) float32, top row first: scene-linear Rec.709 radiance, W m^-2 sr^-1, untouched by any
            exposure or view. Of a transparent picture, multiplied by alpha.
        alpha: (height, width) float32, or None.
        layers: by name, (height, width) or (height, width, components) float32: "depth", "normal", "id", ... (docs/layers.md)
        metadata: texts for the headers of the files that it is saved to.
        stats: what was measured of the render: seconds, samples_per_pixel, samples, rays, bad_samples, stopped_by, ...
        notices: what came up while it was rendered.
        denoised_from: the error before denoising; None: it was not denoised, or that is not known.
    """

    def __init__(self, picture: _core.Picture, *, error: ErrorEstimate | None = None, missing: Missing | None = None,
                 stats: Mapping[str, Any] | None = None, notices: Sequence[Notice] = (), view: str = "",
                 denoised_from: float | None = None) -> None:
        self._picture = picture
        self._values = picture.values
        self._error = error
        self._view = view
        self.missing = missing
        self.stats = dict(stats or {})
        self.notices = list(notices)
        self.denoised_from = denoised_from

    @staticmethod
    def _of_render(picture: _core.Picture, status: Mapping[str, Any], **rest: Any) -> Image:
        stats = dict(status)
        error = ErrorEstimate(**stats.pop("error"))
        missing = Missing(*(MissingFigure(**stats["missing"][kind]) for kind in ("bent", "depth")))
        del stats["missing"]
        return Image(picture, error=error, missing=missing, stats=stats | rest.pop("stats", {}), **rest)

    @property
    def pixels(self) -> np.ndarray:
        if self._values.shape[2] < 3:
            return np.broadcast_to(self._values[..., :1], (*self._values.shape[:2], 3))
        return self._values[..., :3]

    @property
    def alpha(self) -> np.ndarray | None:
        names = self._picture.channel_names
        return self._values[..., names.index("A")] if "A" in names else None

    @property
    def layers(self) -> Mapping[str, np.ndarray]:
        return MappingProxyType(_layers(self._picture.channel_names, self._values))

    @property
    def size(self) -> tuple[int, int]:
        """Width and height, pixels."""
        return self._values.shape[1], self._values.shape[0]

    @property
    def error(self) -> ErrorEstimate | None:
        """How wrong the picture is; None where nothing is known, as of pictures of other programs."""
        texts = self.metadata
        if self._error is not None:
            return self._error
        if "vernier:denoiser" in texts:
            return _text_error(texts, "vernier:denoisedRelRmse", "vernier:denoisedRelRmse95")
        return _text_error(texts, "vernier:relRmse", "vernier:relRmse95")

    @property
    def error_interval(self) -> tuple[float, float] | None:
        """The ends of a 95 % interval for the error."""
        return None if self.error is None else (self.error.low, self.error.high)

    @property
    def metadata(self) -> dict[str, str]:
        return dict(self._picture.metadata)

    @metadata.setter
    def metadata(self, texts: Mapping[str, str]) -> None:
        self._picture.metadata = dict(texts)

    def save(self, path: str | os.PathLike[str], *, view: str | None = None, exposure: float = 0.0,
             ocio: str = "") -> None:
        """Replaces a file wholly or not at all: .exr with all layers as they are, .png or .jpg as to_display() shows."""
        self._picture.write(os.fspath(path), self._chosen(view), exposure, ocio)

    def to_display(self, *, view: str | None = None, exposure: float = 0.0, ocio: str = "") -> np.ndarray:
        """(height, width, 3) uint8, or 4 with straight alpha: what a .png file shows.

        Args:
            view: "ACES SDR", "standard", "neutral", "AgX", "raw", or as much of such a name as is needed; None: the first,
                but raw for the data of raycast.
            exposure: stops; values are multiplied by 2^exposure first.
            ocio: an OpenColorIO config file; none: $OCIO, else the built-in config.
        """
        return self._picture.to_display(self._chosen(view), exposure, ocio)

    def denoise(self, filter: str = "nlm") -> Image:
        """A filtered copy, with its own error; the layers that vernier.LAYERS_FOR_DENOISING names make it good and known.

        Args:
            filter: one of ``vernier denoise --filter help``. "oidn" is Open Image Denoise, of the package pyoidn or where
                docs/denoise.md says; "auto": that where it is found, else "nlm".
        """
        _offer_oidn()
        picture, error = self._picture.denoise(filter)
        before, after = (None, None) if error is None else (error[0], ErrorEstimate(*error[1:]))
        return Image(picture, error=after, missing=self.missing, stats=self.stats, notices=self.notices, view=self._view,
                     denoised_from=before)

    def _chosen(self, view: str | None) -> str:
        return self._view if view is None else view

    def _repr_png_(self) -> bytes:
        return self._picture.encode("png", self._chosen(None), 0.0, "")

    def __repr__(self) -> str:
        width, height = self.size
        layers = ", ".join(self.layers)
        return f"<vernier.Image {width}x{height}, error {self.error or 'not known'}{', ' + layers if layers else ''}>"


PictureLike = Union[Image, str, "os.PathLike[str]", np.ndarray]


def _as_picture(value: PictureLike, what: str) -> _core.Picture:
    if isinstance(value, Image):
        return value._picture
    if isinstance(value, (str, os.PathLike)):
        return _core.Picture.read(os.fspath(value))
    array = np.asarray(value)
    if array.ndim != 3 or array.shape[2] != 3 or 0 in array.shape:
        raise UsageError(f"{what}: expected an Image, a file or an array (height, width, 3), got shape {array.shape}")
    if array.dtype == np.uint8:
        return _core.Picture.from_array(array / np.float32(255), ["R", "G", "B"], False)
    return _core.Picture.from_array(array, ["R", "G", "B"], True)


def read(path: str | os.PathLike[str]) -> Image:
    """A picture file, .exr with all its layers."""
    return Image(_core.Picture.read(os.fspath(path)))


def to_display(picture: PictureLike, *, view: str = "", exposure: float = 0.0, ocio: str = "") -> np.ndarray:
    """As Image.to_display, of scene-linear arrays (height, width, 3) and files too."""
    if isinstance(picture, Image):
        view = picture._chosen(view or None)
    return _as_picture(picture, "to_display").to_display(view, exposure, ocio)


def compare(picture: PictureLike, reference: PictureLike) -> dict[str, float]:
    """The figures of ``vernier compare`` by name: mse, rmse, relmse, mae, psnr, largest, flip, ...

    With the layer "error" in both, "differing" and "mean_p" tell whether they can be of one expectation. uint8 arrays
    hold display values, others scene-linear ones; both pictures must be of one kind.
    """
    return _core.compare(_as_picture(picture, "picture"), _as_picture(reference, "reference"))


def merge(checkpoints: Sequence[str | os.PathLike[str]], *, aov: Sequence[str] = ()) -> Image:
    """One picture of renders with different seeds, from the files that Session.save() or ``--checkpoint`` wrote.

    ``aov`` may name the layers that need no scene: error, half, samples, variance.
    """
    picture, status = _core.merge([os.fspath(path) for path in checkpoints], ",".join(aov))
    return Image._of_render(picture, status)
