"""Shapes by a program that shares nothing with Hydrostat: Chebyshev collocation in NumPy and SciPy.

    python3 validation/reference/solve.py crates/validate/data/cases.json             distances to the answers in a file
    python3 validation/reference/solve.py crates/validate/data/weight.json --write    the answers in a file anew

The answer is the end of the path of docs/model.md, section 7: loads raised from nothing, then tensions. Kinks of the
load are ends of pieces, found with the shape; pieces are halved until their polynomials are resolved.
"""

import argparse
import json
import math
import multiprocessing
import pathlib

import numpy as np

from arm import Arm
from collocation import Grid, integral, interpolate, newton, tails
from equations import Signs, beta_of, loads

HERE = pathlib.Path(__file__).parent


class NoShape(Exception):
    pass


def start(arm, degree=8):
    """The unloaded arm on a mesh that is finer at both ends."""
    ends = np.linspace(0.0, 1.0, 17)
    fine = [2.0**-k for k in (5, 6, 7, 8)]
    ends = sorted({*ends, *fine, *(1.0 - f for f in fine)})
    grid = Grid(arm, merged(ends, arm.breaks()), degree)
    u = np.zeros((7, len(grid.s)))
    u[4:] = grid.places.reference
    u[0] = arm.base[2] + integral(grid, u[6])
    return grid, u


def merged(ends, fixed, near=2e-3):
    """`ends` with `fixed` among them; others that are near one of those go."""
    kept = [e for e in ends if e in (0.0, 1.0) or all(abs(e - f) > near for f in fixed)]
    return np.array(sorted({*kept, *fixed}))


def follow(grid, u):
    """Raises the loads, then the tensions."""
    for phase in range(2):
        share, step, before = 0.0, 0.25, None
        while share < 1.0:
            target = min(1.0, share + step)
            shares = (target, 0.0) if phase == 0 else (1.0, target)
            guess = u if before is None else u + (u - before[0]) * (target - share) / (share - before[1])
            guess = guess if (guess[4] > 0.05).all() else u
            found = newton(grid, guess, shares, tolerance=1e-6, rounds=12)
            # Past a limit point Newton's method may find another branch, which is a step of a size that does not shrink.
            if found is not None and np.abs(found[0] - u[0]).max() > 0.15:
                found = None
            if found is None:
                step *= 0.5
                if step < 1e-6:
                    raise NoShape(f"{('loads', 'tension')[phase]} at {share}")
                continue
            before, u, share = (u, share), found, target
            step *= 1.6
    return u


def kinks(grid, u):
    """Where what decides the branch of the load changes sign."""
    arm = grid.arm
    q = grid.along(beta_of(arm, u[4]))
    signs = Signs()
    loads(arm, grid.places, u[0], tuple(u[4:7]), q, signs)
    if not any(arm.stream):
        return [], signs.met
    out = []
    fine = np.linspace(0.0, 1.0, 4 * grid.degree + 1)
    relevant = [np.ones_like(grid.s)] * len(signs.met)
    if arm.lateral:
        left = 0.5 - 0.5 * np.sign(signs.met[0])
        relevant = [np.ones_like(left), left, left, 1.0 - left, 1.0 - left]
    speed = math.hypot(*arm.stream)
    for values, counts in zip(signs.met, relevant):
        if np.abs(values).max() < 1e-13 * speed:
            continue
        shaped = values.reshape(grid.pieces, -1)
        counted = counts.reshape(grid.pieces, -1)
        previous = None
        for piece in range(grid.pieces):
            if counted[piece].max() == 0.0:
                previous = None
                continue
            sampled = interpolate(grid.nodes, shaped[piece], fine)
            if previous is not None and previous * sampled[0] < 0.0:
                out.append(grid.ends[piece])
            for k in np.flatnonzero(sampled[:-1] * sampled[1:] < 0.0):
                low, high = fine[k], fine[k + 1]
                for _ in range(60):
                    middle = 0.5 * (low + high)
                    value = interpolate(grid.nodes, shaped[piece], np.array([middle]))[0]
                    if value * sampled[k] > 0.0:
                        low = middle
                    else:
                        high = middle
                out.append(grid.ends[piece] + grid.steps[piece] * 0.5 * (low + high))
            previous = sampled[-1]
    return [k for k in out if 1e-6 < k < 1.0 - 1e-6], signs.met


