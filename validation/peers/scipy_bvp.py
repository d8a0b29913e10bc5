"""Which mesh and tolerance serve `solve_bvp` best on `paper`, found by someone who knows the answer."""

import time
from dataclasses import dataclass
from itertools import product

import numpy as np
from scipy_arm import Arm

# The section law is solved to this, from the strains that the last Newton round leads to.
SECTION = 1e-4


@dataclass
class Best:
    """One way of solving: a mesh of so many nodes, closer to the tip by a power, and a tolerance."""

    arm: Arm
    nodes: int
    power: float
    tol: float
    # For warm starts, at 1 % less tension: nodes, states, mesh and strains.
    before: tuple | None

    def __str__(self):
        return f"{self.nodes} nodes, power {self.power}, tol {self.tol:g}"

    def solve(self):
        """Microseconds of the processor, and the tip over L; no tip where it failed."""
        arm = self.arm
        if self.before is None:
            nodes = graded(self.nodes, self.power)
            start = time.process_time()
            found = arm.cold(nodes, self.tol)
        else:
            nodes, state, mesh, kept = self.before
            arm.go_back(mesh, kept)
            start = time.process_time()
            found = arm.solve(nodes, state, self.tol)
        tip = arm.tip()
        took = 1e6 * (time.process_time() - start)
        return took, tip if found.success else None


def graded(nodes, power):
    mesh = 1.0 - (1.0 - np.linspace(0.0, 1.0, nodes)) ** power
    mesh[-1] = 1.0
    return mesh


def candidate(tension, speed, nodes, power, tol, warm):
    if not warm:
        return Best(Arm(tension, speed, SECTION), nodes, power, tol, None)
    arm = Arm(0.99 * tension, speed, SECTION)
    found = arm.cold(graded(nodes, power), 1e-5)
    before = (found.x, found.y, *arm.kept())
    arm.pull(tension)
    return Best(arm, nodes, power, tol, before)


def fastest(candidates, exact, error, repeats):
    """The fastest of some choices that is within `error` of the exact tip (over L) each time."""
    best, least = None, np.inf
    for one in candidates:
        times = []
        for _ in range(repeats):
            took, tip = one.solve()
            if tip is None or np.linalg.norm(tip - exact) > error:
                break
            times.append(took)
        if len(times) == repeats and min(times) < least:
            best, least = one, min(times)
    if best is None:
        raise SystemExit("solve_bvp reached the error with none of the choices")
    return best


def tuned(tension, speed, exact, error, warm):
    """The fastest of a grid of choices that is within `error` of the exact tip (over L)."""
    grid = product((60, 70, 80), (1.6, 1.8, 2.0), (1e-3, 1e-4, 3e-5, 1e-5))
    return fastest((candidate(tension, speed, *choice, warm) for choice in grid), exact, error, 3)
