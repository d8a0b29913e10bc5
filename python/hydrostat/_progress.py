"""How far the work is, on one line of standard error."""

from __future__ import annotations

import sys
import time
from types import TracebackType

import numpy as np

_WIDTH = 30
_PAUSE = 0.2


def is_shown(progress: bool | None) -> bool:
    """Whether to show how far the work is: on a terminal by default."""
    if progress is None:
        return sys.stderr.isatty()
    if not isinstance(progress, (bool, np.bool_)):
        raise TypeError(f"progress: expected True, False or None, found {progress!r}")
    return bool(progress)


class Progress:
    """A bar of `rows`; drawn when `shown` is true, or on a terminal when it is None."""

    def __init__(self, rows: int, shown: bool | None) -> None:
        self._rows = rows
        self.shown = is_shown(shown)
        self._start = time.monotonic()
        self._said = 0.0
        self.done = 0

    def __call__(self, done: int) -> None:
        """So many rows are done."""
        self.done = done
        now = time.monotonic()
        if self.shown and (now - self._said > _PAUSE or done >= self._rows):
            self._said = now
            self._draw(now)

    def _draw(self, now: float) -> None:
        share = min(self.done / self._rows, 1.0) if self._rows else 1.0
        full = round(_WIDTH * share)
        rate = self.done / max(now - self._start, 1e-9)
        left = f"{(self._rows - self.done) / rate:.0f} s left" if rate > 0.0 else "..."
        bar = "#" * full + "-" * (_WIDTH - full)
        sys.stderr.write(f"\r{bar} {100 * share:3.0f}% {self.done} of {self._rows} rows, {rate:.0f}/s, {left}   ")
        sys.stderr.flush()

    def __enter__(self) -> Progress:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self.shown:
            sys.stderr.write("\n")


class Line:
    """A line that shows the last message; drawn when `shown` is true, or on a terminal when it is None."""

    def __init__(self, shown: bool | None) -> None:
        self.shown = is_shown(shown)

    def __call__(self, words: str) -> None:
        """Says how far the work is."""
        sys.stderr.write(f"\r\x1b[K{words}")
        sys.stderr.flush()

    def __enter__(self) -> Line:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self.shown:
            sys.stderr.write("\r\x1b[K")
