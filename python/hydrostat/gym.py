"""An environment of Gymnasium: an arm that follows a moving target in a stream. Needs gymnasium."""

from __future__ import annotations

from os import PathLike
from typing import Any, SupportsFloat

import numpy as np
from numpy.typing import NDArray

import gymnasium
from gymnasium.spaces import Box
from hydrostat import _inputs, _units
from hydrostat._errors import MotionError, NoEquilibriumError
from hydrostat.arm import Arm, arm_of
from hydrostat.many import solve_many
from hydrostat.motion import Simulation
from hydrostat.solver import Solver

#: The largest part of the most tension that a step changes a tension by.
_RATE = 0.1
#: How often a course of the target is drawn anew that has no equilibrium somewhere.
_DRAWS = 20
#: What a shape that folds or ends otherwise costs, arm lengths.
_LOST = 5.0


class ReachEnv(gymnasium.Env):  # type: ignore[misc]
    """Pull the cables so that the tip follows a moving target; each step is an equilibrium, or with `time_step` a piece of motion. The target moves along the tips of tensions that
    rise and fall, drawn at every reset, so that its whole course can be reached.

    An observation is, for an arm of c cables: the tip's x and y, the sine and cosine of its turn, the target's x and y and its change in a
    step (places over the length), then the c tensions over the most, all float64. An action is the change of every tension, from -1 to 1:
    a tenth of the most. The reward is minus the distance of tip and target over the length; an arm that has no equilibrium any more ends
    the episode and costs 5.

    Parameters
    ----------
    arm : Arm, str or path
        The arm, or the name or file of one; its own loads act, too.
    max_tension : float or str
        The most tension of each cable, N, or a string with a unit, as with the speeds and the time below.
    flow_speed : tuple of float or str
        The least and the most speed of the stream, m/s, drawn anew at every reset.
    steps : int
        Steps of an episode, at the end of which it is truncated.
    period : int
        Steps in which the target goes round once.
    time_step : float or str, optional
        Seconds a step takes: the arm then moves with its ``[dynamics]``, as `hydrostat.Simulation` has it, and the tensions change along
        straight lines within a step. Without it each step is an equilibrium.

    Examples
    --------
    >>> from hydrostat.gym import ReachEnv
    >>> env = ReachEnv("silicone", steps=10)
    >>> observation, _ = env.reset(seed=1)
    >>> observation.shape
    (10,)
    >>> _, reward, ended, truncated, about = env.step([0.5, -0.5])
    >>> reward < 0, ended, sorted(about)
    (True, False, ['distance', 'flow_speed'])
    """

    metadata: dict[str, Any] = {"render_modes": []}

    def __init__(
        self,
        arm: Arm | str | PathLike[str] = "silicone",
        *,
        max_tension: float | str = 0.3,
        flow_speed: tuple[float | str, float | str] = (0.0, 0.02),
        steps: int = 200,
        period: int = 100,
        time_step: float | str | None = None,
    ) -> None:
        self._arm = arm_of(arm)
        self._most = _inputs.number("max_tension", max_tension, negative=False, key=_units.TENSION)
        low, high = _inputs.items("flow_speed", flow_speed, "two speeds, the least and the most")
        slow, fast = (_inputs.number("flow_speed", speed, negative=False, key=_units.SPEED) for speed in (low, high))
        self._speeds = (slow, fast)
        self._steps = _inputs.count("steps", steps)
        self._period = max(_inputs.count("period", period), 1)
        self._time_step = None if time_step is None else _inputs.number("time_step", time_step, negative=False, key=_units.TIME)
        if self._time_step == 0.0:
            raise ValueError("time_step: expected a time above 0, s")
        self._moving: Simulation | None = None
        self._count = len(self._arm.cables)
        self.action_space = Box(-1.0, 1.0, (self._count,), np.float64)
        bound = np.concatenate([np.full(2, 2.0), np.ones(2), np.full(4, 3.0), np.ones(self._count)])
        self.observation_space = Box(-bound, bound, dtype=np.float64)
        self._bound = bound
        self._solver = Solver(self._arm, 1e-6)
        self._tensions = np.zeros(self._count)
        self._course = np.zeros((self._period, 2))
        self._speed, self._step = 0.0, 0

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[NDArray[np.float64], dict[str, Any]]:
        """A new episode: slack cables, another stream, another target, which some tensions reach."""
        super().reset(seed=seed)
        random = self.np_random
        self._speed = float(random.uniform(*self._speeds))
        self._step = 0
        arm = self._arm.replace(flow_speed=self._speed)
        for _ in range(_DRAWS):
            found = solve_many(arm, tensions=self._most * self._drawn())
            if found.answered.all():
                break
        else:
            raise RuntimeError("max_tension: the arm has no equilibrium on any of the courses that were drawn; lower it, or the stream")
        self._course = np.stack([found.tip_x, found.tip_y], axis=-1) / self._arm.length
        # A solver of its own, so that an episode does not depend on the one before.
        self._solver = Solver(arm, 1e-6)
        self._moving = None if self._time_step is None else Simulation(arm, tol=1e-3)
        self._tensions = np.zeros(self._count)
        tip = self._tip()
        return self._observed(tip), self._about(tip)

    def step(self, action: NDArray[np.float64]) -> tuple[NDArray[np.float64], SupportsFloat, bool, bool, dict[str, Any]]:
        """Change the tensions and solve."""
        change = np.clip(np.asarray(action, dtype=np.float64), -1.0, 1.0)
        self._step += 1
        before = self._tensions
        self._tensions = np.clip(before + _RATE * self._most * change, 0.0, self._most)
        truncated = self._step >= self._steps
        try:
            tip = self._tip(moves=True)
        except (NoEquilibriumError, MotionError):
            self._tensions = before
            tip = self._tip(moves=False)
            return self._observed(tip), -_LOST, True, truncated, self._about(tip)
        about = self._about(tip)
        return self._observed(tip), -about["distance"], False, truncated, about

    def target(self, step: int | None = None) -> NDArray[np.float64]:
        """Where the target is, over the length, now or at a step of the episode; shape (2,)."""
        target: NDArray[np.float64] = self._course[(self._step if step is None else step) % self._period]
        return target

    def _drawn(self) -> NDArray[np.float64]:
        """Tensions over the most that rise and fall, shape (period, cables): one cable pulls more than the others."""
        random = self.np_random
        middle = random.uniform(0.0, 0.2, self._count)
        middle[random.integers(self._count)] = random.uniform(0.4, 0.7)
        swing, phase = random.uniform(0.1, 0.3, self._count), random.uniform(0.0, 2.0 * np.pi, self._count)
        angle = 2.0 * np.pi * np.arange(self._period)[:, None] / self._period
        pulls: NDArray[np.float64] = np.clip(middle + swing * np.sin(angle + phase), 0.0, 1.0)
        return pulls

    def _tip(self, *, moves: bool = False) -> NDArray[np.float64]:
        """x and y over the length, theta; after a step of the motion where it moves."""
        if self._moving is not None and self._time_step is not None:
            at = self._moving.step(self._time_step, self._tensions) if moves else self._moving.now()
            return np.array([at.tip_x / self._arm.length, at.tip_y / self._arm.length, at.tip_theta])
        self._solver.set_tensions(self._tensions)
        tip = self._solver.update().tip
        return np.array([tip.x / self._arm.length, tip.y / self._arm.length, tip.theta])

    def _observed(self, tip: NDArray[np.float64]) -> NDArray[np.float64]:
        target, following = self.target(), self.target(self._step + 1)
        turned = [np.sin(tip[2]), np.cos(tip[2])]
        pulls = self._tensions / (self._most or 1.0)
        seen: NDArray[np.float64] = np.concatenate([tip[:2], turned, target, following - target, pulls])
        return np.clip(seen, -self._bound, self._bound, out=seen)

    def _about(self, tip: NDArray[np.float64]) -> dict[str, Any]:
        return {"distance": float(np.hypot(*(tip[:2] - self.target()))), "flow_speed": self._speed}
