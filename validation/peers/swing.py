"""A cantilever that swings, by Hydrostat and PyElastica in turn in one run; see README.md in this folder.

    python3 validation/peers/swing.py VENV [--batches N] [--profile release] [--json FILE]

VENV is a directory for a virtual environment: it is made where it is missing, and filled from PyPI.
"""

import argparse
import json
import resource
import subprocess
import tempfile
from pathlib import Path

from compare import beside, built, enter_venv, quartiles, row, show

# What trajectories may be off by, over the length, and the ratio of run times that is asked for.
WANTED, GOAL = 1e-3, 500.0
# Elements and parts of a wave's step that PyElastica may choose from, the cheapest first.
CHOICES = [(32, 1.35), (36, 1.3), (38, 1.3), (40, 1.3), (44, 1.2), (48, 1.2)]
# Tolerances and elements that Hydrostat may choose from, the cheapest first.
OWN = [(tol, elements) for tol in (1e-2, 7e-3, 5e-3, 4e-3, 3e-3, 2e-3, 1e-3) for elements in (2, 4)]
# Runs of ours in a process; what a process with half as many takes is taken off.
REPEATS = 60


def main():
    """Chooses, times and prints."""
    parser = argparse.ArgumentParser(description="A swing by Hydrostat and PyElastica")
    parser.add_argument("venv", help="virtual environment, made where it is missing")
    parser.add_argument("--batches", type=int, default=5, help="batches of each kind, in turn")
    parser.add_argument("--profile", default="release", help="Cargo profile of the timed program")
    parser.add_argument("--json", help="where to write the figures, too")
    options = parser.parse_args()
    enter_venv(options.venv)
    rows = swing(built(options.profile, "moving"), options.batches)
    if options.json:
        Path(options.json).write_text(json.dumps({"swing": rows}, indent=1) + "\n")


def swing(program, batches):
    """Both programs at the cheapest choice whose trajectory is right to what is wanted."""
    import elastica_swing as peer

    count = round(peer.UNTIL / peer.EVERY)
    with tempfile.TemporaryDirectory() as folder:
        arm, loads = Path(folder) / "swing.toml", Path(folder) / "loads.csv"
        arm.write_text(peer.arm_file(peer.Swing(20, 0.5).shear_coefficient()))
        loads.write_text(peer.loads())

        def ours(tol, elements, repeats):
            words = [program, arm, loads, tol, elements, peer.UNTIL, peer.EVERY, repeats]
            done = subprocess.run([str(word) for word in words], check=True, stdout=subprocess.PIPE, text=True)
            return json.loads(done.stdout)

        exact = ours(1e-8, 16, 1)["tips"]
        peer.Swing(20, 0.5).run(1)
        how = next((own for own in CHOICES if off(peer.Swing(*own).run(count)[1], exact, peer.LENGTH) <= WANTED), None)
        own = next((own for own in OWN if off(ours(*own, 1)["tips"], exact, peer.LENGTH) <= WANTED), None)
        if how is None or own is None:
            raise SystemExit(f"no choice is right to {WANTED:g} L: PyElastica {how}, ours {own}")
        theirs, mine = [], []
        for _ in range(batches):
            few, many = (processor_time(lambda runs=runs: ours(*own, runs)) for runs in (REPEATS // 2, REPEATS))
            mine.append(1e6 * (many - few) / (REPEATS - REPEATS // 2))
            theirs.append(peer.Swing(*how).run(count))
        done = ours(*own, 1)
    steps = peer.Swing(*how).per_row * count
    print(f"PyElastica: {how[0]} elements, step {how[1]} of a wave's, {steps} steps")
    print(f"ours: tol {own[0]:g}, {own[1]} elements, {done['steps']} steps, {done['rejected']} rejected, {done['rounds']} rounds")
    worst = max(off(tips, exact, peer.LENGTH) for _, tips in theirs)
    them = row("PyElastica", quartiles([took for took, _ in theirs]), worst)
    us = beside(row("ours", quartiles(mine), off(done["tips"], exact, peer.LENGTH)), them, GOAL)
    show(f"swing of two periods, to {WANTED:g} L", [them, us])
    return [them, us]


def processor_time(run):
    """Seconds of the processor that a process takes which `run` starts."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    run()
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def off(tips, exact, length):
    """The largest distance of two trajectories over the length."""
    pairs = zip(tips, exact, strict=True)
    return max(float(((a[0] - b[0]) ** 2 + (a[1] - b[1]) ** 2) ** 0.5) for a, b in pairs) / length


if __name__ == "__main__":
    main()
