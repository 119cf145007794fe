# SPDX-License-Identifier: Apache-2.0
"""What vernier raises. The text is the line that the command line prints: FILE: PLACE: PROBLEM."""


class Error(Exception):
    """The base of all that vernier raises. ``exit_code`` is that of the command line for such an error."""

    exit_code = 1


class UsageError(Error, ValueError):
    """The request itself: an unknown name, an impossible size."""

    exit_code = 2


class InputError(Error, OSError):
    """A scene, picture or other file that cannot be used."""

    exit_code = 3


class OutputError(Error, OSError):
    """A file that cannot be written."""

    exit_code = 3


class OutOfMemoryError(Error, MemoryError):
    """Not enough memory for what was asked."""

    exit_code = 4
