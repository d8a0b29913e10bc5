"""Arms from files, dictionaries and keywords."""

from __future__ import annotations

import inspect
import json
import pickle
import tomllib
from pathlib import Path

import numpy as np
import pytest
from conftest import ROOT, needs_checkout
from hypothesis import given
from hypothesis import strategies as st

import hydrostat as hs


@needs_checkout
@pytest.mark.parametrize("name", sorted(hs.arms()))
def test_one_arm_in_five_ways(tmp_path: Path, name: str) -> None:
    shipped = hs.Arm.load(name)
    file = ROOT / "crates" / "files" / "arms" / f"{name}.toml"
    tables = tomllib.loads(file.read_text(encoding="utf-8"))
    tables.setdefault("name", name)
    written = tmp_path / f"{name}.toml"
    written.write_text(shipped.to_toml(), encoding="utf-8")
    for arm in (
        hs.Arm.load(file),
        hs.Arm.load(str(written)),
        hs.Arm.from_toml(file.read_text(encoding="utf-8"), name),
        hs.Arm.from_dict(tables),
        hs.Arm(**tables),
        hs.Arm.from_dict(shipped.to_dict()),
        pickle.loads(pickle.dumps(shipped)),
    ):
        assert arm == shipped
        assert hash(arm) == hash(shipped)


def test_pickles_keep_what_overrides() -> None:
    arm = hs.Arm.load("silicone").replace({"model.closure": "literal", "cable[1].friction": 0.2}, tensions=[0.1, 0.2])
    again = pickle.loads(pickle.dumps(arm))
    assert again == arm
    # Through the text that both still have: no key of the written arm stands above the closure.
    changed = {"model.closure": "default"}
    assert again.replace(changed) == arm.replace(changed) != arm


@needs_checkout
def test_every_table_of_the_format_is_a_keyword(silicone: hs.Arm) -> None:
    schema = json.loads((ROOT / "schema" / "arm.schema.json").read_text(encoding="utf-8"))
    assert set(schema["properties"]) == set(inspect.signature(hs.Arm).parameters)
    moving = silicone.replace({"dynamics": {"relaxation_time": "2.7 ms"}, "gravity.acceleration": 9.81, "tip.moment": 0.001})
    tables = moving.to_dict()
    assert tables["dynamics"]["relaxation_time"] == 0.0027
    assert hs.Arm.from_dict(tables) == hs.Arm(**tables) == moving
    # One key of it leaves the others.
    assert moving.replace({"dynamics": {"inertia": False}}).to_dict()["dynamics"]["relaxation_time"] == 0.0027


def test_replacing_leaves_the_arm_alone(silicone: hs.Arm) -> None:
    before = silicone.to_toml()
    other = silicone.replace({"arm.radius.tip": "3 mm"}, tensions=[0.1, 0.0], flow_speed="5 cm/s", flow_direction=90)
    assert silicone.to_toml() == before != other.to_toml()
    tables = other.to_dict()
    assert tables["arm"]["radius"]["tip"] == 0.003
    assert tables["flow"]["speed"] == 0.05
    assert other.replace(strokes=[None, -0.01]).to_dict()["cable"][1]["stroke"] == -0.01


def test_a_table_kept_none_of_its_other_keys(silicone: hs.Arm) -> None:
    arm = silicone.replace({"flow.direction": 30, "flow.density": 998.0, "cable[0].friction": 0.1}, tensions=[0.1, 0.0])
    other = arm.replace({"flow": {"speed": 0.1}, "cable[0]": {"tension": "0.2 N"}, "arm": {"base": {"angle": 10}}})
    assert other == arm.replace({"flow.speed": 0.1, "cable[0].tension": 0.2, "arm.base.angle": 10})
    assert other.to_dict()["flow"]["direction"] == 30 and other.to_dict()["cable"][0]["friction"] == 0.1
    # What stands for one number or profile is taken whole.
    ends = {"base": 0.009, "tip": 0.002}
    assert arm.replace({"arm": {"radius": ends}}) == arm.replace({"arm.radius": ends})


def test_a_list_of_one_dropped_the_other_cables(silicone: hs.Arm) -> None:
    both = silicone.replace({"cable": [{"tension": 0.1}, {"tension": "50 mN"}]})
    assert both == silicone.replace(tensions=[0.1, 0.05])
    with pytest.raises(ValueError, match=r"^changes\['cable'\]: the arm has 2 cables, 1 tables were given; .*cable\[0\]"):
        silicone.replace({"cable": [{"tension": 0.1}]})
    three = [{"name": name, "offset": 0.002} for name in "abc"]
    assert silicone.replace({"cable": three}).cables == ("a", "b", "c")


@given(
    points=st.lists(st.floats(0.002, 0.02), min_size=2, max_size=8),
    name=st.text(st.characters(exclude_categories=["Cs"]), max_size=20),
)
def test_numbers_and_texts_arrive_as_they_are(points: list[float], name: str) -> None:
    table = np.stack([np.linspace(0.0, 0.2, len(points)), points], axis=1)
    arm = hs.Arm(name=name, arm={"length": 0.2, "radius": table}, material={"young": 1e5})
    assert arm.name == name
    assert np.array_equal(arm.to_dict()["arm"]["radius"], table)


@pytest.mark.parametrize(
    ("make", "key", "words"),
    [
        (lambda: hs.Arm(arm={"lenght": 1}, material={"young": 1}), "arm.lenght", "did you mean `length`"),
        (lambda: hs.Arm(arm={"length": -1, "radius": 1}, material={"young": 1}), "arm.length", "above zero"),
        (lambda: hs.Arm(arm={"length": float("nan"), "radius": 1}, material={"young": 1}), "arm.length", "finite"),
        (lambda: hs.Arm.from_dict({"arm": {}, "materiel": {}}), "materiel", "unknown"),
        (lambda: hs.Arm.from_dict({"arm": {}}), "material", "missing"),
        (lambda: hs.Arm.load("paper").replace({"flow.sped": 1}), "flow.sped", "did you mean `speed`"),
        (lambda: hs.Arm.load("paper").replace(tensions=[-1, 0]), "cable[0].tension", "not negative"),
        (lambda: hs.Arm.load("paper").replace({"cable[7].tension": 1}), "cable", "0 to 1"),
    ],
)
def test_what_is_wrong_is_named(make: object, key: str, words: str) -> None:
    assert callable(make)
    with pytest.raises(hs.ArmError, match=".") as caught:
        make()
    assert isinstance(caught.value, ValueError)
    assert caught.value.key == key
    assert words in str(caught.value)
    again = pickle.loads(pickle.dumps(caught.value))
    assert (str(again), again.key) == (str(caught.value), key)


def test_no_such_file() -> None:
    with pytest.raises(FileNotFoundError, match="silicone"):
        hs.Arm.load("silicon")
    with pytest.raises(ValueError, match="arm.radius: expected a number"):
        hs.Arm(arm={"length": 1, "radius": object()}, material={})
