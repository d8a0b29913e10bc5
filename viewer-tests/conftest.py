"""A viewer on a free port, and a real browser that sees nothing but it."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import urllib.request
from collections.abc import Iterator
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

import pytest
from playwright.sync_api import Browser, ConsoleMessage, Page, Request, sync_playwright

PROGRAM = os.environ.get("HYDROSTAT_PROGRAM", "")
CHROMIUM = shutil.which("chromium")
FLAGS = [
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
]


class Viewer:
    """The program, serving."""

    def __init__(self, *arguments: str, port: str = "0") -> None:
        assert PROGRAM, "HYDROSTAT_PROGRAM names the program to test"
        command = [PROGRAM, "serve", "--port", port, *(arguments or ["paper"])]
        self.process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        assert self.process.stdout is not None
        self.url = self.process.stdout.readline().strip()

    def get(self, path: str) -> Any:
        with urllib.request.urlopen(f"{self.url}api/{path}", timeout=60) as response:
            return json.load(response)

    def post(self, path: str, body: dict[str, Any]) -> Any:
        headers = {"Content-Type": "application/json"}
        request = urllib.request.Request(f"{self.url}api/{path}", json.dumps(body).encode(), headers)
        with urllib.request.urlopen(request, timeout=60) as response:
            return json.load(response)

    def close(self) -> None:
        self.process.terminate()
        self.process.wait(timeout=20)


def solved(*arguments: str) -> Any:
    """What `hydrostat solve` says."""
    command = [PROGRAM, "solve", *arguments, "--format", "json"]
    run = subprocess.run(command, capture_output=True, text=True, timeout=60)
    return json.loads(run.stdout)


@pytest.fixture(scope="session")
def viewer() -> Iterator[Viewer]:
    server = Viewer()
    yield server
    server.close()


@pytest.fixture(scope="session")
def browser() -> Iterator[Browser]:
    if CHROMIUM is None:
        pytest.skip("there is no chromium (on Debian: apt install chromium)")
    with sync_playwright() as playwright:
        started = playwright.chromium.launch(executable_path=CHROMIUM, args=FLAGS)
        yield started
        started.close()


class Watched:
    """A page of which every complaint and every request is known."""

    def __init__(self, page: Page, url: str) -> None:
        self.page = page
        self.url = url
        self.complaints: list[str] = []
        self.foreign: list[str] = []
        page.on("console", self._hear)
        page.on("pageerror", lambda error: self.complaints.append(str(error)))
        page.on("request", self._see)

    def _hear(self, message: ConsoleMessage) -> None:
        if message.type in ("error", "warning"):
            self.complaints.append(message.text)

    def _see(self, request: Request) -> None:
        parts = urlsplit(request.url)
        if parts.scheme not in ("data", "blob") and parts.netloc != urlsplit(self.url).netloc:
            self.foreign.append(request.url)

    def open(self, fragment: str = "") -> Page:
        # A fragment alone would not load the page anew.
        self.page.goto("about:blank")
        self.page.goto(self.url + fragment)
        self.page.wait_for_selector("#verdict[data-level]")
        return self.page


@pytest.fixture
def watched(viewer: Viewer, browser: Browser) -> Iterator[Watched]:
    context = browser.new_context(viewport={"width": 1360, "height": 900}, accept_downloads=True)
    context.grant_permissions(["clipboard-read", "clipboard-write"], origin=viewer.url.rstrip("/"))
    page = Watched(context.new_page(), viewer.url)
    yield page
    context.close()
    assert page.complaints == [], "the browser's console is quiet"
    assert page.foreign == [], "no request leaves the machine"


@pytest.fixture
def page(watched: Watched) -> Page:
    """The page as it opens."""
    return watched.open()


def arm_file(directory: Path, young: float = 90e3) -> Path:
    """An arm file of one's own."""
    file = directory / "mine.toml"
    file.write_text(
        "# my arm\n[arm]\nlength = 0.3\nradius = { base = 0.012, tip = 0.003 }\n"
        f"[material]\nyoung = {young}\n[[cable]]\nname = 'only'\noffset = {{ base = 0.006, tip = 0.001 }}\ntension = 0.2\n"
        "max_tension = 1\n[flow]\nspeed = 0.05\ndirection = 90\n",
    )
    return file
