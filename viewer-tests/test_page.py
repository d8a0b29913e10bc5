"""The page in a real browser: what it shows is what the command line says."""

from __future__ import annotations

import json
import re
import shlex
import subprocess
from pathlib import Path
from typing import Any
from urllib.parse import parse_qsl

import pytest
from conftest import PROGRAM, Viewer, Watched, arm_file, solved
from playwright.sync_api import Browser, Page, expect


def numbers(page: Page) -> dict[str, str]:
    """The numbers beside the picture, by name."""
    rows = page.locator("#numbers > div").all()
    return {row.locator("dt").inner_text(): row.locator("dd").inner_text().replace("\u2212", "-") for row in rows}


def shown(page: Page) -> list[float]:
    """Tip x, y (mm), its turn and alpha (deg)."""
    table = numbers(page)
    return [float(re.split("[ \u00b0]", table[name])[0]) for name in ("Tip x", "Tip y", "Tip turned by", "Tip section, \u03b1(L)")]


def said(solution: Any) -> list[float]:
    tip = solution["tip"]
    degrees = 57.29577951308232
    return [1e3 * tip["x"], 1e3 * tip["y"], degrees * tip["theta"], degrees * tip["alpha"]]


def agree(page: Page, solution: Any) -> None:
    assert shown(page) == pytest.approx(said(solution), abs=6e-4)


def settle(page: Page) -> None:
    """Until the address has what is shown, and both stay as they are."""
    before = None
    for _ in range(40):
        page.wait_for_timeout(400)
        now = (page.url, page.locator("#numbers").inner_text())
        if now == before:
            return
        before = now


def hash_of(page: Page) -> dict[str, str]:
    return dict(parse_qsl(page.url.partition("#")[2]))


def overrides(page: Page) -> list[str]:
    """The state in the address as arguments of the program."""
    values = {key: value for key, value in hash_of(page).items() if key not in ("arm", "toml")}
    return [argument for key, value in values.items() for argument in ("--set", f"{key}={value}")]


def set_slider(page: Page, key: str, value: float) -> None:
    page.locator(f'input[type=range][data-key="{key}"]').evaluate(
        "(slider, value) => { slider.value = value; slider.dispatchEvent(new Event('input', { bubbles: true })); }", value
    )


def test_the_page_opens_with_the_answer_of_the_program(page: Page) -> None:
    agree(page, solved("paper"))
    expect(page.locator("#arm")).to_have_value("paper")
    assert page.locator("#drawing").bounding_box()["width"] > 500


def test_sliders_move_the_arm(page: Page) -> None:
    set_slider(page, "cable[0].tension", 20)
    set_slider(page, "flow.speed", 0.3)
    set_slider(page, "flow.direction", 90)
    set_slider(page, "tip.force[1]", 0.5)
    settle(page)
    state = hash_of(page)
    assert float(state["cable[0].tension"]) == 20
    agree(page, solved("paper", *overrides(page)))


def test_sliders_and_boxes_are_reached_with_the_keyboard(page: Page) -> None:
    slider = page.locator('input[type=range][data-key="cable[0].tension"]')
    slider.focus()
    before = float(slider.input_value())
    for _ in range(5):
        page.keyboard.press("ArrowLeft")
    settle(page)
    assert float(slider.input_value()) < before
    agree(page, solved("paper", *overrides(page)))
    box = page.locator('[data-box="cable[0].tension"]')
    box.fill("33.25")
    box.press("Enter")
    settle(page)
    assert hash_of(page)["cable[0].tension"] == "33.25"
    agree(page, solved("paper", *overrides(page)))


def drag_tip(page: Page, dx: float, dy: float, steps: int = 12) -> None:
    box = page.locator("#tip").bounding_box()
    assert box is not None
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    page.mouse.move(x, y)
    page.mouse.down()
    page.mouse.move(x + dx, y + dy, steps=steps)
    page.wait_for_timeout(300)


def test_the_tip_follows_the_mouse(watched: Watched) -> None:
    page = watched.open("#arm=silicone&cable[0].tension=0.4&cable[1].tension=0.2")
    before = shown(page)
    box = page.locator("#tip").bounding_box()
    assert box is not None
    drag_tip(page, -12, 16)
    held = page.locator("#tip").bounding_box()
    assert held is not None
    assert held["x"] - box["x"] == pytest.approx(-12, abs=0.6)
    assert held["y"] - box["y"] == pytest.approx(16, abs=0.6)
    page.mouse.up()
    settle(page)
    after = shown(page)
    assert after[0] != before[0] and after[1] != before[1]
    assert "cable[1].tension" in hash_of(page)
    agree(page, solved("silicone", *overrides(page)))


