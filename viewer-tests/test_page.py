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
from jsonschema import Draft202012Validator
from playwright.sync_api import Browser, Page, WebSocket, expect


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


def picture(page: Page) -> str:
    """What the canvas shows."""
    page.wait_for_timeout(100)
    return str(page.evaluate("document.getElementById('drawing').toDataURL()"))


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
    expect(verdict).to_contain_text("No equilibrium at these loads: side compressed to zero length")
    expect(verdict).to_contain_text("Try: lower the tension")
    expect(verdict).to_contain_text("not the requested loads")
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
    page.get_by_label("Control of cable left").select_option("stroke")
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
    for key, value in {"flow.cn": "1.2", "flow.ct": "0.01"}.items():
        page.locator(f'[data-box="{key}"]').fill(value)
        page.locator(f'[data-box="{key}"]').press("Enter")
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


@pytest.mark.parametrize("kind", ["toml", "csv", "json", "svg", "pdf", "png", "view"])
def test_downloads(page: Page, kind: str, tmp_path: Path) -> None:
    set_slider(page, "cable[0].tension", 25)
    settle(page)
    with page.expect_download() as waiting:
        share(page, kind)
    assert waiting.value.suggested_filename == ("paper-view.png" if kind == "view" else f"paper.{kind}")
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
    elif kind == "pdf":
        assert file.read_bytes().startswith(b"%PDF-")
    else:
        assert file.read_bytes().startswith(b"\x89PNG")


def test_charts_and_drawing_are_linked(page: Page) -> None:
    stations = solved("paper", "--stations", "121")["stations"]
    chart = page.locator("#along .chart").first
    chart.scroll_into_view_if_needed()
    canvas = chart.locator("canvas").bounding_box()
    assert canvas is not None
    page.mouse.move(canvas["x"] + 0.9 * canvas["width"], canvas["y"] + 0.5 * canvas["height"])
    text = chart.locator(".value")
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
    expect(page.locator("#along .chart .value").last).not_to_be_empty()


def test_shapes_are_pinned_and_compared(page: Page) -> None:
    page.locator("#pin").click()
    set_slider(page, "cable[0].tension", 10)
    page.locator("#pin").click()
    expect(page.locator("#pins > span")).to_have_count(2)
    page.locator("#along .chart").first.scroll_into_view_if_needed()
    page.wait_for_timeout(1000)
    expect(page.locator("#along canvas").first).to_have_attribute("data-lines", "3")
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
    # A row is shown in the picture, and taken away again.
    before = picture(page)
    row = page.locator("#all-table tbody tr").nth(4)
    row.locator("td").nth(2).click()
    expect(row.get_by_role("button")).to_have_attribute("aria-pressed", "true")
    assert picture(page) != before
    row.get_by_role("button").click()
    expect(row.get_by_role("button")).to_have_attribute("aria-pressed", "false")
    assert picture(page) == before


def test_a_ramp_runs_and_stops_at_the_verdict(page: Page, tmp_path: Path) -> None:
    # With a largest tension that the tip does not carry.
    text = subprocess.run([PROGRAM, "arms", "silicone"], capture_output=True, text=True).stdout
    file = tmp_path / "strong.toml"
    file.write_text(re.sub("max_tension = .*", "max_tension = 1.5", text))
    page.locator("#file").set_input_files(file)
    expect(page.locator("#arm")).to_have_value("strong.toml")
    slider = page.locator('input[type=range][data-key="cable[0].tension"]')
    page.get_by_label("Raise left from zero and watch").click()
    expect(page.locator("#verdict")).to_contain_text("side compressed to zero length", timeout=20_000)
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


@pytest.mark.parametrize("scheme", ["dark", "light"])
def test_the_first_paint_was_light_on_dark_systems(viewer: Viewer, browser: Browser, scheme: Any) -> None:
    # Without the page's modules: what is there before they come.
    page = browser.new_page(color_scheme=scheme)
    page.route("**/main.js", lambda route: route.abort())
    page.goto(viewer.url)
    red = int(re.findall(r"\d+", page.evaluate("getComputedStyle(document.body).backgroundColor"))[0])
    assert (red < 60) == (scheme == "dark"), red
    page.close()


