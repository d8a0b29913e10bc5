"""The arm `silicone-spatial` with `volume = "none"` for SciPy's `solve_bvp`: the equations of docs/model.md, section 14,
as a vectorised right-hand side with its Jacobian.

The state is (q, n_f, m_f, r) over s in [0, 1], thirteen numbers: a quaternion, vectors in space, lengths over L and
forces over C3 A0 / L^2 at the base. The strains at a point follow from the section law by Newton, all points at once.
"""

import itertools
import math
import time
from dataclasses import dataclass

import numpy as np
from scipy.integrate import solve_bvp
from scipy_bvp import fastest

LENGTH = 0.245
RADIUS = (10e-3, 2e-3)
OFFSET = (5e-3, 1e-3)
ANGLES = np.radians((0.0, 120.0, 240.0))
YOUNG = 110e3
WATER = 1022.0
LAYER = 2.0 / 3.0
DIRECTION = np.array((0.3, 1.0, 0.4)) / math.sqrt(1.25)
# C1 to C3 at the base, and the force that everything is over.
C3 = YOUNG * RADIUS[0] ** 2 / 4.0
FORCE = C3 * math.pi * RADIUS[0] ** 2 / LENGTH**2


def arm_file():
    """The same arm for Hydrostat, without tensions and stream."""
    cables = "".join(
        f'[[cable]]\nname = "c{k}"\noffset = {{ base = {OFFSET[0]}, tip = {OFFSET[1]} }}\nangle = {120 * k}\ntension = 0\n'
        for k in range(3)
    )
    return f"""[arm]
space = "spatial"
length = {LENGTH}
radius = {{ base = {RADIUS[0]}, tip = {RADIUS[1]} }}
density = 1080
[material]
young = {YOUNG}
poisson = 0.5
{cables}[flow]
density = {WATER}
law = "momentum"
direction = [0.3, 1.0, 0.4]
[model]
volume = "none"
"""


def cross(a, b):
    return np.array((a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]))


def skew(v):
    """The matrices of v x, one a point."""
    zero = np.zeros_like(v[0])
    return np.array(((zero, -v[2], v[1]), (v[2], zero, -v[0]), (-v[1], v[0], zero)))


def apply(matrix, vector):
    return np.einsum("ijm,jm->im", matrix, vector)


def product(a, b):
    return np.einsum("ijm,jkm->ikm", a, b)


def transposed(matrix):
    return matrix.transpose(1, 0, 2)


def directors(q):
    """a, b, c as columns, of the quaternion over its norm, and the squares of the norm."""
    w, x, y, z = q
    square = w * w + x * x + y * y + z * z
    rows = (
        (w * w + x * x - y * y - z * z, 2 * (x * y - w * z), 2 * (x * z + w * y)),
        (2 * (x * y + w * z), w * w - x * x + y * y - z * z, 2 * (y * z - w * x)),
        (2 * (x * z - w * y), 2 * (y * z + w * x), w * w - x * x - y * y + z * z),
    )
    return np.array(rows) / square, square


class Places:
    """What the arm is at the points `s`."""

    def __init__(self, s):
        self.s = s
        radius = RADIUS[0] + (RADIUS[1] - RADIUS[0]) * s
        area = math.pi * radius**2
        shear = YOUNG / 3.0
        plain = np.array((YOUNG * area, shear * area, shear * area)) / FORCE
        turning = np.array((shear * area * radius**2 / 2, YOUNG * area * radius**2 / 4, YOUNG * area * radius**2 / 4))
        self.stiffness = np.concatenate((plain, turning / (FORCE * LENGTH**2)))
        offset = (OFFSET[0] + (OFFSET[1] - OFFSET[0]) * s) / LENGTH
        zero = np.zeros_like(s)
        self.paths = [np.array((zero, offset * math.cos(phi), offset * math.sin(phi))) for phi in ANGLES]
        slope = (OFFSET[1] - OFFSET[0]) / LENGTH
        self.path_slopes = [np.array((0.0, slope * math.cos(phi), slope * math.sin(phi)))[:, None] for phi in ANGLES]
        self.wetted = math.pi * WATER * radius * LENGTH / FORCE


