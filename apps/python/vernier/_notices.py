# SPDX-License-Identifier: Apache-2.0
"""What users should know that did not stop the work, kept where it came up and logged as "vernier"."""

from __future__ import annotations

import logging
from typing import Iterable, NamedTuple

_LOG = logging.getLogger("vernier")


class Notice(NamedTuple):
    """``severity`` is "info" or "warning"; ``place`` a JSON pointer into the scene file, or empty."""

    severity: str
    place: str
    text: str

    def __str__(self) -> str:
        return f"{self.place}: {self.text}" if self.place else self.text


def logged(notices: Iterable[tuple[str, str, str]]) -> list[Notice]:
    """The notices, each logged; warnings show on standard error unless logging is set up otherwise."""
    result = [Notice(*notice) for notice in notices]
    for notice in result:
        _LOG.log(logging.WARNING if notice.severity == "warning" else logging.INFO, "%s", notice)
    return result