def test_every_control_has_a_name(page: Page) -> None:
    nameless = page.evaluate(
        """() => [...document.querySelectorAll('button, input, select, summary, canvas')].filter((one) => {
          if (one.hidden || one.closest('[hidden]')) return false;
          const label = one.getAttribute('aria-label') || one.textContent.trim() || one.title;
          return !label && !(one.labels && one.labels.length) && !one.getAttribute('aria-labelledby');
        }).map((one) => one.outerHTML)"""
    )
    assert nameless == []


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
    expect(page.locator("#link")).to_have_text("", timeout=15_000)
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


def test_messages_fit_their_schema(watched: Watched, viewer: Viewer) -> None:
    schema = viewer.get("session.schema.json")
    check = {kind: Draft202012Validator({**schema, "oneOf": [{"$ref": f"#/$defs/{kind}"}]}) for kind in ("Wish", "Reply")}
    seen: dict[str, list[Any]] = {"Wish": [], "Reply": []}

    def listen(socket: WebSocket) -> None:
        socket.on("framesent", lambda text: seen["Wish"].append(json.loads(text)))
        socket.on("framereceived", lambda text: seen["Reply"].append(json.loads(text)))

    watched.page.on("websocket", listen)
    page = watched.open("#arm=silicone&cable[0].tension=0.4&cable[1].tension=0.2&flow.speed=0.1")
    set_slider(page, "flow.speed", 0.2)
    drag_tip(page, -12, 16)
    page.mouse.up()
    set_slider(page, "cable[0].tension", 0.9)
    settle(page)
    for box in ("0.3", "99"):
        page.locator('[data-box="cable[0].tension"]').fill(box)
        page.locator('[data-box="cable[0].tension"]').press("Enter")
        settle(page)
    for kind, messages in seen.items():
        assert len(messages) > 5
        for message in messages:
            errors = [error.message for error in check[kind].iter_errors(message)]
            assert errors == [], f"{kind} {str(message)[:300]}"
    assert any("target" in wish for wish in seen["Wish"]) and any("pulled" in reply for reply in seen["Reply"])
    assert any("error" in reply for reply in seen["Reply"]) and any("layer" in reply.get("drawing", {}) for reply in seen["Reply"])


def test_what_to_do_first_is_said_until_it_was_done(watched: Watched) -> None:
    page = watched.open("#arm=silicone&cable[0].tension=0.4&cable[1].tension=0.2")
    expect(page.locator("#hint")).to_be_visible()
    expect(page.locator("#hint")).to_have_text("drag the tip")
    drag_tip(page, -8, 10)
    page.mouse.up()
    expect(page.locator("#hint")).to_be_hidden()
    page.reload()
    page.wait_for_selector("#verdict[data-level]")
    expect(page.locator("#hint")).to_be_hidden()


def test_help_opens_and_leads_to_the_guide(watched: Watched) -> None:
    page = watched.open()
    page.locator("#help").focus()
    page.keyboard.press("Enter")
    expect(page.get_by_role("dialog", name="What you can do here")).to_be_visible()
    page.keyboard.press("Escape")
    expect(page.locator("#help-dialog")).to_be_hidden()
    page.locator("#help").click()
    with page.expect_popup() as opened:
        page.get_by_role("link", name="Guide to the viewer").click()
    guide = opened.value
    expect(guide.locator("#readings")).to_contain_text("beta = 1/nu")
    expect(guide.locator("#law")).to_contain_text("quadratic-drag")


@pytest.mark.parametrize("size", [(1360, 900), (390, 844), (1000, 600)])
def test_the_tip_was_under_buttons(watched: Watched, size: tuple[int, int]) -> None:
    watched.page.set_viewport_size({"width": size[0], "height": size[1]})
    for state in ("#arm=paper&cable[0].tension=40", "#arm=silicone&cable[1].tension=0.3", "#arm=silicone&arm.base.angle=90", "#arm=octopus"):
        page = watched.open(state)
        settle(page)
        top = page.evaluate(
            """() => {
              const box = document.getElementById('tip').getBoundingClientRect();
              return document.elementFromPoint(box.x + box.width / 2, box.y + box.height / 2)?.id;
            }"""
        )
        assert top == "tip", state


