"""The clock of the page: an arm in motion, what ramps, releases and pulls it, and what a run comes to."""

from __future__ import annotations

import json
import re
import subprocess
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from conftest import PROGRAM, Viewer, Watched, solved
from jsonschema import Draft202012Validator
from playwright.sync_api import Browser, Page, WebSocket, expect
from test_page import agree, drag_tip, hash_of, numbers, overrides, set_slider, settle


def time_of(page: Page) -> float:
    found = re.search(r"[\d.]+", page.locator("#clock-time").inner_text())
    assert found is not None
    return float(found[0])


def set_going(page: Page, pace: str = "1") -> None:
    """In motion, at a pace of time."""
    page.get_by_role("switch", name="Motion").click()
    page.get_by_label("Speed of time").select_option(pace)
    expect(page.locator("#verdict-title")).to_contain_text("In motion")


def until(page: Page, holds: Callable[[], bool]) -> None:
    """Waits, at most half a minute."""
    for _ in range(300):
        if holds():
            return
        page.wait_for_timeout(100)
    raise AssertionError(page.locator("#clock").inner_text())


def wait_until(page: Page, time: float) -> None:
    until(page, lambda: time_of(page) >= time)


def damped(tmp_path: Path, name: str = "silicone", more: str = "") -> Path:
    """A shipped arm with a relaxation time."""
    text = subprocess.run([PROGRAM, "arms", name], capture_output=True, text=True, check=True).stdout
    file = tmp_path / "damped.toml"
    file.write_text(f"{text}\n[dynamics]\nrelaxation_time = 0.02\n{more}")
    return file


def take(page: Page, file: Path) -> None:
    page.locator("#file").set_input_files(file)
    expect(page.locator("#arm")).to_have_value(file.name)
    settle(page)


def test_the_clock_plays_pauses_and_steps(watched: Watched) -> None:
    page = watched.open("#arm=silicone")
    switch = page.get_by_role("switch", name="Motion")
    expect(switch).to_have_attribute("aria-checked", "false")
    expect(page.locator("#play")).to_be_hidden()
    set_going(page)
    expect(switch).to_have_attribute("aria-checked", "true")
    wait_until(page, 0.3)
    page.get_by_role("button", name="Pause").click()
    expect(page.locator("#verdict-title")).to_contain_text("the clock stands at")
    page.wait_for_timeout(300)
    stands = time_of(page)
    page.wait_for_timeout(400)
    assert time_of(page) == stands
    page.get_by_label("Speed of time").select_option("0.1")
    page.get_by_role("button", name="Step").click()
    wait_until(page, stands + 0.004)
    page.wait_for_timeout(300)
    assert time_of(page) == pytest.approx(stands + 0.005, abs=0.0011)
    # The keys of the picture.
    page.locator("#drawing").focus()
    page.keyboard.press(" ")
    expect(page.locator("#play")).to_have_text("Pause")
    page.keyboard.press(" ")
    expect(page.locator("#play")).to_have_text("Play")
    before = time_of(page)
    page.keyboard.press(".")
    wait_until(page, before + 0.004)
    switch.click()
    expect(page.locator("#verdict-title")).to_have_text("In equilibrium, stable")
    agree(page, solved("silicone"))


def test_loads_are_ramped_and_released(page: Page, tmp_path: Path) -> None:
    file = damped(tmp_path)
    take(page, file)
    set_going(page)
    set_slider(page, "cable[0].tension", 0.15)
    expect(page.locator("#legend")).to_contain_text("left: 150 mN", timeout=20_000)
    page.locator("#release-load").select_option("left")
    page.get_by_role("button", name="Release").click()
    expect(page.locator("#legend")).to_contain_text("left: slack", timeout=20_000)
    assert hash_of(page)["cable[0].tension"] == "0.15", "the slider stays"
    page.get_by_role("button", name="Ramp to here").click()
    expect(page.locator("#legend")).to_contain_text("left: 150 mN", timeout=20_000)
    label = page.locator("#motion-charts canvas").first.get_attribute("aria-label") or ""
    assert re.search(r"Tip over time from \S+ to \S+ s, from \S+ to \S+ mm", label), label
    # Off, it is the equilibrium of the sliders.
    page.get_by_role("switch", name="Motion").click()
    settle(page)
    agree(page, solved(str(file), *overrides(page)))


