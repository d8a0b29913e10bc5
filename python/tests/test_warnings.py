"""What should be known about an answer reaches whoever asked."""

from __future__ import annotations

import pickle
import warnings
from collections.abc import Callable

import pytest

import hydrostat as hs


def test_a_warning_once_a_kind(silicone: hs.Arm) -> None:
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("default")
        for speed in (0.1, 0.11, 0.12):
            silicone.solve(tensions=[0.2, 0.0], flow_speed=speed)
    assert [warning.category for warning in caught] == [hs.ModelWarning]
    only = caught[0].message
    assert isinstance(only, hs.ModelWarning) and only.kind == "tangential_load"
    assert caught[0].filename == __file__
    again = pickle.loads(pickle.dumps(only))
    assert (str(again), again.kind) == (str(only), only.kind)


def test_warnings_can_be_errors_and_can_be_let_be(silicone: hs.Arm) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert silicone.solve(tensions=[0.2, 0.0]).warnings == ()
        with pytest.raises(hs.ModelWarning, match=r"^tangential_load: .*`Solution.warnings`"):
            silicone.solve(flow_speed=0.1, tensions=[0.2, 0.0])
        solver = hs.Solver(silicone.replace(flow_speed=0.1, tensions=[0.2, 0.0]))
        with pytest.raises(hs.ModelWarning):
            solver.solve()
        warnings.filterwarnings("ignore", category=hs.ModelWarning)
        bent = silicone.solve(flow_speed=0.1, tensions=[0.2, 0.0])
    assert "warnings: tangential_load" in repr(bent)
    page = bent._repr_html_()
    assert "momentum law" in page and page.count("<svg") == 1 and len(page) < 6000
    dataset = bent.to_xarray()
    assert dataset.warnings.dims == ("warning",) and dataset.warning.values.tolist() == ["tangential_load"]
    assert "warnings" not in repr(silicone.solve())


@pytest.mark.parametrize("call", ["solution", "path", "equilibria", "reach"])
def test_whoever_gives_solutions_warns_once_a_kind(silicone: hs.Arm, call: str) -> None:
    arm = silicone.replace(flow_speed=0.1, tensions=[0.2, 0.0])
    solver = hs.Solver(arm)
    solver.update()
    tip = arm.replace(flow_speed=0.1).solve().tip
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        calls: dict[str, Callable[[], object]] = {
            "solution": solver.solution,
            "path": lambda: arm.path("cable[0].tension", 0.0, 0.2),
            "equilibria": arm.equilibria,
            "reach": lambda: arm.reach((tip.x, tip.y), max_tension=0.6),
        }
        calls[call]()
    kinds = [warning.message.kind for warning in caught if isinstance(warning.message, hs.ModelWarning)]
    assert "tangential_load" in kinds and len(kinds) == len(set(kinds)) == len(caught)
    assert caught[0].filename == __file__
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        silicone.path("cable[0].tension", 0.0, 0.1)


def test_who_ignores_them_is_spared_the_search(silicone: hs.Arm) -> None:
    arm = silicone.replace(flow_speed=0.1, tensions=[0.2, 0.0])
    for category, text, searched in [(hs.ModelWarning, "", False), (UserWarning, "", False), (hs.ModelWarning, "surface", True)]:
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            warnings.filterwarnings("ignore", text, category)
            sol = arm.solve()
        assert ("warnings" in vars(sol)) == searched == bool(caught)
        assert [note.kind for note in sol.warnings] == ["tangential_load"]
