"""Small motions about an equilibrium: frequencies, damping, flutter, and shapes."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from os import PathLike
from typing import TYPE_CHECKING, Any, overload

import numpy as np

from hydrostat import _inputs, _native
from hydrostat.arm import Arm, arm_of
from hydrostat.figures import Figure

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr
    from numpy.typing import NDArray


@dataclass(frozen=True, eq=False)
class Mode:
    """A small motion about an equilibrium: Re(shape exp(rate t)).

    Attributes
    ----------
    rate : complex
        1/s; of a conjugate pair the one with the positive imaginary part.
    kind : str
        ``"swings"``, ``"decays"``, ``"flutter"`` (grows as it swings) or ``"divergence"``.
    displacement : ndarray of complex, shape (n, 2), in space (n, 3)
        Amplitude of the centreline's displacement at `Modes.s`, m. The largest of its size and radius times turn is 1 m.
    turn : ndarray of complex, shape (n,), in space (n, 3)
        Amplitude of the turn of the sections, rad; in space a vector: a director d moves by turn x d.
    """

    rate: complex
    kind: str
    displacement: NDArray[np.complex128]
    turn: NDArray[np.complex128]

    def __repr__(self) -> str:
        return f"<Mode: {self.frequency:.4g} Hz, damping ratio {self.damping_ratio:.3g}, {self.kind}>"

    @property
    def frequency(self) -> float:
        """Hz; 0 where it does not swing."""
        return abs(self.rate.imag) / (2.0 * math.pi)

    @property
    def damping_ratio(self) -> float:
        """0 of a free swing, 1 of what only decays, negative of what grows."""
        size = abs(self.rate)
        return 0.0 - self.rate.real / size if size > 0.0 else 0.0


class Modes(Sequence[Mode]):
    """The slowest small motions about an equilibrium, in order of frequency; see `modes`.

    Attributes
    ----------
    s : ndarray, shape (n,)
        Places along the unloaded arm, m.
    place : ndarray, shape (n, 2), in space (n, 3)
        The centreline in the equilibrium, m.
    directors : ndarray, shape (n, 3, 3)
        a, b and c of each section in the equilibrium.
    """

    def __init__(self, native: _native.Modes) -> None:
        self._inner = native
        axes = 3 if native.is_spatial else 2
        stations = native.stations().reshape(-1, 13)
        self.s: NDArray[np.float64] = stations[:, 0]
        self.place: NDArray[np.float64] = stations[:, 1 : 1 + axes]
        self.directors: NDArray[np.float64] = stations[:, 4:].reshape(-1, 3, 3)
        self._modes = tuple(self._mode(k, complex(re, im), kind) for k, (re, im, kind) in enumerate(native.rates))

    def _mode(self, index: int, rate: complex, kind: str) -> Mode:
        parts = self._inner.shape(index).reshape(-1, 2, 3, 2)
        whole = parts[..., 0] + 1j * parts[..., 1]
        if self._inner.is_spatial:
            return Mode(rate, kind, whole[:, 0], whole[:, 1])
        return Mode(rate, kind, whole[:, 0, :2], whole[:, 1, 2])

    def __len__(self) -> int:
        return len(self._modes)

    @overload
    def __getitem__(self, index: int) -> Mode: ...
    @overload
    def __getitem__(self, index: slice) -> Sequence[Mode]: ...
    def __getitem__(self, index: int | slice) -> Mode | Sequence[Mode]:
        return self._modes[index]

    def __repr__(self) -> str:
        return f"<Modes: {len(self)}, {'stable' if self.stable else 'UNSTABLE'}>"

    @property
    def stable(self) -> bool:
        """Whether none of them grows."""
        return self._inner.stable

    def to_xarray(self) -> xr.Dataset:
        """Rates over ``mode``; shapes over ``mode``, ``station`` and ``axis``. Needs xarray."""
        import xarray as xr

        axis = ["x", "y", "z"][: self.place.shape[1]]
        turned = ("mode", "station", "axis")[: self._modes[0].turn.ndim + 1] if self._modes else ("mode", "station")
        data: dict[str, Any] = {
            "rate": ("mode", np.array([mode.rate for mode in self]), {"units": "1/s"}),
            "frequency": ("mode", np.array([mode.frequency for mode in self]), {"units": "Hz"}),
            "damping_ratio": ("mode", np.array([mode.damping_ratio for mode in self]), {"units": "1"}),
            "kind": ("mode", [mode.kind for mode in self]),
            "displacement": (("mode", "station", "axis"), np.array([mode.displacement for mode in self]), {"units": "m"}),
            "turn": (turned, np.array([mode.turn for mode in self]), {"units": "rad"}),
            "place": (("station", "axis"), self.place, {"units": "m", "long_name": "centreline in the equilibrium"}),
        }
        coordinates = {"s": ("station", self.s, {"units": "m"}), "axis": axis}
        return xr.Dataset(data, coordinates)

    def to_pandas(self) -> pd.DataFrame:
        """One row a mode, as ``hydrostat modes --format csv`` has it. Needs pandas."""
        import io

        import pandas as pd

        return pd.read_csv(io.StringIO(self.to_csv()))

    def to_json(self) -> str:
        """The document of ``hydrostat modes --format json``."""
        return self._inner.to_json()

    def to_csv(self) -> str:
        """The rows as ``hydrostat modes --format csv`` prints them."""
        return self._inner.to_csv()

    def shapes_csv(self) -> str:
        """The shapes as ``hydrostat modes --shapes-output`` writes them."""
        return self._inner.shapes_csv()

    def figure(self, title: str = "rates of small motions") -> Figure:
        """The rates in the complex plane: growth across, angular frequency up."""
        return Figure(self._inner.figure(_inputs.text("title", title, "an arm")))

    def shapes_figure(self, title: str = "shapes of small motions") -> Figure:
        """The shapes of the first six modes."""
        return Figure(self._inner.shapes_figure(_inputs.text("title", title, "an arm")))


def modes(arm: Arm | str | PathLike[str], *, count: int = 8, elements: int = 12) -> Modes:
    """Find the slowest small motions about the equilibrium of an arm: rates, frequencies, damping, flutter, and shapes.

    Parameters
    ----------
    arm : Arm, str or path
        The arm, or the name or file of one. Its table ``[dynamics]`` has added mass, viscosity and whether there is inertia.
    count : int
        How many, those with the smallest rates in size.
    elements : int
        Elements of the mesh along the arm, in [1, 64].

    Raises
    ------
    NoEquilibriumError
        There is no equilibrium.

    Examples
    --------
    >>> import hydrostat as hs
    >>> found = hs.modes("silicone", count=3)
    >>> found.stable, found[0].kind, found[0].displacement.shape
    (True, 'swings', (51, 2))
    """
    many = _inputs.count("count", count)
    if many < 1:
        raise ValueError("count: expected at least 1")
    return Modes(_native.modes(arm_of(arm)._inner, many, _inputs.count("elements", elements)))
