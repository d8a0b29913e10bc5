"""Tensions that reach targets, and a follower in a loop."""

from __future__ import annotations

import numpy as np
import pytest
from conftest import Program
from hypothesis import given, settings
from hypothesis import strategies as st

import hydrostat as hs


@settings(max_examples=15, deadline=None, derandomize=True)
@given(left=st.floats(0.02, 0.6), right=st.floats(0.0, 0.6))
def test_what_a_solve_gives_is_reached_again(silicone: hs.Arm, left: float, right: float) -> None:
    tip = silicone.solve(tensions=[left, right]).tip
    found = silicone.reach((tip.x, tip.y), max_tension=0.9)
    assert found and found.closest is None
    for one in found:
        assert one.distance <= 1e-8
        assert one.effort == pytest.approx(float(one.tensions @ one.tensions), rel=1e-14)
        assert np.hypot(one.solution.tip.x - tip.x, one.solution.tip.y - tip.y) <= 1.1e-8 * silicone.length
        if one.on_the_path:
            again = silicone.solve(tensions=one.tensions).tip
            assert np.hypot(again.x - tip.x, again.y - tip.y) < 1e-6 * silicone.length
    assert [one.effort for one in found] == sorted(one.effort for one in found)
    own = np.array([left, right])
    # Where two cables move the tip alike, 1e-8 L is its root in tension.
    assert min(float(np.abs(one.tensions - own).max()) for one in found) < 1.5e-4


def test_what_is_out_of_reach(silicone: hs.Arm) -> None:
    found = silicone.reach((0.3, 0.0), max_tension=0.5)
    assert not found and found.solutions == () and found.closest is not None
    closest = found.closest
    assert {bound.kind for bound in closest.bounds} == {"slack"} and {b.cable for b in closest.bounds} == {0, 1}
    tip = closest.solution.tip
    assert closest.distance == pytest.approx(np.hypot(tip.x - 0.3, tip.y) / silicone.length, rel=1e-9)
    # The straight arm is the longest.
    assert closest.distance == pytest.approx((0.3 - silicone.length) / silicone.length, rel=1e-3)
    pulled = silicone.reach((0.05, 0.2), max_tension=0.05)
    assert pulled.closest is not None and ("most", 0) in pulled.closest.bounds
    assert "closest" in repr(pulled)


def test_several_targets(silicone: hs.Arm) -> None:
    """A station with its angle, from a shape that has them."""
    shape = silicone.solve(tensions=[0.3, 0.1])
    middle = shape.at(0.15)
    goals = [
        hs.Target(shape.tip.x, shape.tip.y),
        hs.Target(float(middle.x[0]), float(middle.y[0]), s=0.15, angle=float(np.degrees(middle.theta[0])), weight=2.0),
    ]
    found = silicone.reach(goals, max_tension=0.9)
    assert np.allclose(found[0].tensions, [0.3, 0.1], rtol=0, atol=1e-6)
    assert found.targets == tuple(goals)
    places = found[0].places
    assert np.allclose([places.s[0], places.x[0], places.y[0]], [0.15, goals[1].x, goals[1].y], rtol=0, atol=1e-8)
    assert len(places.s) == 1 and len(silicone.reach((0.182, 0.078), max_tension=0.6)[0].places.s) == 0
    assert found[0].stability == "stable" and found[0].unstable_directions == 0
    first = silicone.reach(goals, max_tension=0.9, find_all=False)
    assert len(first) == 1


def test_strokes_and_tensions_of_the_arm_do_not_count(silicone: hs.Arm) -> None:
    target = (0.182, 0.078)
    plain = silicone.reach(target, max_tension=0.6)
    other = silicone.replace(strokes=[0.01, None]).reach(target, max_tension=0.6)
    assert [one.tensions.tobytes() for one in plain] == [one.tensions.tobytes() for one in other]
    no_cables = hs.Arm(arm={"length": 0.2, "radius": 0.01}, material={"young": 1e5})
    with pytest.raises(ValueError, match="^arm: .*no cable"):
        no_cables.reach(target)


def test_a_follower_in_a_loop(silicone: hs.Arm) -> None:
    """Round a loop of targets, each the tip at known tensions."""
    angles = np.linspace(0.0, 2.0 * np.pi, 120)
    pulls = np.stack([0.25 + 0.03 * np.cos(angles), 0.1 + 0.03 * np.sin(angles)], axis=1)
    tips = [silicone.solve(tensions=pull, tol=1e-10).tip for pull in pulls]
    follower = hs.Follower(silicone.replace(tensions=pulls[0].tolist()), (tips[0].x, tips[0].y), max_tension=0.9)
    followed = [follower.follow((tip.x, tip.y)) for tip in tips]
    assert all(step.reached and not step.jumped and step.distance <= 1e-8 for step in followed)
    assert max(step.solves for step in followed) <= 4
    for step, pull, tip in zip(followed, pulls, tips, strict=True):
        assert np.allclose(step.tensions, pull, rtol=0, atol=2e-6)
        assert np.hypot(step.tip.x - tip.x, step.tip.y - tip.y) <= 1.01e-8 * silicone.length
        assert step.tip.theta == pytest.approx(tip.theta, abs=1e-4)
    # Round once: the same tensions as at the start.
    assert np.allclose(followed[-1].tensions, followed[0].tensions, rtol=0, atol=1e-5)
    far = follower.follow((0.4, 0.0))
    assert not far.reached and far.distance > 0.5