@pytest.mark.parametrize("arm", ["silicone", "silicone-spatial"])
def test_the_tip_has_its_inertia(watched: Watched, tmp_path: Path, arm: str) -> None:
    page = watched.open(f"#arm={arm}")
    take(page, damped(tmp_path, arm))
    set_going(page)
    wait_until(page, 0.1)
    assert numbers(page)["Hand"] == "\u2013"
    before = float(numbers(page)["Tip y"].split()[0])
    drag_tip(page, -20, -60)
    page.wait_for_timeout(1500)
    assert numbers(page)["Hand"].endswith("N")
    held = float(numbers(page)["Tip y"].split()[0])
    assert held > before + 3
    box, cross = page.locator("#tip").bounding_box(), page.locator("#tip").get_attribute("data-held")
    assert box is not None and cross == "true"
    page.mouse.up()
    until(page, lambda: numbers(page)["Hand"] == "\u2013")
    wait_until(page, time_of(page) + 1.0)
    page.wait_for_timeout(300)
    assert float(numbers(page)["Tip y"].split()[0]) < held - 1, "it goes back"
    assert ("Tip z" in numbers(page)) == (arm == "silicone-spatial")


def test_the_tip_is_pulled_with_the_keys(page: Page, tmp_path: Path) -> None:
    take(page, damped(tmp_path))
    set_going(page)
    wait_until(page, 0.1)
    page.locator("#tip").focus()
    page.keyboard.down("ArrowUp")
    for _ in range(5):
        page.keyboard.down("ArrowUp")
    page.wait_for_timeout(1200)
    assert numbers(page)["Hand"].endswith("N")
    page.keyboard.up("ArrowUp")
    until(page, lambda: numbers(page)["Hand"] == "\u2013")


def test_a_run_that_ends_shows_its_verdict_and_keeps_what_it_has(page: Page, tmp_path: Path) -> None:
    take(page, damped(tmp_path))
    set_going(page)
    set_slider(page, "cable[0].tension", 1.5)
    expect(page.locator("#verdict-title")).to_have_text("The motion ended: cable fold", timeout=30_000)
    expect(page.locator("#verdict-lines")).to_contain_text("compresses its side of the arm to zero length at s =")
    expect(page.locator("#play")).to_be_disabled()
    expect(page.locator("#tip")).to_be_hidden()
    ended = time_of(page)
    assert ended > 0.02
    assert "Tip over time from 0.00" in (page.locator("#motion-charts canvas").first.get_attribute("aria-label") or "")
    set_slider(page, "cable[0].tension", 0.1)
    page.get_by_role("button", name="From rest").click()
    expect(page.locator("#verdict-title")).to_contain_text("In motion", timeout=20_000)
    expect(page.locator("#legend")).to_contain_text("left: 100 mN")


def test_what_is_no_load_begins_again(page: Page) -> None:
    page.locator("#arm").select_option("silicone")
    settle(page)
    set_going(page)
    wait_until(page, 0.5)
    page.get_by_role("button", name="Pause").click()
    set_slider(page, "material.young", 90e3)
    until(page, lambda: time_of(page) < 0.4)
    expect(page.locator("#verdict-title")).to_contain_text("In motion")
    # Another arm is looked at in equilibrium.
    page.locator("#arm").select_option("paper")
    settle(page)
    expect(page.get_by_role("switch", name="Motion")).to_have_attribute("aria-checked", "false")
    agree(page, solved("paper"))


def test_an_arm_that_cannot_move_is_refused(page: Page, tmp_path: Path) -> None:
    text = damped(tmp_path).read_text().replace("max_tension = \"1.5 N\"", "max_tension = \"1.5 N\"\nfriction = 0.1")
    file = tmp_path / "rubs.toml"
    file.write_text(text)
    take(page, file)
    page.get_by_role("switch", name="Motion").click()
    expect(page.locator("#toast")).to_contain_text("friction")
    expect(page.get_by_role("switch", name="Motion")).to_have_attribute("aria-checked", "false")
    expect(page.locator("#verdict-title")).to_contain_text("In equilibrium")


