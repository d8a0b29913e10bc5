"""Small motions about an equilibrium."""

from __future__ import annotations

import json
import math
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

import hydrostat as hs

if TYPE_CHECKING:
    from numpy.typing import NDArray

#: First roots of cos b cosh b = -1.
_ROOTS = (1.875104068711961, 4.694091132974175, 7.854757438237613)


def _rod(**more: object) -> hs.Arm:
    rod: dict[str, Any] = {"length": 1.0, "radius": 0.001, **more}
    return hs.Arm(arm=rod, material={"young": 1e9}, model={"volume": "none"}, flow={"density": 0.0})


def _beam(root: float, s: NDArray[np.float64]) -> NDArray[np.float64]:
    ratio = (math.cosh(root) + math.cos(root)) / (math.sinh(root) + math.sin(root))
    shape = np.cosh(root * s) - np.cos(root * s) - ratio * (np.sinh(root * s) - np.sin(root * s))
    scaled: NDArray[np.float64] = shape / shape[np.abs(shape).argmax()]
    return scaled


def test_a_slender_rod_has_the_shapes_of_the_beam() -> None:
    found = hs.modes(_rod(), count=3)
    assert len(found) == 3 and found.stable
    for mode, root in zip(found, _ROOTS, strict=True):
        assert mode.kind == "swings" and mode.damping_ratio == pytest.approx(0, abs=1e-9)
        assert mode.displacement[:, 1].real == pytest.approx(_beam(root, found.s), abs=1e-4)
        assert np.abs(mode.displacement[:, 1].imag).max() < 1e-6
    assert found[1].frequency / found[0].frequency == pytest.approx((_ROOTS[1] / _ROOTS[0]) ** 2, rel=1e-4)
    assert len(found[:2]) == 2


def test_in_space_modes_come_in_twos_across_each_other() -> None:
    found = hs.modes(_rod(space="spatial"), count=4)
    one, other = found[0], found[1]
    assert one.frequency == pytest.approx(other.frequency, rel=1e-8)
    for mode, axis in ((one, 1), (other, 2)):
        assert mode.displacement[:, axis].real == pytest.approx(_beam(_ROOTS[0], found.s), abs=1e-4)
    assert found.place.shape == (51, 3) and found.directors.shape == (51, 3, 3)


def test_documents_and_pictures() -> None:
    arm = hs.Arm.load("silicone").replace(tensions=[0.1, 0], flow_speed=0.05)
    found = hs.modes(arm, count=3)
    document = json.loads(found.to_json())
    assert len(document["modes"][0]["shape"]["theta"]) == len(document["sections"]["s"]) == 51
    assert found.to_csv().count("\n") == 4 and found.shapes_csv().startswith("number,s_m,x_m,y_m,dx_re_m,dx_im_m,")
    assert "equilibrium" in found.shapes_figure().texts() and "growth rate (1/s)" in found.figure().texts()
    data = pytest.importorskip("xarray") and found.to_xarray()
    assert data.displacement.shape == (3, 51, 2) and data.turn.shape == (3, 51)
    with pytest.raises(ValueError, match="elements"):
        hs.modes(arm, elements=100)
    with pytest.raises(hs.NoEquilibriumError):
        hs.modes(arm.replace(tensions=[1.4, 0]))
