"""What several tests use."""

from __future__ import annotations

import os
import subprocess
from collections.abc import Callable
from pathlib import Path

import matplotlib
import pytest
from hypothesis import settings

import hydrostat as hs

matplotlib.use("Agg")

# The same examples in every run: what fails once fails again.
settings.register_profile("same", derandomize=True)
settings.load_profile("same")

ROOT = Path(__file__).resolve().parents[2]

CHECKOUT = (ROOT / "crates/python").is_dir()
#: What reads documents and examples; the tests of a wheel run without them.
needs_checkout = pytest.mark.checkout

#: Runs the program with arguments: exit status and standard output.
Program = Callable[..., tuple[int, str]]


def pytest_configure(config: pytest.Config) -> None:
    config.addinivalue_line("markers", "checkout: reads the documents and examples of a checkout")


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    if not CHECKOUT:
        for item in items:
            if item.get_closest_marker("checkout"):
                item.add_marker(pytest.mark.skip(reason="needs the documents and examples of a checkout"))


@pytest.fixture(scope="session")
def program() -> Program:
    """The program `hydrostat` that was built beside the package; `HYDROSTAT_PROGRAM` says where it is."""
    path = os.environ.get("HYDROSTAT_PROGRAM")
    if not path:
        if not CHECKOUT:
            pytest.skip("needs the program `hydrostat`: its path in HYDROSTAT_PROGRAM")
        pytest.fail("HYDROSTAT_PROGRAM: expected the path of the program `hydrostat`, found nothing; `./test` sets it")

    def run(*arguments: str) -> tuple[int, str]:
        done = subprocess.run([path, *arguments], capture_output=True, text=True, check=False, timeout=120)
        return done.returncode, done.stdout

    return run


@pytest.fixture(scope="session")
def silicone() -> hs.Arm:
    return hs.Arm.load("silicone")


@pytest.fixture(scope="session")
def facing(silicone: hs.Arm) -> hs.Arm:
    """An arm that the stream meets from its tip: five equilibria."""
    return silicone.replace(flow_speed=0.2, flow_direction=180)