def test_a_tip_that_cannot_follow_says_why(watched: Watched) -> None:
    page = watched.open("#arm=silicone&cable[0].tension=0.3")
    drag_tip(page, 260, 0)
    expect(page.locator("#verdict")).to_contain_text("The tip cannot go there")
    expect(page.locator("#verdict")).to_contain_text("is slack")
    page.mouse.up()
    settle(page)
    agree(page, solved("silicone", *overrides(page)))


def test_the_tip_moves_with_the_arrow_keys(watched: Watched) -> None:
    page = watched.open("#arm=silicone&cable[0].tension=0.4&cable[1].tension=0.2")
    before = shown(page)
    page.locator("#tip").focus()
    page.keyboard.press("ArrowDown")
    settle(page)
    after = shown(page)
    # A hundredth of the length, 2.45 mm.
    assert [after[0] - before[0], after[1] - before[1]] == pytest.approx([0, -2.45], abs=0.01)


def test_too_much_tension_is_said_in_words(watched: Watched) -> None:
    page = watched.open("#arm=silicone&cable[0].tension=1.2")
    verdict = page.locator("#verdict")
    expect(verdict).to_have_attribute("data-level", "bad")
    expect(verdict).to_contain_text("No equilibrium at these loads: cable fold")
    expect(verdict).to_contain_text("Try: lower the tension")
    expect(verdict).to_contain_text("not the loads asked for")
    assert solved("silicone", "--tension", "1.2,0")["verdict"]["kind"] == "cable_fold"
    expect(page.locator("#tip")).to_be_hidden()


def test_an_unstable_shape_is_called_unstable(watched: Watched) -> None:
    # An upright column too heavy for its stiffness stays on its symmetric branch.
    settings = {"material.young": "3000", "arm.base.angle": "90", "gravity.acceleration": "9.81", "arm.density": "1500"}
    page = watched.open("#arm=silicone&" + "&".join(f"{key}={value}" for key, value in settings.items()))
    arguments = [argument for key, value in settings.items() for argument in ("--set", f"{key}={value}")]
    assert solved("silicone", *arguments)["stable"] is False
    expect(page.locator("#verdict")).to_contain_text("unstable: the arm would leave this shape at the slightest push")
    expect(page.locator("#verdict")).to_have_attribute("data-level", "warn")


def test_every_warning_is_shown(watched: Watched) -> None:
    page = watched.open("#arm=paper&cable[0].tension=80")
    answer = solved("paper", "--tension", "80,0")
    assert answer["warnings"], "this arm is chosen for its warnings"
    text = page.locator("#verdict").inner_text().lower()
    for warning in answer["warnings"]:
        assert warning["message"].lower() in text


def test_a_refused_value_is_named(watched: Watched) -> None:
    page = watched.open("#arm=silicone")
    box = page.locator('[data-box="cable[0].tension"]')
    box.fill("9")
    box.press("Enter")
    expect(page.locator("#verdict")).to_contain_text("The request is refused")
    expect(page.locator("#verdict")).to_contain_text("max_tension")


def test_a_stroke_can_be_given(watched: Watched) -> None:
    page = watched.open("#arm=silicone&cable[0].tension=0.3")
    page.get_by_label("What is given of cable left").select_option("stroke")
    settle(page)
    stroke = hash_of(page)["cable[0].stroke"]
    agree(page, solved("silicone", "--set", f"cable[0].stroke={stroke}"))


def test_files_are_read_and_dropped(page: Page, tmp_path: Path) -> None:
    file = arm_file(tmp_path)
    page.locator("#file").set_input_files(file)
    expect(page.locator("#arm")).to_have_value("mine.toml")
    settle(page)
    agree(page, solved(str(file)))
    other = file.read_text().replace("length = 0.3", "length = 0.35")
    drop(page, "other.toml", other)
    expect(page.locator("#arm")).to_have_value("other.toml")
    settle(page)
    (tmp_path / "other.toml").write_text(other)
    agree(page, solved(str(tmp_path / "other.toml")))
    # The whole arm is in the address.
    again = page.context.new_page()
    again.goto(page.url)
    again.wait_for_selector("#verdict[data-level]")
    settle(again)
    agree(again, solved(str(tmp_path / "other.toml")))


def drop(page: Page, name: str, text: str) -> None:
    page.evaluate(
        """([name, text]) => {
          const transfer = new DataTransfer();
          transfer.items.add(new File([text], name));
          for (const kind of ['dragover', 'drop']) window.dispatchEvent(new DragEvent(kind, { dataTransfer: transfer, bubbles: true, cancelable: true }));
        }""",
        [name, text],
    )


