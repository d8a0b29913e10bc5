"""An arm under sliders; without ipywidgets these are skipped."""

from __future__ import annotations

import warnings

import pytest

import hydrostat as hs

pytest.importorskip("ipywidgets")


def test_sliders_lead_to_shapes(silicone: hs.Arm) -> None:
    from hydrostat.widget import explore

    with warnings.catch_warnings():
        warnings.simplefilter("error", hs.ModelWarning)
        shown = explore(silicone, max_tension=1.5)
        left, right, speed, direction, picture, words = shown.children
        assert (left.max, speed.max, direction.min) == (1.5, 0.2, -180.0)
        straight = picture.value
        left.value = 0.2
        assert shown.solution == silicone.replace(flow_direction=0.0).solve(tensions=[0.2, 0.0], flow_speed=0.0)
        assert picture.value.count("<svg") == 1 and picture.value != straight and "tip at" in words.value
        speed.value = 0.1
        assert "momentum law" in words.value
        speed.value, left.value = 0.0, 1.5
        assert shown.solution is None and "cable_fold" in words.value and "last good shape" in words.value
        right.value, left.value = 0.0, 0.1
        assert shown.solution is not None


def test_the_most_is_the_cables_own() -> None:
    from hydrostat.widget import explore

    assert [slider.max for slider in explore("paper").children[:2]] == [100.0, 100.0]
    plain = hs.Arm(
        arm={"length": 0.2, "radius": 0.01}, material={"young": 1e5}, cable=[{"name": "left", "offset": 0.005}]
    )
    with pytest.raises(ValueError, match="^max_tension: expected a number, because the cable 'left' has none"):
        explore(plain)
