"""What runs, `mypy --strict` lets pass: this file is checked as it stands, and run."""

from __future__ import annotations

import numpy as np
import pytest

import hydrostat as hs

pd = pytest.importorskip("pandas")
xr = pytest.importorskip("xarray")


def test_a_dataset_where_a_dataarray_varies(silicone: hs.Arm) -> None:
    import xarray

    speed = xarray.DataArray([0.0, 0.1], dims="speed", coords={"speed": [0.0, 0.1]})
    found = hs.solve_many(silicone, vary={"flow.speed": speed})
    assert found.tip_y.sel(speed=0.1).item() == hs.solve_many(silicone, flow_speed=speed).tip_y.sel(speed=0.1).item()
    assert hs.solve_many(silicone, vary={"flow.speed": [0.0, 0.1]}).stroke.shape == (2, 2)


def test_lists_with_and_without_units(silicone: hs.Arm) -> None:
    import pandas

    assert silicone.solve(tensions=["0.1 N", 0]) == silicone.solve(tensions=[0.1, 0])
    assert silicone.reach([0.182, 0.078], max_tension=0.6) and silicone.reach(["182 mm", 0.078], max_tension=["0.6 N", 0.6])
    assert hs.Follower(silicone, [0.182, 0.078], max_tension="0.6 N").follow([0.182, "78 mm"]).reached
    values = pandas.Series([0.0, 0.1])
    assert hs.sweep(silicone, {"flow.speed": values}).sizes["flow_speed"] == 2
    assert hs.sweep(silicone, {"flow.speed": [0.0, "10 cm/s"], "cable[0].tension": [0.0, 0.1]}).sizes["flow_speed"] == 2


def test_what_an_arm_in_space_has(silicone: hs.Arm) -> None:
    """The plane is a plane in space: what an arm in it lacks is 0."""
    sol = hs.Arm.load("silicone-spatial").solve(tensions=[0.1, 0.05, 0])
    assert sol.tip.z > 0 and sol.a[-1].shape == (3,) and len(sol.kappa) == len(sol.m_b) == len(sol)
    assert sol.surface(sides=24).shape == (100, 24, 3)
    flat = silicone.solve(tensions=[0.2, 0.0])
    for name in ("z", "zeta", "tau", "kappa", "n_c", "m_a", "m_b"):
        assert not getattr(flat, name).any() and getattr(flat, name).shape == flat.x.shape
        assert not getattr(flat, name).flags.writeable
    assert flat.m_c.tolist() == flat.m.tolist()
    assert np.allclose(np.cross(flat.a, flat.b), flat.c) and np.allclose(flat.a[-1], flat.tip.a)
    assert flat.tip.z == 0.0 and np.allclose(np.cross(flat.tip.a, flat.tip.b), flat.tip.c)
    with pytest.raises(ValueError, match="^surface: .*in the plane"):
        flat.surface()