def test_messages_of_the_clock_fit_their_schema(watched: Watched, viewer: Viewer, tmp_path: Path) -> None:
    schema = viewer.get("session.schema.json")
    check = {kind: Draft202012Validator({**schema, "oneOf": [{"$ref": f"#/$defs/{kind}"}]}) for kind in ("Wish", "Reply")}
    seen: dict[str, list[Any]] = {"Wish": [], "Reply": []}

    def listen(socket: WebSocket) -> None:
        socket.on("framesent", lambda text: seen["Wish"].append(json.loads(text)))
        socket.on("framereceived", lambda text: seen["Reply"].append(json.loads(text)))

    watched.page.on("websocket", listen)
    page = watched.open("#arm=silicone-spatial")
    set_going(page)
    set_slider(page, "cable[0].tension", 0.15)
    drag_tip(page, -12, 16)
    page.mouse.up()
    page.get_by_role("button", name="Release").click()
    expect(page.locator("#legend")).to_contain_text("top: slack", timeout=20_000)
    page.get_by_role("switch", name="Motion").click()
    settle(page)
    moving = {kind: [message for message in messages if "motion" in message] for kind, messages in seen.items()}
    for kind, messages in moving.items():
        assert len(messages) > 5
        for message in messages[:3] + messages[-20:]:
            errors = [error.message for error in check[kind].iter_errors(message)]
            assert errors == [], f"{kind} {str(message)[:300]}"
    assert sum("start" in wish["motion"] for wish in moving["Wish"]) == 1
    assert all(any(key in wish["motion"] for wish in moving["Wish"]) for key in ("loads", "hold"))
    # One at a time: nothing is asked for before the last answer.
    assert len(moving["Wish"]) - len(moving["Reply"]) in (0, 1)
    assert all(reply["dropped"] == 0 for reply in moving["Reply"])


def test_a_run_ends_with_its_connection(browser: Browser) -> None:
    server = Viewer()
    page = browser.new_page()
    page.goto(f"{server.url}#arm=silicone")
    page.wait_for_selector("#verdict[data-level]")
    set_going(page)
    port = server.url.rstrip("/").rpartition(":")[2]
    server.close()
    expect(page.locator("#link")).to_have_text("not connected")
    expect(page.get_by_role("switch", name="Motion")).to_have_attribute("aria-checked", "false")
    again = Viewer(port=port)
    expect(page.locator("#verdict-title")).to_have_text("In equilibrium, stable", timeout=15_000)
    page.close()
    again.close()


def test_a_moving_arm_is_not_read_aloud_all_the_time(watched: Watched) -> None:
    page = watched.open("#arm=silicone")
    settle(page)
    set_going(page)
    page.evaluate(
        """() => {
          window.said = [];
          for (const region of document.querySelectorAll('[aria-live]:not([aria-live=off]), [role=status], [role=alert], output')) {
            new MutationObserver(() => window.said.push(region.id)).observe(region, { childList: true, characterData: true, subtree: true });
          }
        }"""
    )
    page.wait_for_timeout(3000)
    said = page.evaluate("window.said")
    assert len(said) <= 3, said
    assert "In motion" in (page.locator("#said").text_content() or "")
    tree = page.locator("#clock").aria_snapshot()
    for part in (
        'switch "Motion" [checked]', 'button "Pause"', 'button "Step"', 'combobox "Speed of time"', 'spinbutton "Time of a ramp, s"', 'button "Ramp to here"',
        'combobox "Load to release"', 'button "Release"', 'button "From rest"', 'img "Energies over time',
    ):
        assert part in tree, f"{part}\n{tree}"


def test_everything_of_the_clock_is_reached_with_the_keyboard(watched: Watched) -> None:
    page = watched.open("#arm=silicone")
    settle(page)
    page.get_by_role("switch", name="Motion").focus()
    page.keyboard.press("Enter")
    expect(page.locator("#play")).to_be_visible()
    reached = []
    for _ in range(9):
        page.keyboard.press("Tab")
        reached.append(page.evaluate("document.activeElement?.id"))
    for wanted in ("play", "step", "pace", "ramp-time", "ramp-here", "release-load", "release", "from-rest"):
        assert wanted in reached, f"{wanted}: {reached}"


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_a_phone_shows_the_clock_without_scrolling_sideways(watched: Watched, scheme: Any) -> None:
    page = watched.page
    page.emulate_media(color_scheme=scheme)
    page.set_viewport_size({"width": 390, "height": 844})
    watched.open("#arm=silicone")
    assert page.evaluate("document.documentElement.scrollWidth") <= 390
    set_going(page)
    assert page.evaluate("document.documentElement.scrollWidth") <= 390
    small = page.evaluate(
        """() => [...document.querySelectorAll('#clock button, #clock select, #clock input')]
          .map((one) => [one.id, one.getBoundingClientRect().height]).filter(([, height]) => height < 28)"""
    )
    assert small == []
    box, play = page.locator("#drawing").bounding_box(), page.locator("#play").bounding_box()
    assert box is not None and play is not None and box["y"] + box["height"] <= play["y"] and play["y"] + play["height"] < 844
