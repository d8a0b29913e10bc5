"""An arm under sliders, for notebooks. Needs ipywidgets."""

from __future__ import annotations

import html
import warnings
from os import PathLike
from typing import Any

import ipywidgets
from hydrostat import _inputs, _units
from hydrostat._errors import ModelWarning, NoEquilibriumError
from hydrostat.arm import Arm, arm_of
from hydrostat.solution import Solution

_STEPS = 100


class Explorer(ipywidgets.VBox):  # type: ignore[misc]
    """Sliders above the resulting shape; `explore` makes it.

    Attributes
    ----------
    solution : Solution or None
        The shape under the present values; None where there is no equilibrium.
    """

    solution: Solution | None

    def __init__(self, arm: Arm, most: list[float], speed: float) -> None:
        self._arm = arm
        self.solution = None
        self._pulls = [_slider(f"{name} (N)", 0.0, top) for name, top in zip(arm.cables, most, strict=True)]
        self._speed = _slider("stream (m/s)", 0.0, speed)
        self._direction = _slider("direction (deg)", -180.0, 180.0)
        self._picture, self._words = ipywidgets.HTML(), ipywidgets.HTML()
        self._sliders = [*self._pulls, self._speed, self._direction]
        super().__init__([*self._sliders, self._picture, self._words])
        for slider in self._sliders:
            slider.observe(self._draw, "value")
        self._draw()

    def _draw(self, _: Any = None) -> None:
        arm = self._arm.replace(flow_direction=self._direction.value)
        pulls = [slider.value for slider in self._pulls]
        try:
            with warnings.catch_warnings():
                # They stand below the picture.
                warnings.simplefilter("ignore", ModelWarning)
                self.solution = arm.solve(tensions=pulls, flow_speed=self._speed.value)
        except NoEquilibriumError as no:
            self.solution = None
            shown, words = no.last_good, [f"<b>{no.kind}</b>: {html.escape(no.message)}; {html.escape(no.advice)}"]
            if shown is not None:
                words.append(f"Drawn is the last good shape, at {100 * no.load_fraction:.1f} % of the loads.")
        else:
            shown, tip = self.solution, self.solution.tip
            words = [f"tip at ({1e3 * tip.x:.2f}, {1e3 * tip.y:.2f}) mm"]
            words += [f"&#9888; {html.escape(note.message)}" for note in self.solution.warnings]
        self._picture.value = "" if shown is None else shown.figure().svg()
        self._words.value = "<br>".join(words)


def explore(arm: Arm | str | PathLike[str], *, max_tension: float | str | None = None, max_speed: float | str = 0.2) -> Explorer:
    """Show an arm under sliders: one tension per cable, speed and direction of the stream. The other loads of the arm act, too.

    Parameters
    ----------
    arm : Arm, str or path
        The arm, or the name or file of one.
    max_tension : float or str, optional
        The end of the tensions' sliders, N, or with a unit; by default each cable's own `max_tension`.
    max_speed : float or str
        The end of the speed's slider, m/s, or with a unit.

    Returns
    -------
    Explorer
        The widget for a notebook; its ``solution`` is the shape under the present values, or None where there is no equilibrium.

    Examples
    --------
    >>> import hydrostat.widget
    >>> shown = hydrostat.widget.explore("silicone", max_tension=0.3)
    >>> shown.solution.tip.y
    0.0
    """
    arm = arm_of(arm)
    speed = _inputs.number("max_speed", max_speed, negative=False, key=_units.SPEED)
    tables = arm.to_dict().get("cable", [])
    most = []
    for name, table in zip(arm.cables, tables, strict=True):
        own = table.get("max_tension")
        if max_tension is None and own is None:
            raise ValueError(f"max_tension: expected a number, because the cable {name!r} has none of its own")
        given = float("inf") if max_tension is None else _inputs.number("max_tension", max_tension, negative=False, key=_units.TENSION)
        most.append(min(given, float("inf") if own is None else float(own)))
    return Explorer(arm, most, speed)


def _slider(words: str, low: float, high: float) -> Any:
    step = (high - low) / _STEPS or 1.0
    style, layout = {"description_width": "110px"}, {"width": "460px"}
    shown = {"readout_format": ".3g", "continuous_update": True, "style": style, "layout": layout}
    return ipywidgets.FloatSlider(value=max(low, 0.0), min=low, max=high, step=step, description=words, **shown)