def test_the_picture_shows_gravity(watched: Watched) -> None:
    page = watched.open("#arm=silicone&gravity.acceleration=9.81")
    before = picture(page)
    page.get_by_text("Show", exact=True).click()
    page.get_by_label("Gravity", exact=True).uncheck()
    assert picture(page) != before


def test_drag_coefficients_are_asked_for_as_on_the_command_line(watched: Watched) -> None:
    page = watched.open("#arm=paper&flow.speed=0.1&flow.direction=90")
    box = page.locator('[data-box="flow.cn"]')
    expect(box).to_be_hidden()
    page.locator('select[data-key="flow.law"]').select_option("quadratic-drag")
    expect(box).to_be_visible()
    run = subprocess.run([PROGRAM, "solve", "paper", "--set", "flow.law=quadratic-drag"], capture_output=True, text=True)
    assert run.returncode == 2 and "flow.cn" in run.stderr
    expect(page.locator("#verdict")).to_contain_text("flow.cn")
    expect(box).to_have_attribute("aria-invalid", "true")
    for key, value in {"flow.cn": "1.2", "flow.ct": "0.01"}.items():
        page.locator(f'[data-box="{key}"]').fill(value)
        page.locator(f'[data-box="{key}"]').press("Enter")
    settle(page)
    assert box.get_attribute("aria-invalid") is None
    agree(page, solved("paper", *overrides(page)))


def test_drag_coefficients_of_the_file_were_not_shown(watched: Watched) -> None:
    page = watched.open("#arm=silicone&flow.speed=0.1&flow.direction=90")
    page.locator('select[data-key="flow.law"]').select_option("quadratic-drag")
    expect(page.locator('[data-box="flow.cn"]')).to_have_value("2.5")
    expect(page.locator('[data-box="flow.ct"]')).to_have_value("0.005")
    settle(page)
    agree(page, solved("silicone", *overrides(page)))


def test_an_arm_that_passes_through_itself_is_called_that(watched: Watched, tmp_path: Path) -> None:
    page = watched.open()
    file = tmp_path / "coil.toml"
    file.write_text(
        "[arm]\nlength = 0.3\nradius = 0.006\n[material]\nyoung = 110e3\npoisson = 0.5\n[[cable]]\nname = 'left'\noffset = 0.005\n"
        "tension = 0.1\nmax_tension = 10\n"
    )
    page.locator("#file").set_input_files(file)
    expect(page.locator("#verdict")).to_contain_text("In equilibrium")
    expect(page.locator("#verdict")).not_to_contain_text("passes through itself")
    box = page.locator('[data-box="cable[0].tension"]')
    for tension in ("1.5", "2", "2.5", "3", "3.5"):
        box.fill(tension)
        box.press("Enter")
        settle(page)
        if "passes through itself" in page.locator("#verdict").inner_text():
            break
    expect(page.locator("#verdict-title")).to_contain_text("but the arm passes through itself")
    turned = float(re.split("\u00b0", numbers(page)["Tip turned by"])[0])
    assert abs(turned) > 270, "an arm that has not gone round does not meet itself"


def test_readings_explain_themselves(page: Page) -> None:
    label = page.locator('label[for="control-model-volume"]')
    assert "How a section widens" in (label.get_attribute("title") or "")
    select = page.locator('select[data-key="model.volume"]')
    assert "planar: beta = 1/nu" in (select.get_attribute("aria-description") or "")
    select.select_option("circular")
    page.wait_for_timeout(300)
    assert "circular: beta = 1/sqrt(nu)" in (select.get_attribute("aria-description") or "")


