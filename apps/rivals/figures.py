# SPDX-License-Identifier: Apache-2.0
"""The arithmetic of rivals: from pictures of several seeds and the time they took to the time to an equal error.

Where error falls as the root of the number of samples, relative variance x seconds does not depend on how many there were:
E = relative variance x seconds, less is better.
"""
import numpy

EPSILON = 0.01  # as docs/error.md has it: errors are relative to r^2 + 0.01
TRIMMED = 1000  # one pixel in so many, the worst, is left out of E_trim
BLOCK = 8  # pixels along the side of a block of E_block
LUMINANCE = numpy.array([0.2126, 0.7152, 0.0722])


def block_means(picture):
    """Means of 8 x 8 pixels; what is left over at the right and at the bottom does not count."""
    height, width = picture.shape[0] // BLOCK, picture.shape[1] // BLOCK
    whole = picture[: height * BLOCK, : width * BLOCK]
    return whole.reshape(height, BLOCK, width, BLOCK, -1).mean((1, 3))


def squared_errors(pictures):
    """By pixel and channel, estimates without bias of a picture's variance over r^2 + 0.01, from four seeds.

    The variance is half the squared difference of two seeds; r is the mean of the other two, since relative to its own mean a
    firefly hides itself. No other renderer's reference is needed, and differences of model do not count.
    """
    a, b, c, d = (picture.astype(numpy.float64) for picture in pictures)

    def of_pair(one, other, reference):
        return (one - other) ** 2 / 2 / (reference**2 + EPSILON)

    return (of_pair(a, b, (c + d) / 2) + of_pair(c, d, (a + b) / 2)) / 2


def relative_variances(pictures):
    """Of a picture, of it without the worst pixels, and of its blocks (times the pixels of one)."""
    by_pixel = numpy.sort(squared_errors(pictures).mean(-1).ravel())
    kept = by_pixel[: len(by_pixel) - max(1, len(by_pixel) // TRIMMED)]
    blocks = squared_errors([block_means(picture) for picture in pictures])
    return {"all": by_pixel.mean(), "trim": kept.mean(), "block": blocks.mean() * BLOCK**2}


class TooShort(Exception):
    """Runs end before they take time that can be told."""


def rendering_seconds(few, seconds_of_few, many, seconds_of_many):
    """Time that `many` samples a pixel take, from the times of whole runs of both numbers: what does not depend on the number,
    starting, loading and building, drops out. Medians. Throws TooShort where chance hides it."""
    more = numpy.median(seconds_of_many) - numpy.median(seconds_of_few)
    if not more > 0:
        raise TooShort(f"{many} samples a pixel took no longer than {few}; expected a larger --size or --spp")
    return more * many / (many - few)


def mean_luminance(pictures):
    """Of all pictures, with the standard error that their spread tells."""
    means = numpy.array([float((picture.astype(numpy.float64) @ LUMINANCE).mean()) for picture in pictures])
    return means.mean(), means.std(ddof=1) / numpy.sqrt(len(means))


def means_agree(one, other, tolerance=0.02):
    """Whether two means with standard errors are the same light: to 2 % and three standard errors."""
    margin = tolerance * abs(other[0]) + 3 * numpy.hypot(one[1], other[1])
    return bool(abs(one[0] - other[0]) <= margin)


def figures(pictures, seconds):
    """All that is told of one renderer and scene."""
    relative = relative_variances(pictures)
    mean, error = mean_luminance(pictures)
    return {
        "relative_variance": float(relative["all"]),
        "relative_variance_trim": float(relative["trim"]),
        "relative_variance_block": float(relative["block"]),
        "seconds": float(seconds),
        "E": float(relative["all"] * seconds),
        "E_trim": float(relative["trim"] * seconds),
        "E_block": float(relative["block"] * seconds),
        "mean": float(mean),
        "mean_error": float(error),
    }
