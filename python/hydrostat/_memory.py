"""Whether what is asked for fits in memory; said before anything is allocated."""

from __future__ import annotations

import os
from pathlib import Path as FilePath

#: Below so many bytes nobody asks.
_SMALL = 1 << 26
#: Most stations of one row: reading more out cannot be interrupted.
STATIONS = 10_000


def require(size: int, what: str, remedy: str) -> None:
    """Raise a `MemoryError` where `size` bytes are more than what is free."""
    if size < _SMALL:
        return
    free = available()
    if free is not None and size > free:
        raise MemoryError(f"{what} take about {_words(size)}, and {_words(free)} are free; {remedy}")


def stations(name: str, count: int) -> int:
    """So many stations of a row."""
    if count > STATIONS:
        raise ValueError(f"{name}: expected at most {STATIONS} stations a row, found {count}")
    return count


def available() -> int | None:
    """Bytes that this process can have more; None where the system does not say."""
    found = []
    try:
        lines = FilePath("/proc/meminfo").read_text(encoding="ascii").splitlines()
        fields = dict(line.split(":", 1) for line in lines if ":" in line)
        found.append(1024 * int(fields["MemAvailable"].split()[0]))
    except (OSError, KeyError, ValueError):
        try:
            found.append(os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE"))
        except (AttributeError, OSError, ValueError):
            pass
    try:
        group = FilePath("/sys/fs/cgroup")
        most, used = ((group / f"memory.{name}").read_text(encoding="ascii").strip() for name in ("max", "current"))
        if most != "max":
            found.append(max(int(most) - int(used), 0))
    except (OSError, ValueError):
        pass
    return min(found) if found else None


def _words(size: int) -> str:
    for unit, count in (("TB", 1e12), ("GB", 1e9)):
        if size >= count:
            return f"{size / count:.3g} {unit}"
    return f"{size / 1e6:.0f} MB"
