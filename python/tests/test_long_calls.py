"""Calls by the hundred thousand leave no memory behind, and long ones hear Ctrl-C."""

from __future__ import annotations

import os
import subprocess
import sys
import textwrap
from pathlib import Path

import pytest

import hydrostat as hs

CALLS = 100_000
#: What the allocator may keep for itself, bytes: less than one float a call.
SLACK = 6 << 20


def resident() -> int:
    pages = int(Path("/proc/self/statm").read_text(encoding="ascii").split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE")


@pytest.mark.skipif(not Path("/proc/self/statm").exists(), reason="memory is read from /proc")
def test_memory_stays_flat() -> None:
    arm = hs.Arm(
        arm={"length": 0.2, "radius": 0.01},
        material={"young": 1e5},
        model={"volume": "none"},
        cable=[{"offset": 0.004}],
    )

    def call(index: int) -> None:
        # The section is crushed at C1 A = 31.4 N.
        pull = 40.0 if index % 50 == 0 else 1e-3 * (index % 7)
        try:
            solution = arm.solve(tensions=[pull], tol=1e-2)
        except hs.NoEquilibrium as no:
            assert no.last_good is not None and no.last_good.x[0] == 0.0
        else:
            assert solution.x[0] == 0.0 and solution.tip.x > 0.0

    for index in range(CALLS // 10):
        call(index)
    before = resident()
    for index in range(CALLS):
        call(index)
    assert resident() - before < SLACK


LONG = {
    "solve_many": "hs.solve_many(arm, flow_speed=np.linspace(0, 0.5, 3_000_000))",
    # Rows that each take as long as a verdict.
    "solve_many of failing rows": "hs.solve_many(arm, tensions=np.linspace([1.2, 0], [1.5, 0], 1_000_000))",
    "stations": "[arm.solve().resampled(10**6) for _ in range(10**6)]",
    "path": "arm.path('flow.speed', 0, 0.5, longest=0.001, tol=1e-7, most=10**9)",
    "equilibria": "[arm.replace(flow_speed=0.2, flow_direction=180).equilibria() for _ in range(10**6)]",
    "reach": "[arm.reach((0.182, 0.07 + 1e-9 * k)) for k in range(10**6)]",
    "reachable": "[arm.reachable(max_tension=1.5, spacing=0.001) for _ in range(10**6)]",
    # Every load case would be left out once.
    "identify": "arm.identify({'case': range(200), 'cable[0].tension [N]': np.linspace(0.01, 0.5, 200), "
    "'x [m]': np.linspace(0.101, 0.15, 200), 'y [m]': np.linspace(0.001, 0.05, 200)}, "
    "'young,arm.density,poisson', sd='0.01 mm', progress=True)",
    "sweep": "hs.sweep(arm, {'flow.speed': '0:0.5:10000', 'cable[0].tension': '0:0.8:1000'})",
    "sweep into a file": "hs.sweep(arm, {'flow.speed': '0:0.5:100000', 'cable[0].tension': '0:0.8:1000'}, output='x.parquet')",
}


@pytest.mark.skipif(sys.platform == "win32", reason="signals are sent")
@pytest.mark.parametrize("call", LONG.values(), ids=LONG.keys())
def test_interrupts(tmp_path: Path, call: str) -> None:
    script = f"""
        import os, signal, sys, threading, time
        import numpy as np
        import hydrostat as hs
        arm = hs.Arm.load("silicone")
        def interrupt():
            global sent
            sent = time.monotonic()
            os.kill(os.getpid(), signal.SIGINT)
        threading.Timer(0.7, interrupt).start()
        try:
            {call}
        except KeyboardInterrupt:
            print("interrupted")
        print(f"\\n{{time.monotonic() - sent}}", file=sys.stderr)
    """
    # Each would take from minutes to days.
    done = subprocess.run(
        [sys.executable, "-c", textwrap.dedent(script)],
        capture_output=True,
        text=True,
        check=False,
        timeout=60,
        cwd=tmp_path,
    )
    assert (done.stdout.strip(), done.returncode) == ("interrupted", 0), done.stderr
    # About a second on a machine that does nothing else.
    assert float(done.stderr.splitlines()[-1]) < 5.0, done.stderr
