"""Hydrostat beside SciPy's `solve_bvp` and PyElastica, interleaved in one run; see README.md in this folder.

    python3 validation/peers/compare.py VENV [--batches N] [--profile release] [--json FILE]

VENV is a directory for a virtual environment: it is made where it is missing, and filled from PyPI.
"""

import argparse
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
PACKAGES = ("numpy", "scipy", "pyelastica")
INSIDE = "HYDROSTAT_PEERS_INSIDE"

TENSION, SPEED = 40.0, 0.5
FINE, PLAIN = 1e-8, 1e-3
GOALS = {"cold": 500.0, "warm": 900.0, "rod": 2000.0, "space": 50.0, "plane": 6.0}
# The arm in space: tensions in N, speed of the stream in m/s.
PULLS, STREAM = (0.1, 0.05, 0.0), 0.1
# Solves of each kind in a batch.
OURS, SCIPY = 100, 5


def main():
    options = arguments()
    enter_venv(options.venv)
    program = built(options.profile)
    report = {
        "paper": paper(program, options.batches),
        "cantilever": cantilever(program, options.batches),
        "space": space(program, options.batches),
        "plane": space_and_plane(program, options.batches),
    }
    if options.json:
        Path(options.json).write_text(json.dumps(report, indent=1) + "\n")


def arguments():
    parser = argparse.ArgumentParser(description="Hydrostat beside solve_bvp and PyElastica")
    parser.add_argument("venv", help="virtual environment, made where it is missing")
    parser.add_argument("--batches", type=int, default=12, help="batches of each kind, in turn")
    parser.add_argument("--profile", default="release", help="Cargo profile of the timed program")
    parser.add_argument("--json", help="where to write the figures, too")
    return parser.parse_args()


def enter_venv(directory):
    """Goes on with the Python of the virtual environment, on one thread."""
    if os.environ.get(INSIDE) == "1":
        return
    venv = Path(directory)
    python = venv / "bin" / "python"
    if not python.exists():
        subprocess.run([sys.executable, "-m", "venv", str(venv)], check=True)
    if subprocess.run([python, "-c", "import numpy, scipy, elastica"], capture_output=True).returncode != 0:
        subprocess.run([python, "-m", "pip", "install", "--quiet", *PACKAGES], check=True)
    one = {name: "1" for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "NUMBA_NUM_THREADS", INSIDE)}
    os.execve(python, [str(python), *sys.argv], {**os.environ, **one})


def built(profile, example="timing"):
    """The timing program, built."""
    build = ["cargo", "build", "--profile", profile, "-p", "hydrostat", "--example", example, "--message-format=json"]
    lines = subprocess.run(build, cwd=ROOT, check=True, stdout=subprocess.PIPE, text=True).stdout.splitlines()
    found = [json.loads(line).get("executable") for line in lines]
    return next(path for path in found if path)


def ours(program, arm, tensions, speed, tol, repeats):
    words = [program, arm, tensions, str(speed), str(tol), str(repeats)]
    return json.loads(subprocess.run(words, check=True, stdout=subprocess.PIPE, text=True).stdout)


def tip_of(report, key="tip"):
    return [report[key][axis] / report["length"] for axis in ("x", "y", "z") if axis in report[key]]


def error(tip, exact):
    return float(sum((a - b) ** 2 for a, b in zip(tip, exact)) ** 0.5)


def paper(program, batches):
    """`paper`: cold and warm."""
    import scipy_bvp

    exact = tip_of(ours(program, "paper", f"{TENSION},0", SPEED, 1e-12, 1))
    cold = scipy_bvp.tuned(TENSION, SPEED, exact, FINE, warm=False)
    warm = scipy_bvp.tuned(TENSION, SPEED, exact, FINE, warm=True)
    for name, best in (("cold", cold), ("warm", warm)):
        print(f"solve_bvp {name}: {best}, error {error(best.solve()[1], exact):.1e} L", flush=True)
    theirs = {"cold": [], "warm": []}
    mine = []
    for _ in range(batches):
        mine.append(ours(program, "paper", f"{TENSION},0", SPEED, FINE, OURS))
        for name, best in (("cold", cold), ("warm", warm)):
            theirs[name] += [best.solve() for _ in range(SCIPY)]
    rows = []
    for name in ("cold", "warm"):
        times = [took for took, _ in theirs[name]]
        rows.append(row(f"solve_bvp {name}", quartiles(times), max(error(tip, exact) for _, tip in theirs[name])))
        key = "tip" if name == "cold" else "warm_tip"
        own = row(f"ours {name}", pooled(mine, name), error(tip_of(mine[0], key), exact))
        rows.append(beside(own, rows[-1], GOALS[name]))
        if name == "warm":
            alone = row("ours warm, the tip alone", pooled(mine, "update"), error(tip_of(mine[0], "update_tip"), exact))
            rows.append(beside(alone, rows[-2], GOALS[name]))
    show(f"paper, T1 = {TENSION:g} N, {SPEED:g} m/s, to {FINE:g} L", rows)
    return rows


