# SPDX-License-Identifier: Apache-2.0
"""A process whose lines are read while it runs, without ever waiting long for one."""
from __future__ import annotations

import queue
import subprocess
import threading
from typing import Callable, Iterator

_SECONDS_BETWEEN_LOOKS = 0.1
_SECONDS_TO_END = 60  # a picture so far may take this long to be written


class Stopped(Exception):
    """Somebody asked for the end."""


class LineProcess:
    """Standard output and error are read as one."""

    def __init__(self, command: list[str]):
        self._process = subprocess.Popen(
            command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
            encoding="utf-8", errors="replace")
        self._lines: queue.Queue[str | None] = queue.Queue()
        threading.Thread(target=self._read, daemon=True).start()

    def write(self, line: str) -> None:
        """Raises OSError where the process has ended."""
        self._process.stdin.write(line + "\n")
        self._process.stdin.flush()

    def lines(self, should_stop: Callable[[], bool]) -> Iterator[str]:
        """What it prints until it ends. Raises Stopped as soon as `should_stop` says so."""
        while True:
            if should_stop():
                raise Stopped
            try:
                line = self._lines.get(timeout=_SECONDS_BETWEEN_LOOKS)
            except queue.Empty:
                continue
            if line is None:
                return
            yield line

    def finish(self) -> list[str]:
        """Asks it to end, as a user would; returns the lines that were not read yet."""
        if self._process.poll() is None:
            self._process.terminate()
        try:
            self._process.wait(_SECONDS_TO_END)
        except subprocess.TimeoutExpired:
            self._process.kill()
        rest = []
        while (line := self._lines.get()) is not None:
            rest.append(line)
        return rest

    def end(self) -> None:
        """Ends its input, and with that the process."""
        try:
            self._process.stdin.close()
        except OSError:
            pass  # it has ended with something unread
        self._process.terminate()
        self._process.wait()

    def exit_code(self) -> int:
        return self._process.wait()

    def _read(self) -> None:
        for line in self._process.stdout:
            self._lines.put(line.rstrip("\n"))
        self._lines.put(None)