class Arm:
    """The arm under three tensions (N) in a stream (m/s)."""

    def __init__(self, tensions, speed, tolerance=1e-10):
        self.pull(tensions)
        self.stream = speed * DIRECTION[:, None]
        self.tolerance = tolerance
        self.places, self.kept = {}, {}

    def pull(self, tensions):
        self.tensions = np.array(tensions) / FORCE
        self.kept = {}

    def section(self, s, force, moment):
        """Strains that carry n_f and m_f (in the directors), and the inverse of the law's derivative."""
        key = s.tobytes()
        if key not in self.places:
            self.places[key] = Places(s)
        places = self.places[key]
        strain = self.kept.get(key)
        if strain is None:
            strain = np.zeros((6, len(s)))
            strain[0] = 1.0
        carried = np.concatenate((force, moment))
        for _ in range(30):
            v, u = strain[:3], strain[3:]
            residual = places.stiffness * strain - carried
            residual[0] -= places.stiffness[0]
            by_strain = np.zeros((6, 6, len(s)))
            by_strain[range(6), range(6)] = places.stiffness
            for tension, p, slope in zip(self.tensions, places.paths, places.path_slopes):
                if tension == 0.0:
                    continue
                tau = v + cross(u, p) + slope
                size = np.sqrt((tau * tau).sum(axis=0))
                t = tau / size
                lever = skew(p)
                residual[:3] += tension * t
                residual[3:] += tension * cross(p, t)
                across = (np.eye(3)[:, :, None] - t[:, None] * t[None]) * (tension / size)
                by_turn = -product(across, lever)
                by_strain[:3, :3] += across
                by_strain[:3, 3:] += by_turn
                by_strain[3:, :3] += product(lever, across)
                by_strain[3:, 3:] += product(lever, by_turn)
            inverse = np.linalg.inv(by_strain.transpose(2, 0, 1)).transpose(1, 2, 0)
            step = apply(inverse, residual)
            strain = strain - step
            if np.abs(step).max() < self.tolerance:
                break
        self.kept[key] = strain
        return places, strain, inverse

    def load(self, wetted, along):
        """Load of the stream and its derivative by r'."""
        size = np.sqrt((along * along).sum(axis=0))
        t = along / size
        stream = self.stream
        ut = (stream * t).sum(axis=0)
        across = stream - ut * t
        speed = np.sqrt((across * across).sum(axis=0))
        v = LAYER * ut
        factor = (np.abs(v) + 2.0 * speed) * v
        force = wetted * (factor * t + speed * across)
        outer = lambda a, b: a[:, None] * b[None]
        eye = np.eye(3)[:, :, None]
        stream = np.broadcast_to(stream, t.shape)
        across_by = -outer(t, stream) - ut * eye
        speed_by = np.einsum("im,ijm->jm", across / speed, across_by)
        factor_by = 2.0 * (np.abs(v) + speed) * LAYER * stream + 2.0 * v * speed_by
        by_t = outer(t, factor_by) + factor * eye + outer(across, speed_by) + speed * across_by
        return force, wetted / size * product(by_t, eye - outer(t, t))

    def parts(self, s, y):
        q, n, m = y[:4], y[4:7], y[7:10]
        frame, square = directors(q)
        back = transposed(frame)
        force, moment = apply(back, n), apply(back, m)
        places, strain, inverse = self.section(s, force, moment)
        along = apply(frame, strain[:3])
        return q, n, frame, square, force, moment, places, strain, inverse, along

    def slopes(self, s, y):
        q, n, _, _, _, _, places, strain, _, along = self.parts(s, y)
        u = strain[3:]
        load, _ = self.load(places.wetted, along)
        out = np.empty_like(y)
        out[0] = -0.5 * (q[1:] * u).sum(axis=0)
        out[1:4] = 0.5 * (q[0] * u + cross(q[1:], u))
        out[4:7] = -load
        out[7:10] = -cross(along, n)
        out[10:] = along
        return out

    def gradients(self, s, y):
        q, n, frame, square, force, moment, places, strain, inverse, along = self.parts(s, y)
        v, u = strain[:3], strain[3:]
        _, load_by = self.load(places.wetted, along)
        # The turn (in the directors) by the quaternion: 2 conj(q) dq over the square of the norm.
        turn = np.empty((3, 4, len(s)))
        turn[:, 0] = -q[1:]
        turn[:, 1:] = q[0] * np.eye(3)[:, :, None] - skew(q[1:])
        turn *= 2.0 / square
        back = transposed(frame)
        carried = np.zeros((6, 10, len(s)))
        carried[:3, :4], carried[3:, :4] = product(skew(force), turn), product(skew(moment), turn)
        carried[:3, 4:7], carried[3:, 7:] = back, back
        strain_by = product(inverse, carried)
        along_by = product(frame, strain_by[:3])
        along_by[:, :4] -= product(frame, product(skew(v), turn))
        out = np.zeros((13, 13, len(s)))
        out[0, 1:4] = -0.5 * u
        out[1:4, 0] = 0.5 * u
        out[1:4, 1:4] = -0.5 * skew(u)
        out[0, :10] -= 0.5 * np.einsum("im,ijm->jm", q[1:], strain_by[3:])
        by_u = 0.5 * (q[0] * np.eye(3)[:, :, None] + skew(q[1:]))
        out[1:4, :10] += product(by_u, strain_by[3:])
        out[4:7, :10] = -product(load_by, along_by)
        out[7:10, :10] = product(skew(n), along_by)
        out[7:10, 4:7] -= skew(along)
        out[10:, :10] = along_by
        return out

    def start(self, nodes):
        """The straight arm, which carries nothing."""
        state = np.zeros((13, len(nodes)))
        state[0] = 1.0
        state[10] = nodes
        return state

    def solve(self, nodes, state, tol):
        return solve_bvp(
            self.slopes, ends, nodes, state, fun_jac=self.gradients, bc_jac=ends_by_state, tol=tol, max_nodes=5000
        )