def test_a_follower_says_where_it_is_and_takes_another_stream(silicone: hs.Arm) -> None:
    arm = silicone.replace(tensions=[0.3, 0.1])
    tip = arm.solve().tip
    follower = hs.Follower(arm, (tip.x, tip.y), max_tension=0.9)
    assert np.allclose(follower.tensions, [0.3, 0.1])
    step = follower.follow((tip.x, tip.y - 1e-3))
    shape = follower.solution()
    assert (shape.tip.x, shape.tip.y) == pytest.approx((step.tip.x, step.tip.y), abs=1e-7)
    assert follower.tensions.tolist() == step.tensions.tolist()
    assert follower.strokes == pytest.approx([cable.stroke for cable in silicone.solve(tensions=step.tensions).cables], abs=1e-7)
    # In another stream the tensions stay, and the next step goes back to the target.
    follower.set_flow_speed(0.005)
    moved = silicone.solve(tensions=step.tensions, flow_speed=0.005).tip
    assert follower.tensions == pytest.approx(step.tensions, abs=1e-9)
    assert (follower.solution().tip.x, follower.solution().tip.y) == pytest.approx((moved.x, moved.y), abs=1e-7)
    back = follower.follow((tip.x, tip.y - 1e-3))
    assert back.reached and not back.jumped
    assert abs(back.tensions - step.tensions).max() > 1e-6
    follower.set_bounds(max_tension=0.31)
    far = follower.follow((tip.x - 0.03, tip.y))
    assert not far.reached and far.tensions.max() == pytest.approx(0.31)
    with pytest.raises(ValueError, match="^flow_speed"):
        follower.set_flow_speed(-1.0)
    with pytest.raises(ValueError, match="max_tension"):
        follower.set_bounds(max_tension=-1.0)


def test_boundaries_are_the_programs(program: Program, silicone: hs.Arm) -> None:
    words = ["reach", "silicone", "--boundary", "--max-tension", "0.2"]
    boundary = silicone.reachable(max_tension=0.2)
    assert boundary.to_json() == program(*words, "--format", "json")[1].strip()
    assert boundary.to_csv() == program(*words, "--format", "csv")[1]
    piece = boundary[0]
    assert (piece.kind, piece.cables, piece.tensions.shape) == ("edge", (0,), (len(piece.x), 2))
    tip = silicone.solve(tensions=piece.tensions[1]).tip
    assert (piece.x[1], piece.y[1]) == pytest.approx((tip.x, tip.y), abs=1e-6 * silicone.length)
    assert boundary.figure().texts()
    with pytest.raises(ValueError, match="spacing"):
        silicone.reachable(max_tension=0.2, spacing=1.0)


def test_strokes_that_reach_are_the_programs(program: Program, silicone: hs.Arm) -> None:
    words = ["reach", "silicone", "--target", "0.182,0.078", "--by", "strokes", "--max-tension", "0.6"]
    found = silicone.reach((0.182, 0.078), by="strokes", max_tension=0.6)
    assert found.to_json() == program(*words, "--format", "json")[1].strip()
    shape = found[0].solution
    again = silicone.solve(strokes=[cable.command.stroke if cable.command else 0.0 for cable in shape.cables])
    assert (again.tip.x, again.tip.y) == pytest.approx((0.182, 0.078), abs=1e-7)
    with pytest.raises(ValueError, match="by: expected tensions or strokes"):
        silicone.reach((0.182, 0.078), by="angles")


def test_strokes_are_bounded_as_by_the_program(program: Program, silicone: hs.Arm) -> None:
    words = ["reach", "silicone", "--target", "0.182,0.078", "--max-stroke", "10 mm"]
    found = silicone.reach((0.182, 0.078), max_stroke=0.01)
    assert found.to_json() == program(*words, "--format", "json")[1].strip()
    closest = found.closest
    assert closest is not None and not len(found)
    assert [bound.kind for bound in closest.bounds] == ["stroke", "slack"]
    assert closest.solution.cables[0].stroke == pytest.approx(0.01, abs=1e-8)
    with pytest.raises(ValueError, match="max_stroke"):
        silicone.reach((0.182, 0.078), max_stroke=-1.0)
