"""Where SciPy's `solve_bvp` and PyElastica have the tips of arms, for `hydrostat validate`; see README.md in this folder.

    python3 validation/peers/tips.py VENV [-o crates/validate/data/tips.json]

VENV is a directory for a virtual environment: it is made where it is missing, and filled from PyPI.
"""

import argparse
import datetime
import json
import platform
from importlib.metadata import version
from pathlib import Path

from compare import PACKAGES, ROOT, enter_venv

# Tension (N) and speed (m/s).
LOADS = ((10.0, 0.0), (10.0, 0.5), (20.0, 1.0), (40.0, 0.0), (40.0, 0.5), (40.0, 1.0), (60.0, 0.5))
NODES = (280, 560)
ELEMENTS = (10, 20, 40, 80)
# Periods of the lowest bending motion that the cantilever is damped for, and what it may move by in the last one, over L.
PERIODS, REST = 6, 1e-8


def main():
    parser = argparse.ArgumentParser(description="Tips by solve_bvp and PyElastica")
    parser.add_argument("venv", help="virtual environment, made where it is missing")
    parser.add_argument("-o", "--output", default=str(ROOT / "crates/validate/data/tips.json"), help="where to write them")
    options = parser.parse_args()
    enter_venv(options.venv)
    provenance = {
        "made_by": "validation/peers/tips.py",
        "date": datetime.date.today().isoformat(),
        "python": platform.python_version(),
        "packages": {name: version(name) for name in PACKAGES},
    }
    tips = [*scipy_tips(), *elastica_tips()]
    Path(options.output).write_text(json.dumps({"provenance": provenance, "tips": tips}, indent=1) + "\n")


def distance(a, b):
    return float(((a[0] - b[0]) ** 2 + (a[1] - b[1]) ** 2) ** 0.5)


def entry(program, arm, settings, how, tip, uncertainty):
    """A tip over L; `uncertainty` is what it moved by from the next coarser mesh, over L."""
    print(f"{program}, {arm['name']}, {settings}: {how}, tip {tip[0]:.12f} {tip[1]:.12f}, moved by {uncertainty:.1e}", flush=True)
    tip = [float(c) for c in tip]
    return {"program": program, "arm": arm, "settings": settings, "how": how, "tip": tip, "uncertainty": uncertainty}


def scipy_tips():
    from scipy_arm import Arm
    from scipy_bvp import graded

    for tension, speed in LOADS:
        tips = []
        for nodes in NODES:
            # The mesh is nearly fine enough for the tolerance: few nodes are added.
            arm = Arm(tension, speed, 1e-6)
            found = arm.cold(graded(nodes, 1.8), 1e-7)
            if not found.success:
                raise SystemExit(f"solve_bvp at {tension} N, {speed} m/s: {found.message}")
            tips.append(arm.tip())
        settings = {"cable[0].tension": tension, "flow.speed": speed}
        yield entry("SciPy solve_bvp", {"name": "paper"}, settings, f"{len(found.x)} nodes", tips[1], distance(*tips))


def elastica_tips():
    import elastica_rod as peer

    before = None
    for elements in ELEMENTS:
        rod = peer.Cantilever(elements, 0.6, 10.0)
        steps = int(peer.PERIOD / rod.step)
        moved, last = float("inf"), rod.tip() / peer.LENGTH
        for period in range(PERIODS * 4):
            rod.relax(steps)
            tip = rod.tip() / peer.LENGTH
            moved, last = distance(tip, last), tip
            if period + 1 >= PERIODS and moved < REST:
                break
        if moved >= REST:
            raise SystemExit(f"PyElastica with {elements} elements still moves by {moved:.1e} a period")
        arm = {"name": "cantilever", "toml": peer.arm_file(rod.shear_coefficient())}
        if before is not None:
            yield entry("PyElastica", arm, {}, f"{elements} elements", last, distance(last, before))
        before = last


if __name__ == "__main__":
    main()