def space(program, batches):
    """Three cables and a stream in space: cold and warm."""
    import scipy_space as peer

    tensions = ",".join(map(str, PULLS))
    with tempfile.TemporaryDirectory() as folder:
        arm = str(Path(folder) / "space.toml")
        Path(arm).write_text(peer.arm_file())
        exact = tip_of(ours(program, arm, tensions, STREAM, 1e-12, 1))
        best = {name: peer.tuned(PULLS, STREAM, exact, FINE, warm=name == "warm") for name in ("cold", "warm")}
        theirs, mine = {"cold": [], "warm": []}, []
        for _ in range(batches):
            mine.append(ours(program, arm, tensions, STREAM, FINE, OURS))
            for name, one in best.items():
                theirs[name] += [one.solve() for _ in range(2)]
    rows = []
    for name, one in best.items():
        print(f"solve_bvp in space, {name}: {one}")
        times = [took for took, _ in theirs[name]]
        rows.append(row(f"solve_bvp {name}", quartiles(times), max(error(tip, exact) for _, tip in theirs[name])))
        key = "tip" if name == "cold" else "warm_tip"
        own = row(f"ours {name}", pooled(mine, name), error(tip_of(mine[0], key), exact))
        rows.append(beside(own, rows[-1], GOALS["space"]))
    show(f"in space, T = {tensions} N, {STREAM:g} m/s, to {FINE:g} L", rows)
    return rows


def space_and_plane(program, batches):
    """`silicone` by the solver of the plane and by that of space, and the arm with three cables; ratios are over the plane."""
    planar = (ROOT / "crates/files/arms/silicone.toml").read_text()
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        turned = str(Path(folder) / "silicone.toml")
        Path(turned).write_text(planar.replace("[arm]\n", '[arm]\nspace = "spatial"\n', 1))
        arms = [("in the plane", "silicone", "0.1,0"), ("the same in space", turned, "0.1,0")]
        arms.append(("three cables in space", "silicone-spatial", ",".join(map(str, PULLS))))
        times = {name: [] for name, _, _ in arms}
        for _ in range(batches):
            for name, arm, tensions in arms:
                times[name].append(ours(program, arm, tensions, STREAM, FINE, OURS))
    for kind in ("cold", "warm"):
        first = None
        for name, _, _ in arms:
            own = row(f"{kind}, {name}", pooled(times[name], kind), 0.0)
            first = first or own
            ratio = {"ratio": own["median"] / first["median"], "goal": GOALS["plane"]} if own is not first else {}
            rows.append({**own, **ratio})
    show(f"silicone in space and in the plane, {STREAM:g} m/s, to {FINE:g} L", rows)
    return rows


def cantilever(program, batches):
    """A plain cantilever under an end load."""
    import elastica_rod as peer

    shear = peer.Cantilever(10, 0.5, 10.0).shear_coefficient()
    with tempfile.TemporaryDirectory() as folder:
        arm = str(Path(folder) / "cantilever.toml")
        Path(arm).write_text(peer.arm_file(shear))
        exact = tip_of(ours(program, arm, "-", 0, 1e-12, 1))
        steps, how = settled(peer, exact)
        elements, share, damping = how
        print(f"PyElastica: {elements} elements, step {share} of a wave's, damping {damping} a period, {steps} steps")
        theirs, tips, mine = [], [], []
        for _ in range(batches):
            mine.append(ours(program, arm, "-", 0, PLAIN, OURS))
            for _ in range(2):
                rod = peer.Cantilever(*how)
                theirs.append(rod.relax(steps))
                tips.append(rod.tip() / peer.LENGTH)
    them = row("PyElastica", quartiles(theirs), max(error(tip, exact) for tip in tips))
    us = beside(row("ours cold", pooled(mine, "cold"), error(tip_of(mine[0]), exact)), them, GOALS["rod"])
    show(f"cantilever, P L^2/EI = 1, to {PLAIN:g} L", [them, us])
    return [them, us]


def settled(peer, exact):
    """The fewest steps that rest within the error, and how."""
    rest = [peer.LENGTH * c for c in exact]
    best = None
    for how in [(n, share, damping) for n in (10, 11) for share in (0.6, 0.65) for damping in (10.0, 11.0)]:
        steps = peer.Cantilever(*how).steps_to_rest(rest, PLAIN)
        if steps is not None and (best is None or steps < best[0]):
            best = (steps, how)
    if best is None:
        sys.exit("PyElastica did not settle with any of the choices")
    return best


def quartiles(times):
    ordered = sorted(times)
    return [ordered[(len(ordered) - 1) * quarter // 4] for quarter in (1, 2, 3)]


def pooled(reports, key):
    """Of every quartile the median over the batches."""
    names = ("lower_quartile", "median", "upper_quartile")
    return [quartiles([report[key][name] for report in reports])[1] for name in names]


def row(name, times, off):
    return {"name": name, "lower_quartile": times[0], "median": times[1], "upper_quartile": times[2], "error": off}


def beside(own, other, goal):
    return {**own, "ratio": other["median"] / own["median"], "goal": goal}


def show(title, rows):
    print(f"\n{title}\n{'':30}{'lower':>10}{'median us':>12}{'upper':>10}{'error/L':>10}{'ratio':>8}{'goal':>7}")
    for r in rows:
        line = f"{r['name']:30}{r['lower_quartile']:10.0f}{r['median']:12.0f}{r['upper_quartile']:10.0f}"
        print(line + f"{r['error']:10.1e}" + (f"{r['ratio']:8.1f}{r['goal']:7.0f}" if "ratio" in r else ""), flush=True)


if __name__ == "__main__":
    main()