def test_a_file_that_is_no_arm_leaves_the_present_one(viewer: Viewer, browser: Browser) -> None:
    # Not the watched page: the browser itself logs the server's 400.
    page = browser.new_page()
    page.goto(viewer.url)
    page.wait_for_selector("#verdict[data-level]")
    drop(page, "wrong.toml", "[arm]\nlenght = 3\n")
    expect(page.locator("#toast")).to_contain_text("arm.lenght")
    expect(page.locator("#toast")).to_contain_text("did you mean `length`?")
    expect(page.locator("#arm")).to_have_value("paper")
    page.close()


def test_links_keep_the_state(page: Page) -> None:
    page.locator("#arm").select_option("multi-bending")
    set_slider(page, "cable[1].tension", 2)
    page.locator('select[data-key="model.volume"]').select_option("circular")
    settle(page)
    here = shown(page)
    other = page.context.new_page()
    other.goto(page.url)
    other.wait_for_selector("#verdict[data-level]")
    settle(other)
    assert shown(other) == here
    agree(page, solved("multi-bending", "--set", "cable[1].tension=2", "--set", "model.volume=circular"))


def share(page: Page, item: str) -> None:
    page.locator("#share > summary").click()
    page.locator(f'[data-share="{item}"]').click()


def test_the_command_line_that_is_copied_gives_the_same(page: Page) -> None:
    set_slider(page, "cable[0].tension", 12.5)
    page.locator('select[data-key="flow.law"]').select_option("quadratic-drag")
    settle(page)
    share(page, "command")
    expect(page.locator("#toast")).to_contain_text("copied")
    words = shlex.split(page.evaluate("navigator.clipboard.readText()"))
    assert words[:3] == ["hydrostat", "solve", "paper"]
    agree(page, solved(*words[2:]))


def test_the_python_call_that_is_copied_gives_the_same(page: Page, capsys: pytest.CaptureFixture[str]) -> None:
    pytest.importorskip("hydrostat", reason="the Python package is not installed here")
    set_slider(page, "cable[1].tension", 20)
    page.locator('select[data-key="model.volume"]').select_option("circular")
    settle(page)
    share(page, "python")
    expect(page.locator("#toast")).to_contain_text("copied")
    space: dict[str, Any] = {}
    exec(page.evaluate("navigator.clipboard.readText()"), space)
    tip = space["sol"].tip
    agree(page, {"tip": {"x": tip.x, "y": tip.y, "theta": tip.theta, "alpha": tip.alpha}})


@pytest.mark.parametrize("kind", ["toml", "csv", "json", "svg", "png", "view"])
def test_downloads(page: Page, kind: str, tmp_path: Path) -> None:
    set_slider(page, "cable[0].tension", 25)
    settle(page)
    with page.expect_download() as waiting:
        share(page, kind)
    file = tmp_path / waiting.value.suggested_filename
    waiting.value.save_as(file)
    same = solved("paper", "--tension", "25,0")
    if kind == "toml":
        assert solved(str(file))["stations"] == same["stations"]
    elif kind == "json":
        assert json.loads(file.read_text()) == same
    elif kind == "csv":
        run = subprocess.run([PROGRAM, "solve", "paper", "--tension", "25,0", "--format", "csv"], capture_output=True, text=True)
        assert file.read_text() == run.stdout
    elif kind == "svg":
        assert file.read_text().startswith("<svg")
    else:
        assert file.read_bytes().startswith(b"\x89PNG")


def test_charts_and_drawing_are_linked(page: Page) -> None:
    stations = solved("paper", "--stations", "121")["stations"]
    chart = page.locator("#along .chart").first
    chart.scroll_into_view_if_needed()
    canvas = chart.locator("canvas").bounding_box()
    assert canvas is not None
    page.mouse.move(canvas["x"] + 0.9 * canvas["width"], canvas["y"] + 0.5 * canvas["height"])
    text = chart.locator("output")
    expect(text).not_to_be_empty()
    value = float(text.inner_text().replace("\u2212", "-"))
    alphas = [57.29577951308232 * alpha for alpha in stations["alpha"]]
    assert min(alphas) <= value <= max(alphas) and value > 1
    # The mark is in all charts, and comes from the drawing, too.
    page.mouse.move(5, 5)
    page.locator("#tip").scroll_into_view_if_needed()
    tip = page.locator("#tip").bounding_box()
    assert tip is not None
    page.mouse.move(tip["x"] - 12, tip["y"] + 10)
    expect(page.locator("#along .chart output").last).not_to_be_empty()


