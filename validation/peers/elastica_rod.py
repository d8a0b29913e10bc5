"""A plain cantilever in PyElastica: a uniform rod under a dead transverse end force, damped until it rests.

PyElastica clamps the first node and the director of the first element, which sits half an element further on: the
arm is too short by that, an error of first order. Here the rod is longer by half an element, so that the clamped
director is at the base, and the tip is measured from the middle of the first element. With that the error falls with
the square of the number of elements, and ten are enough for 0.1 % of the length.
"""

import math
import time

import elastica
import numpy as np
from elastica.timestepper.symplectic_steppers import PositionVerlet

LENGTH, RADIUS, YOUNG, POISSON, DENSITY = 0.2, 0.01, 110e3, 0.5, 1080.0
AREA, SECOND = math.pi * RADIUS**2, math.pi * RADIUS**4 / 4.0
# P L^2/EI = 1.
LOAD = YOUNG * SECOND / LENGTH**2
SPEED = math.sqrt(YOUNG / DENSITY)
# Of the lowest bending motion of a slender cantilever, 3.516 sqrt(EI/(rho A L^4)).
PERIOD = 2.0 * math.pi / 3.516 * math.sqrt(DENSITY * AREA * LENGTH**4 / (YOUNG * SECOND))


class System(elastica.BaseSystemCollection, elastica.Constraints, elastica.Forcing, elastica.Damping):
    """What the rod, its clamp, its load and its damping are put into."""


class Cantilever:
    """One rod of `elements`, with a step of `share` of what a wave takes along one, damped at `damping` a period."""

    def __init__(self, elements, share, damping):
        size = LENGTH / (elements - 0.5)
        self.step = share * size / SPEED
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
        self.system.add_forcing_to(self.rod).using(
            elastica.EndpointForces, np.zeros(3), np.array((0.0, LOAD, 0.0)), ramp_up_time=1e-12
        )
        self.system.dampen(self.rod).using(
            elastica.AnalyticalLinearDamper, uniform_damping_constant=damping / PERIOD, time_step=self.step
        )
        self.system.finalize()

    def shear_coefficient(self):
        """C2 of `docs/model.md` that the rod has."""
        return float(self.rod.shear_matrix[0, 0, 0]) / AREA

    def tip(self):
        place = self.rod.position_collection
        return place[:2, -1] - 0.5 * (place[:2, 0] + place[:2, 1])

    def relax(self, steps):
        """Microseconds of the processor for so many steps."""
        stepper, system, step = PositionVerlet(), self.system, np.float64(self.step)
        now = np.float64(0.0)
        start = time.process_time()
        for _ in range(steps):
            now = stepper.step(system, now, step)
        return 1e6 * (time.process_time() - start)

    def steps_to_rest(self, rest, error):
        """After how many steps the tip stays within `error` of the length of `rest`; none if not in two periods."""
        stepper, now, settled = PositionVerlet(), np.float64(0.0), None
        for count in range(int(2.0 * PERIOD / self.step)):
            now = stepper.step(self.system, now, np.float64(self.step))
            away = np.linalg.norm(self.tip() - rest) / LENGTH
            if not away <= error:
                settled = None
            elif settled is None:
                settled = count + 1
        return settled


def arm_file(shear):
    """The same cantilever as an arm of Hydrostat: a classical rod, without water's drag or weight."""
    return f"""name = "cantilever"

[arm]
length = {LENGTH}
radius = {RADIUS}
density = {DENSITY}

[material]
c1 = {YOUNG}
c2 = {shear}
c3 = {YOUNG * RADIUS**2 / 4.0}

[tip]
force = [0.0, {LOAD}]

[model]
volume = "none"
"""