def pieces_signs(grid, met):
    """The sign of each quantity on each piece: that of its middle."""
    n = grid.degree + 1
    return [np.repeat(np.sign(values.reshape(grid.pieces, n)[:, n // 2]), n) for values in met]


def refine(grid, u, degree, sharpness):
    """Ends at the kinks, then pieces halved until they are resolved: mesh, shape, kinks and how far these last moved."""
    arm = grid.arm
    fixed = arm.breaks()
    ends, found = np.linspace(0.0, 1.0, 13), None
    # A kink that is off by h costs h^2, a jump h.
    still = 1e-11 if arm.lateral or arm.resultant else 1e-7
    for attempt in range(20):
        kink = [k for k in sorted(kinks(grid, u)[0]) if all(abs(k - f) > 1e-6 for f in fixed)]
        # Both sides of an end find it.
        kink = [k for i, k in enumerate(kink) if i == 0 or k - kink[i - 1] > 1e-5]
        mesh = [e for e in ends if e not in (found or [])]
        finer = Grid(arm, merged(mesh, [*fixed, *kink]), degree)
        guess = moved_to(finer, grid, u)
        signs = pieces_signs(finer, kinks(finer, guess)[1])
        solved = newton(finer, guess, (1.0, 1.0), signs, rounds=60)
        if solved is None:
            raise NoShape(f"refinement {attempt}")
        moved = 1.0 if found is None or len(found) != len(kink) else max([0.0, *np.abs(np.subtract(kink, found))])
        grid, u, found = finer, solved, kink
        rough = tails(grid, u) > sharpness
        if moved < still and not rough.any():
            break
        halved = [0.5 * (grid.ends[k] + grid.ends[k + 1]) for k in np.flatnonzero(rough) if grid.steps[k] > 4e-3]
        ends = np.array(sorted({*grid.ends, *halved}))
    return grid, u, found, moved if still < 1e-7 else moved**2


def moved_to(finer, grid, u):
    """Values on another mesh; at the start of a piece those to the right of it."""
    n = finer.degree + 1
    inside = finer.s.copy().reshape(finer.pieces, n)
    inside[:, 0] = finer.ends[:-1] + 1e-12
    return grid.at(u, inside.ravel())


def answer(arm, degree=16):
    """Mesh and shape, with what the tip moves by (over L) when the degree is four lower, or kinks are moved."""
    grid, u = start(arm)
    u = follow(grid, u)
    grid, u, found, moved = refine(grid, u, degree, 1e-12)
    other = Grid(arm, grid.ends, degree - 4)
    guess = moved_to(other, grid, u)
    coarse = newton(other, guess, (1.0, 1.0), pieces_signs(other, kinks(other, guess)[1]))
    if coarse is None:
        raise NoShape("no second shape to compare with")
    tips = [np.array([v[-1] for v in integrated(g, v)]) for g, v in ((grid, u), (other, coarse))]
    return grid, u, max(float(np.hypot(*(tips[0] - tips[1]))), moved if found else 0.0)


def integrated(grid, u):
    """x and y over L, from the base at the origin."""
    theta, nu, eta = u[0], u[4], u[5]
    return (
        integral(grid, np.cos(theta) * nu - np.sin(theta) * eta),
        integral(grid, np.sin(theta) * nu + np.cos(theta) * eta),
    )


def document(name, text, count=11):
    """An arm with its shape, as in the files of this directory."""
    arm = Arm(text)
    grid, u, accuracy = answer(arm)
    length = arm.length
    x, y = (v * length + o for v, o in zip(integrated(grid, u), arm.base))
    full = np.vstack((u, x, y, np.arctan2(u[5], u[4]), beta_of(arm, u[4])))
    at = grid.at(full, np.linspace(0.0, 1.0, count))
    _, unmet = grid.conditions(u, (1.0, 1.0))
    units = (arm.force, arm.force, arm.force * length)
    stations = {"s": np.linspace(0.0, length, count)} | {key: at[k] for key, k in KEYS.items()}
    stations["mu"] = stations["mu"] / length
    force = [float(-u[k, 0] * arm.force) for k in (1, 2)]
    return {
        "name": name,
        "toml": text,
        "accuracy": accuracy,
        "tip": {key: float(full[KEYS[key], -1]) for key in ("x", "y", "theta", "alpha")},
        "stations": {key: [float(v) for v in values] for key, values in stations.items()},
        "base": {"force": force, "moment": float(-u[3, 0] * units[2])},
        "unmet": [float(v * w) for v, w in zip(unmet, units)] if arm.unstrained else None,
    }


KEYS = {"x": 7, "y": 8, "theta": 0, "nu": 4, "eta": 5, "mu": 6, "beta": 10, "alpha": 9}


def solved(named):
    name, text = named
    try:
        return document(name, text)
    except NoShape as no:
        return f"{name}: {no}"


def distance(case, own):
    length = Arm(case["toml"]).length
    return math.hypot(own["tip"]["x"] - case["tip"]["x"], own["tip"]["y"] - case["tip"]["y"]) / length


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("file", type=pathlib.Path, help="arms, each with its name and its arm file")
    parser.add_argument("--write", action="store_true", help="replace the answers in the file")
    parser.add_argument("--only", default="", metavar="WORD", help="arms with WORD in their names or arm files")
    parser.add_argument("--jobs", type=int, default=2)
    args = parser.parse_args()
    cases = json.loads(args.file.read_text())
    chosen = [case for case in cases if args.only in case["name"] or args.only in case["toml"]]
    found = {}
    with multiprocessing.Pool(args.jobs) as pool:
        for case, own in zip(chosen, pool.imap(solved, [(case["name"], case["toml"]) for case in chosen])):
            if isinstance(own, str):
                print(own, flush=True)
                continue
            off = f"off {distance(case, own):.1e} L, " if "tip" in case else ""
            print(f"{own['name']}: {off}by its own account {own['accuracy']:.1e} L", flush=True)
            found[own["name"]] = own
    if args.write:
        done = [found.get(case["name"], case) for case in cases]
        args.file.write_text(json.dumps(done, separators=(",", ":")))


if __name__ == "__main__":
    main()