def test_shapes_are_pinned_and_compared(page: Page) -> None:
    page.locator("#pin").click()
    set_slider(page, "cable[0].tension", 10)
    page.locator("#pin").click()
    expect(page.locator("#pins > span")).to_have_count(2)
    page.locator("#along .chart").first.scroll_into_view_if_needed()
    page.wait_for_timeout(1000)
    assert page.evaluate("Chart.getChart(document.querySelector('#along canvas')).data.datasets.length") == 3
    page.locator("#pins button").first.click()
    expect(page.locator("#pins > span")).to_have_count(1)


def test_a_path_shows_its_limit_points(watched: Watched) -> None:
    page = watched.open("#arm=silicone&flow.speed=0.2&flow.direction=180")
    page.locator("#tab-path").click()
    page.locator("#path-key").select_option("arm.base.angle")
    page.locator("#path-from").fill("90")
    page.locator("#path-to").fill("-90")
    page.get_by_role("button", name="Trace").click()
    expect(page.locator("#path-words")).to_contain_text("4 limit points", timeout=30_000)
    expect(page.locator("#path-words")).to_contain_text("unstable at")


def test_readings_stand_side_by_side(watched: Watched) -> None:
    page = watched.open("#arm=paper&cable[0].tension=20")
    page.locator("#tab-readings").click()
    rows = page.locator("#readings-table tbody tr")
    expect(rows).to_have_count(10, timeout=20_000)
    row = rows.filter(has_text="Volume: circular").locator("td").all_inner_texts()
    tip = said(solved("paper", "--tension", "20,0", "--set", "model.volume=circular"))
    values = [float(text.replace("\u2212", "-")) for text in row[1:4]]
    assert values == pytest.approx([tip[0], tip[1], tip[3]], abs=6e-4)
    rows.filter(has_text="Volume: circular").get_by_role("button").click()
    expect(rows.filter(has_text="Volume: circular").get_by_role("button")).to_have_attribute("aria-pressed", "true")


def test_all_equilibria_are_found(watched: Watched) -> None:
    page = watched.open("#arm=silicone&flow.speed=0.2&flow.direction=180")
    page.locator("#tab-all").click()
    page.get_by_role("button", name="Search").click()
    expect(page.locator("#all-words")).to_contain_text("5 found, 3 of them stable. These are all.", timeout=30_000)
    expect(page.locator("#all-table tbody tr")).to_have_count(5)
    expect(page.locator("#all-picture")).to_be_visible()


def test_a_ramp_runs_and_stops_at_the_verdict(page: Page, tmp_path: Path) -> None:
    # With a largest tension that the tip does not carry.
    text = subprocess.run([PROGRAM, "arms", "silicone"], capture_output=True, text=True).stdout
    file = tmp_path / "strong.toml"
    file.write_text(re.sub("max_tension = .*", "max_tension = 1.5", text))
    page.locator("#file").set_input_files(file)
    expect(page.locator("#arm")).to_have_value("strong.toml")
    slider = page.locator('input[type=range][data-key="cable[0].tension"]')
    page.get_by_label("Raise left from zero and watch").click()
    expect(page.locator("#verdict")).to_contain_text("cable fold", timeout=20_000)
    page.wait_for_timeout(200)
    stopped = float(slider.input_value())
    page.wait_for_timeout(300)
    assert float(slider.input_value()) == stopped, "it has stopped"
    settle(page)
    verdict = solved(str(file), "--set", f"cable[0].tension={hash_of(page)['cable[0].tension']}")["verdict"]
    assert verdict["kind"] == "cable_fold"


def test_a_phone_shows_everything_without_scrolling_sideways(watched: Watched) -> None:
    page = watched.open()
    page.set_viewport_size({"width": 390, "height": 844})
    page.wait_for_timeout(300)
    assert page.evaluate("document.documentElement.scrollWidth") <= 390
    box = page.locator("#drawing").bounding_box()
    tip = page.locator("#tip").bounding_box()
    assert box is not None and tip is not None
    assert box["x"] <= tip["x"] and tip["x"] + tip["width"] <= box["x"] + box["width"]
    slider = page.locator('input[type=range][data-key="flow.speed"]')
    slider.scroll_into_view_if_needed()
    set_slider(page, "flow.speed", 0.2)
    settle(page)
    agree(page, solved("paper", *overrides(page)))