def ends(base, tip):
    return np.concatenate((base[:4] - (1.0, 0.0, 0.0, 0.0), base[10:], tip[4:10]))


LEFT, RIGHT = np.zeros((13, 13)), np.zeros((13, 13))
LEFT[range(4), range(4)] = 1.0
LEFT[range(4, 7), range(10, 13)] = 1.0
RIGHT[range(7, 13), range(4, 10)] = 1.0


def ends_by_state(base, tip):
    return LEFT, RIGHT


@dataclass
class Best:
    """One way of solving: equal elements, and a tolerance; warm from the answer at 1 % less tension."""

    tensions: tuple
    speed: float
    nodes: int
    tol: float
    warm: bool

    def __str__(self):
        return f"{self.nodes} nodes, tol {self.tol:g}"

    def solve(self):
        """Microseconds of the processor, and the tip over L; no tip where it failed."""
        nodes = np.linspace(0.0, 1.0, self.nodes)
        if self.warm:
            arm = Arm([0.99 * t for t in self.tensions], self.speed)
            before = arm.solve(nodes, arm.start(nodes), self.tol)
            arm.pull(self.tensions)
            nodes, state = before.x, before.y
        else:
            arm = Arm(self.tensions, self.speed)
            state = arm.start(nodes)
        start = time.process_time()
        found = arm.solve(nodes, state, self.tol)
        took = 1e6 * (time.process_time() - start)
        return took, found.y[10:, -1] if found.success else None


def tuned(tensions, speed, exact, error, warm):
    """The fastest of a grid of choices that is within `error` of the exact tip (over L)."""
    grid = itertools.product((20, 30, 40, 50, 60, 80), (1e-3, 1e-4, 1e-5, 1e-6))
    return fastest((Best(tensions, speed, *choice, warm) for choice in grid), exact, error, 2)
