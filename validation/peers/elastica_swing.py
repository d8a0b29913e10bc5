"""A cantilever in a vacuum in PyElastica: a dead force pushes its tip to the side for a while, then it swings freely.

The clamp is corrected as in `elastica_rod.py`: the rod is longer by half an element, so that the clamped director is at the base.
"""

import math
import time

import elastica
import numpy as np
from elastica.timestepper.symplectic_steppers import PositionVerlet

LENGTH, RADIUS, POISSON, DENSITY = 1.0, 1e-2, 0.5, 1000.0
PERIOD = 4.25
ROOT = 1.875104068711961
# omega_1 = ROOT^2 sqrt(E R^2/(4 rho))/L^2.
YOUNG = (2.0 * math.pi / PERIOD / ROOT**2) ** 2 * 4.0 * DENSITY / RADIUS**2 * LENGTH**4
AREA, SECOND = math.pi * RADIUS**2, math.pi * RADIUS**4 / 4.0
SPEED = math.sqrt(YOUNG / DENSITY)
# The force rises and falls along straight lines; its largest value bends the tip by about half the length.
PUSH = 1.6 * YOUNG * SECOND / LENGTH**2
TIMES, FORCES = (0.0, 1.0, 2.0), (0.0, PUSH, 0.0)
UNTIL, EVERY = 2.0 * PERIOD, PERIOD / 10.0


class Pushed(elastica.NoForces):
    """The force on the tip."""

    def apply_forces(self, system, time=np.float64(0.0)):
        """Adds it at `time`."""
        system.external_forces[1, -1] += np.interp(time, TIMES, FORCES)


class System(elastica.BaseSystemCollection, elastica.Constraints, elastica.Forcing):
    """What the rod, its clamp and its load are put into."""


class Swing:
    """The rod of `elements`, with a step of `share` of what a wave takes along one or, where that is less, along a radius."""

    def __init__(self, elements, share):
        size = LENGTH / (elements - 0.5)
        # Rows are at whole steps.
        self.per_row = math.ceil(EVERY / (share * min(size, RADIUS) / SPEED))
        self.step = EVERY / self.per_row
        self.rod = elastica.CosseratRod.straight_rod(
            elements,
            np.array((-0.5 * size, 0.0, 0.0)),
            np.array((1.0, 0.0, 0.0)),
            np.array((0.0, 0.0, 1.0)),
            LENGTH + 0.5 * size,
            RADIUS,
            DENSITY,
            youngs_modulus=YOUNG,
            shear_modulus=YOUNG / (2.0 * (1.0 + POISSON)),
        )
        self.system = System()
        self.system.append(self.rod)
        self.system.constrain(self.rod).using(
            elastica.OneEndFixedBC, constrained_position_idx=(0,), constrained_director_idx=(0,)
        )
        self.system.add_forcing_to(self.rod).using(Pushed)
        self.system.finalize()

    def shear_coefficient(self):
        """C2 of `docs/model.md` that the rod has."""
        return float(self.rod.shear_matrix[0, 0, 0]) / AREA

    def tip(self):
        """Place of the tip, from the middle of the first element."""
        place = self.rod.position_collection
        return place[:2, -1] - 0.5 * (place[:2, 0] + place[:2, 1])

    def run(self, rows):
        """Microseconds of the processor for so many rows, and the tip at each."""
        stepper, system, step = PositionVerlet(), self.system, np.float64(self.step)
        now, tips = np.float64(0.0), [self.tip()]
        start = time.process_time()
        for _ in range(rows):
            for _ in range(self.per_row):
                now = stepper.step(system, now, step)
            tips.append(self.tip())
        return 1e6 * (time.process_time() - start), np.array(tips)


def loads():
    """The force over time as `hydrostat simulate --input` reads it."""
    rows = (f"{t!r},{force!r}" for t, force in zip(TIMES, FORCES))
    return "t_s,tip.force[1]\n" + "\n".join(rows) + "\n"


def arm_file(shear):
    """The same rod as an arm of Hydrostat: a classical rod in a vacuum."""
    return f"""name = "swing"

[arm]
length = {LENGTH!r}
radius = {RADIUS!r}
density = {DENSITY!r}

[material]
c1 = {YOUNG!r}
c2 = {shear!r}
c3 = {YOUNG * RADIUS**2 / 4.0!r}

[flow]
density = 0.0

[model]
volume = "none"
"""