def test_two_fingers_zoom_about_what_they_hold(page: Page) -> None:
    stage = page.locator("#drawing").bounding_box()
    assert stage is not None
    middle = [stage["x"] + 0.5 * stage["width"], stage["y"] + 0.5 * stage["height"]]
    fingers = page.context.new_cdp_session(page)

    def tip() -> tuple[float, float]:
        box = page.locator("#tip").bounding_box()
        assert box is not None
        return box["x"] + 0.5 * box["width"], box["y"] + 0.5 * box["height"]

    def touch(kind: str, apart: float) -> None:
        points = [{"x": middle[0] + side * apart, "y": middle[1] + 40, "id": k} for k, side in enumerate((-1, 1))]
        fingers.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": points if kind != "touchEnd" else []})

    before = tip()
    touch("touchStart", 60)
    for apart in (70, 80, 90):
        touch("touchMove", apart)
    touch("touchEnd", 90)
    page.wait_for_timeout(100)
    after = tip()
    held = (middle[0], middle[1] + 40)
    for was, now, about in zip(before, after, held, strict=True):
        assert now - about == pytest.approx(1.5 * (was - about), abs=2)


def test_dark_and_light(page: Page) -> None:
    before = page.evaluate("getComputedStyle(document.body).backgroundColor")
    page.locator("#theme").click()
    assert page.evaluate("getComputedStyle(document.body).backgroundColor") != before
    page.reload()
    page.wait_for_selector("#verdict[data-level]")
    assert page.evaluate("getComputedStyle(document.body).backgroundColor") != before, "it is remembered"


def test_every_control_has_a_name(page: Page) -> None:
    nameless = page.evaluate(
        """() => [...document.querySelectorAll('button, input, select, summary, canvas')].filter((one) => {
          if (one.hidden || one.closest('[hidden]')) return false;
          const label = one.getAttribute('aria-label') || one.textContent.trim() || one.title;
          return !label && !(one.labels && one.labels.length) && !one.getAttribute('aria-labelledby');
        }).map((one) => one.outerHTML)"""
    )
    assert nameless == []
    assert page.locator("#verdict").get_attribute("aria-live") == "polite"


def test_the_view_pans_and_zooms(page: Page) -> None:
    def tip() -> list[float]:
        box = page.locator("#tip").bounding_box()
        assert box is not None
        return [box["x"], box["y"]]

    before = tip()
    page.locator("#zoom-in").click()
    assert tip() != before
    page.locator("#fit").click()
    assert tip() == pytest.approx(before, abs=0.5)
    page.locator("#drawing").focus()
    page.keyboard.press("ArrowLeft")
    assert tip()[0] == pytest.approx(before[0] + 25, abs=0.5)
    page.keyboard.press("0")
    canvas = page.locator("#drawing").bounding_box()
    assert canvas is not None
    page.mouse.move(canvas["x"] + 60, canvas["y"] + canvas["height"] - 80)
    page.mouse.down()
    page.mouse.move(canvas["x"] + 100, canvas["y"] + canvas["height"] - 60)
    page.mouse.up()
    assert tip() == pytest.approx([before[0] + 40, before[1] + 20], abs=0.5)


def test_a_lost_server_is_said_and_found_again(browser: Browser) -> None:
    # Not a watched page: the browser itself logs that the server is gone.
    server = Viewer()
    page = browser.new_page()
    page.goto(server.url)
    page.wait_for_selector("#verdict[data-level]")
    port = server.url.rstrip("/").rpartition(":")[2]
    server.close()
    expect(page.locator("#link")).to_have_text("not connected")
    again = Viewer(port=port)
    expect(page.locator("#link")).to_contain_text("ms", timeout=15_000)
    set_slider(page, "cable[0].tension", 15)
    settle(page)
    agree(page, solved("paper", "--tension", "15,0"))
    page.close()
    again.close()


def test_latency_is_measured(page: Page, capsys: pytest.CaptureFixture[str]) -> None:
    """Prints the times; nothing is asked of them here but that there are some."""
    page.evaluate("window.hydrostatLatencies.length = 0")
    page.evaluate(
        """async () => {
          const slider = document.querySelector('input[type=range][data-key="cable[0].tension"]');
          for (let k = 0; k < 200; k += 1) {
            slider.value = 20 + 0.1 * k;
            slider.dispatchEvent(new Event('input', { bubbles: true }));
            await new Promise((done) => setTimeout(done, 25));
          }
        }"""
    )
    page.wait_for_timeout(300)
    times = sorted(page.evaluate("window.hydrostatLatencies"))
    assert len(times) > 20
    with capsys.disabled():
        print(f"\nslider to picture: median {times[len(times) // 2]:.1f} ms, 95 % {times[int(0.95 * len(times))]:.1f} ms, {len(times)} pictures")
