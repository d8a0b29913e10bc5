"""The environment of Gymnasium; without that these are skipped."""

from __future__ import annotations

import warnings

import numpy as np
import pytest

import hydrostat as hs

gymnasium = pytest.importorskip("gymnasium")


def test_it_is_an_environment() -> None:
    from gymnasium.utils.env_checker import check_env
    from hydrostat.gym import ReachEnv

    with warnings.catch_warnings():
        warnings.simplefilter("error")
        check_env(ReachEnv(steps=20), skip_render_check=True)


def test_episodes_depend_on_their_seeds_alone() -> None:
    from hydrostat.gym import ReachEnv

    actions = np.random.default_rng(2).uniform(-1.0, 1.0, (15, 2))

    def played(env: ReachEnv) -> list[tuple[bytes, float]]:
        first, _ = env.reset(seed=7)
        steps = [env.step(action) for action in actions]
        return [(first.tobytes(), 0.0), *((seen.tobytes(), float(reward)) for seen, reward, *_ in steps)]

    env = ReachEnv()
    assert played(env) == played(env) == played(ReachEnv())


def test_the_target_can_be_followed() -> None:
    """By steps along the derivatives: a policy that knows the arm."""
    from hydrostat.gym import ReachEnv

    env = ReachEnv(steps=60, flow_speed=(0.01, 0.01))
    seen, _ = env.reset(seed=3)
    arm = hs.Arm.load("silicone").replace(flow_speed=0.01)
    solver = hs.Solver(arm, 1e-6)
    far = []
    for _ in range(60):
        pulls = 0.3 * seen[8:]
        solver.set_tensions(pulls)
        slope = solver.sensitivities(["cable[0].tension", "cable[1].tension"]).jacobian(["tip.x", "tip.y"]) / arm.length
        off = seen[4:6] + seen[6:8] - seen[:2]
        change = np.linalg.lstsq(np.vstack([slope, 0.3 * np.eye(2)]), np.append(off, [0.0, 0.0]), rcond=None)[0] / 0.03
        seen, _, ended, truncated, about = env.step(change / max(np.abs(change).max(), 1.0))
        far.append(about["distance"])
        assert not ended
    assert truncated
    assert np.mean(far[30:]) < 0.25 * far[0], far


def test_steps_may_be_motion() -> None:
    from gymnasium.utils.env_checker import check_env
    from hydrostat.gym import ReachEnv

    arm = hs.Arm.load("silicone").replace({"dynamics.relaxation_time": "2.7 ms"})
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        check_env(ReachEnv(arm, steps=20, time_step=0.02), skip_render_check=True)
    still, moving = ReachEnv(arm, steps=20), ReachEnv(arm, steps=20, time_step=0.02)
    for env in (still, moving):
        env.reset(seed=1)
    pull = np.array([1.0, -1.0])
    one, two = still.step(pull)[0], moving.step(pull)[0]
    assert two[1] < one[1] and abs(two[8] - one[8]) < 1e-12, "the arm lags behind its equilibrium"
    with pytest.raises(ValueError, match="time_step"):
        ReachEnv(time_step=0.0)