def test_the_page_works_without_storage(viewer: Viewer, browser: Browser) -> None:
    context = browser.new_context()
    context.add_init_script("Object.defineProperty(window, 'localStorage', { get() { throw new DOMException('no', 'SecurityError'); } });")
    page = Watched(context.new_page(), viewer.url)
    page.open("#arm=silicone&cable[0].tension=0.4&cable[1].tension=0.2")
    page.page.locator("#theme").click()
    drag_tip(page.page, -8, 10)
    page.page.mouse.up()
    settle(page.page)
    agree(page.page, solved("silicone", *overrides(page.page)))
    context.close()
    assert page.complaints == []


def test_live_regions_said_four_things_a_second(watched: Watched) -> None:
    page = watched.open("#arm=silicone&cable[0].tension=0.4&cable[1].tension=0.2")
    settle(page)
    page.evaluate(
        """() => {
          window.said = [];
          for (const region of document.querySelectorAll('[aria-live]:not([aria-live=off]), [role=status], [role=alert], output')) {
            new MutationObserver(() => window.said.push(region.id)).observe(region, { childList: true, characterData: true, subtree: true });
          }
        }"""
    )
    drag_tip(page, 200, 60, steps=80)
    page.wait_for_timeout(1200)
    said_then = page.evaluate("window.said")
    assert len(said_then) <= 2, said_then
    page.mouse.up()
    settle(page)
    page.wait_for_timeout(900)
    # What it came to is said, all of it.
    for line in page.locator("#verdict strong, #verdict li").all_inner_texts():
        assert line in (page.locator("#said").text_content() or "")


def test_a_screen_reader_finds_its_way(watched: Watched) -> None:
    page = watched.open("#arm=paper&cable[0].tension=40")
    settle(page)
    tree = page.locator("body").aria_snapshot()
    for part in (
        'heading "Hydrostat" [level=1]', 'combobox "Arm"', 'region "Drawing"', 'img "The arm, drawn to scale"', 'region "Verdict"',
        'button "Tip of the arm: drag it, or move it with the arrow keys"', 'region "Numbers"', 'tab "Along the arm" [selected]',
        'complementary "Controls"', 'slider "left (N)"', 'button "Help"',
    ):
        assert part in tree, f"{part}\n{tree[:3000]}"
    assert re.search(r'img "\u03b1, centreline against section along the arm: from \S+ to \S+ \u00b0"', tree), tree[:3000]


def test_everything_is_reached_with_the_keyboard(watched: Watched) -> None:
    page = watched.open("#arm=silicone&cable[0].tension=0.4&cable[1].tension=0.2")
    settle(page)
    reached: list[str] = []
    for _ in range(80):
        page.keyboard.press("Tab")
        reached.append(page.evaluate("document.activeElement?.id || document.activeElement?.dataset?.key || document.activeElement?.tagName"))
    for wanted in ("arm", "open-file", "theme", "help", "zoom-in", "drawing", "tip", "tab-along", "control-cable-0--tension", "control-flow-speed"):
        assert wanted in reached, f"{wanted}: {reached}"
    before = shown(page)
    page.locator("#tip").focus()
    page.keyboard.press("ArrowDown")
    settle(page)
    assert shown(page)[1] == pytest.approx(before[1] - 2.45, abs=0.01)
    page.locator("#tab-along").focus()
    page.keyboard.press("ArrowRight")
    expect(page.locator("#path")).to_be_visible()


def test_a_phone_shows_picture_and_verdict_at_once(watched: Watched) -> None:
    watched.page.set_viewport_size({"width": 390, "height": 844})
    page = watched.open("#arm=silicone&cable[0].tension=1.2")
    picture_box, verdict = page.locator("#drawing").bounding_box(), page.locator("#verdict-title").bounding_box()
    assert picture_box is not None and verdict is not None
    assert picture_box["y"] + picture_box["height"] <= verdict["y"], "the verdict stands beside the picture, not on it"
    assert verdict["y"] + verdict["height"] <= 844
    # Targets are large enough for a finger.
    small = page.evaluate(
        """() => [...document.querySelectorAll('header button, header summary, .tools button, .tools summary')]
          .filter((one) => one.getBoundingClientRect().width > 0)
          .map((one) => [one.id || one.textContent, one.getBoundingClientRect().height]).filter(([, height]) => height < 28)"""
    )
    assert small == []
