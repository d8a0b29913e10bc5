"""Arms in space in the page: what it shows is what the command line says."""

from __future__ import annotations

import re
from typing import Any

import pytest
from conftest import Watched, solved
from playwright.sync_api import Page, expect
from test_page import drag_tip, hash_of, numbers, overrides, picture, set_slider, settle

ARM = "#arm=silicone-spatial"
PULLED = f"{ARM}&cable[0].tension=0.2&cable[1].tension=0.15&cable[2].tension=0.1"


def shown(page: Page) -> list[float]:
    """Tip x, y, z (mm), its normal and alpha (deg)."""
    table = numbers(page)
    place = [float(table[f"Tip {axis}"].split()[0]) for axis in "xyz"]
    normal = [float(v) for v in re.findall(r"-?\d+\.\d+", table["Tip normal a"])]
    return [*place, *normal, float(table["Tip section, \u03b1(L)"].rstrip("\u00b0"))]


def said(solution: Any) -> list[float]:
    tip = solution["tip"]
    return [*(1e3 * tip[axis] for axis in "xyz"), *tip["a"], 57.29577951308232 * tip["alpha"]]


def agree(page: Page, *arguments: str) -> None:
    assert shown(page) == pytest.approx(said(solved("silicone-spatial", *arguments)), abs=6e-4)


def test_an_arm_in_space_opens_with_the_answer_of_the_program(watched: Watched) -> None:
    page = watched.open(ARM)
    agree(page)
    expect(page.locator("#verdict")).to_contain_text("In equilibrium, stable")
    expect(page.locator("#sides")).to_be_visible()
    expect(page.locator('#sides [data-side="3D"]')).to_have_attribute("aria-pressed", "true")
    expect(page.locator("#tip")).to_be_visible()
    expect(page.locator("#along figcaption")).to_have_count(14)
    expect(page.locator("#along")).to_contain_text("\u03c4, twist")


def test_the_view_turns_pans_and_has_sides(watched: Watched) -> None:
    page = watched.open(ARM)
    before = picture(page)
    box = page.locator("#drawing").bounding_box()
    assert box is not None
    page.mouse.move(box["x"] + 60, box["y"] + 200)
    page.mouse.down()
    page.mouse.move(box["x"] + 140, box["y"] + 220, steps=5)
    page.mouse.up()
    turned = picture(page)
    assert turned != before
    expect(page.locator('#sides [aria-pressed="true"]')).to_have_count(0)
    tip = page.locator("#tip").bounding_box()
    page.locator("#drawing").focus()
    page.keyboard.press("ArrowLeft")
    by_key = picture(page)
    assert by_key != turned
    page.keyboard.press("Shift+ArrowRight")
    assert picture(page) != by_key
    page.get_by_role("button", name="xz", exact=True).click()
    assert page.locator("#tip").bounding_box() != tip
    page.get_by_role("button", name="3D", exact=True).click()
    page.mouse.move(5, 5)
    assert picture(page) == before
    agree(page)


def test_the_tip_follows_the_mouse_in_the_plane_of_the_page(watched: Watched) -> None:
    page = watched.open(PULLED)
    page.get_by_role("button", name="yz", exact=True).click()
    before = shown(page)
    box = page.locator("#tip").bounding_box()
    assert box is not None
    # Across the arm, where three cables move its tip.
    drag_tip(page, 14, -10)
    held = page.locator("#tip").bounding_box()
    assert held is not None
    page.mouse.up()
    settle(page)
    after = shown(page)
    assert after[1] > before[1] and after[2] > before[2]
    assert "cable[2].tension" in hash_of(page)
    agree(page, *overrides(page))


def test_the_tip_moves_with_the_arrow_keys_in_space(watched: Watched) -> None:
    page = watched.open(PULLED)
    page.get_by_role("button", name="xz", exact=True).click()
    before = shown(page)
    page.locator("#tip").focus()
    page.keyboard.press("ArrowUp")
    settle(page)
    after = shown(page)
    assert after[2] > before[2] + 0.5
    agree(page, *overrides(page))


def test_stream_gravity_and_loads_come_from_anywhere(watched: Watched) -> None:
    page = watched.open(ARM)
    set_slider(page, "flow.speed", 0.2)
    set_slider(page, "flow.direction[0]", 0)
    set_slider(page, "flow.direction[2]", 1)
    set_slider(page, "gravity.acceleration", 9.81)
    set_slider(page, "gravity.direction[2]", -0.5)
    set_slider(page, "tip.moment[0]", 0.0001)
    settle(page)
    agree(page, *overrides(page))
    expect(page.locator("#legend")).to_contain_text("stream 0.2 m/s along (0.00, 0.00, 1.00)")


def test_a_verdict_in_space_is_said_in_words(watched: Watched) -> None:
    page = watched.open(f"{ARM}&cable[0].tension=1.4")
    answer = solved("silicone-spatial", "--set", "cable[0].tension=1.4")
    assert answer["converged"] is False
    assert answer["verdict"]["kind"] == "cable_fold"
    expect(page.locator("#verdict")).to_contain_text("No equilibrium at these loads: side compressed to zero length")
    expect(page.locator("#tip")).to_be_hidden()


def test_an_arm_of_the_plane_after_one_in_space(watched: Watched) -> None:
    page = watched.open(ARM)
    page.locator("#arm").select_option("silicone")
    settle(page)
    expect(page.locator("#sides")).to_be_hidden()
    expect(page.locator("#along figcaption")).to_have_count(8)
    assert "Tip z" not in numbers(page)
    page.locator("#arm").select_option("octopus-spatial")
    settle(page)
    expect(page.locator("#sides")).to_be_visible()
    assert shown(page) == pytest.approx(said(solved("octopus-spatial")), abs=6e-4)


def test_studies_know_the_third_direction(watched: Watched) -> None:
    page = watched.open(ARM)
    page.locator("#tab-path").click()
    page.locator("#path-key").select_option("cable[1].tension")
    page.locator("#path-to").fill("0.3")
    page.get_by_role("button", name="Trace").click()
    expect(page.locator("#path-words")).to_contain_text("stable all along", timeout=20_000)
    expect(page.locator("#path-charts")).to_contain_text("Tip z (mm)")
    page.locator("#tab-readings").click()
    expect(page.locator("#readings-table")).to_contain_text("Tip z (mm)", timeout=20_000)
    expect(page.locator("#readings-table tbody tr").first).to_contain_text("stable")


def test_a_phone_shows_an_arm_in_space_without_scrolling_sideways(watched: Watched) -> None:
    page = watched.page
    page.set_viewport_size({"width": 390, "height": 844})
    watched.open(ARM)
    assert page.evaluate("document.documentElement.scrollWidth") <= 390
    expect(page.locator("#sides")).to_be_visible()
