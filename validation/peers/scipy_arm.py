"""The arm `paper` for SciPy's `solve_bvp`: the equations of docs/model.md, sections 2 to 7, in their default
reading, as a vectorised right-hand side with its Jacobian.

The state is (theta, n_f . e1, n_f . e2, m_f) over s in [0, 1], lengths over L and forces over C3 A0 / L^2 at the
base. The strains at a point follow from the section law by Newton, all points at once. beta' is iterated along with
them, and its own slope beta'' is taken from the polynomial through the beta' of the nearest nodes. x and y are
integrals of what the collocation has evaluated anyhow, by the same Lobatto formula.
"""

import math

import numpy as np
from scipy.integrate import solve_bvp

LENGTH = 0.2
RADIUS = (10e-3, 0.8e-3)
OFFSET = (8e-3, 0.1e-3)
C = (500e3, 500e3 / 3.0, 150.0)
WATER = 1000.0
LAYER = 2.0 / 3.0
# The force that everything is over.
FORCE = C[2] * math.pi * RADIUS[0] ** 2 / LENGTH**2


class Places:
    """What the arm is at the points `s`, and formulas to interpolate there from the nodes."""

    def __init__(self, s):
        self.s = s
        slope = RADIUS[1] - RADIUS[0]
        radius = RADIUS[0] + slope * s
        area, area_slope = math.pi * radius**2, 2.0 * math.pi * radius * slope
        unit = (1.0 / FORCE, 1.0 / FORCE, 1.0 / (FORCE * LENGTH**2))
        self.stiffness = np.array([c * area * u for c, u in zip(C, unit)])
        self.stiffness_slope = np.array([c * area_slope * u for c, u in zip(C, unit)])
        self.y = (OFFSET[0] + (OFFSET[1] - OFFSET[0]) * s) / LENGTH
        self.y_slope = (OFFSET[1] - OFFSET[0]) / LENGTH
        self.wetted = math.pi * WATER * radius * LENGTH / FORCE


def weights(nodes, at, points=6):
    """Matrices that take values at `nodes` to values and to slopes at `at`, by the polynomial through the nearest."""
    middle = np.searchsorted(nodes, at) - points // 2
    first = np.clip(middle, 0, len(nodes) - points)
    columns = first[:, None] + np.arange(points)
    stencil = nodes[columns] - at[:, None]
    scale = np.abs(stencil).max(axis=1)
    powers = (stencil / scale[:, None])[:, None, :] ** np.arange(points)[None, :, None]
    inverse = np.linalg.inv(powers)
    value, slope = np.zeros((2, len(at), len(nodes)))
    np.put_along_axis(value, columns, inverse[:, :, 0], axis=1)
    np.put_along_axis(slope, columns, inverse[:, :, 1] / scale[:, None], axis=1)
    return value, slope


class Section:
    """The section law with the cable at given strains, beta' and beta''."""

    def __init__(self, places, tension, strain, q, r):
        nu, eta, mu = strain
        y, y_slope, k, k_slope = places.y, places.y_slope, places.stiffness, places.stiffness_slope
        beta = 1.0 / nu
        area = beta * beta
        slope = -area
        area_nu = -2.0 * beta * area
        lever = y * beta
        along = nu - lever * mu
        across = eta + y_slope * beta + y * q
        over = 1.0 / np.sqrt(along * along + across * across)
        a, b = along * over, across * over
        aa, ab, bb = b * b * over, -a * b * over, a * a * over
        along_nu = 1.0 - y * mu * slope
        across_nu = y_slope * slope
        a_nu, b_nu = aa * along_nu + ab * across_nu, ab * along_nu + bb * across_nu
        along_s = -y_slope * beta * mu
        across_s = y_slope * q + y * r
        a_s, b_s = aa * along_s + ab * across_s, ab * along_s + bb * across_s
        pull = tension * lever
        ka = k * area
        strained = np.array((nu - 1.0, eta, mu))
        carried = ka * strained
        by_nu = k * strained * area_nu
        along = k_slope * strained * area
        self.slope = slope
        self.curvature = -area_nu  # d2 beta / d nu2 = 2 / nu^3
        self.carried = carried + np.array((tension * a, tension * b, -pull * a))
        self.by_strain = (
            (ka[0] + by_nu[0] + tension * a_nu, tension * ab, -pull * aa),
            (by_nu[1] + tension * b_nu, ka[1] + tension * bb, -pull * ab),
            (by_nu[2] - pull * a_nu - tension * y * slope * a, -pull * ab, ka[2] + pull * lever * aa),
        )
        self.along_s = along + np.array((tension * a_s, tension * b_s, -pull * a_s - tension * y_slope * beta * a))
        # By beta', with beta'' or without: the same column, as both enter tau . b times y.
        self.by_q = np.array((tension * y * ab, tension * y * bb, -pull * y * ab))
        (m00, m01, m02), (m10, m11, m12), (m20, m21, m22) = self.by_strain
        c00, c01, c02 = m11 * m22 - m12 * m21, m12 * m20 - m10 * m22, m10 * m21 - m11 * m20
        f = 1.0 / (m00 * c00 + m01 * c01 + m02 * c02)
        self.inverse = np.array(
            (
                (c00 * f, (m02 * m21 - m01 * m22) * f, (m01 * m12 - m02 * m11) * f),
                (c01 * f, (m00 * m22 - m02 * m20) * f, (m02 * m10 - m00 * m12) * f),
                (c02 * f, (m01 * m20 - m00 * m21) * f, (m00 * m11 - m01 * m10) * f),
            )
        )


def apply(matrix, vector):
    return matrix[:, 0] * vector[0] + matrix[:, 1] * vector[1] + matrix[:, 2] * vector[2]


class Flow:
    """The load of the stream at given theta and strains, with its gradients where they are asked for."""

    def __init__(self, places, speed, cos, sin, strain):
        nu, eta, _ = strain
        self.square = nu * nu + eta * eta
        over = 1.0 / np.sqrt(self.square)
        u0, u1 = (cos * nu - sin * eta) * over, (sin * nu + cos * eta) * over
        t, n = speed * u0, -speed * u1
        v, n_abs = LAYER * t, np.abs(n)
        v_abs = np.abs(v)
        self.per_nu = -1.0 / nu
        s = places.wetted / nu
        tangential, normal = s * (v_abs + 2.0 * n_abs) * v, s * n_abs * n
        self.force = (tangential * u0 - normal * u1, tangential * u1 + normal * u0)
        self.kept = (s, u0, u1, t, n, v, n_abs, v_abs, tangential, normal)

    def by_angle(self):
        """By the angle of the centreline's tangent."""
        s, u0, u1, t, n, v, n_abs, v_abs, tangential, normal = self.kept
        v_turn, n_turn = LAYER * n, -t
        along = s * 2.0 * ((v_abs + n_abs) * v_turn + np.sign(n) * v * n_turn) - normal
        across = tangential + s * 2.0 * n_abs * n_turn
        return along * u0 - across * u1, along * u1 + across * u0


class Points:
    """The equations at one set of points: their strains from the last call, and what the Jacobian needs."""

    def __init__(self, places):
        self.places = places
        count = len(places.s)
        self.strain = None
        self.q = np.zeros(count)
        self.state = None
        self.by_state = None

    def evaluate(self, arm, state, tolerance, q_curvature):
        """Strains and slopes at `state`; `q_curvature` gives beta'' from beta'."""
        places = self.places
        theta, n1, n2, m = state
        cos, sin = np.cos(theta), np.sin(theta)
        n_a, n_b = cos * n1 + sin * n2, cos * n2 - sin * n1
        contact = np.array((n_a, n_b, m))
        strain, q = self.strain, self.q
        if self.by_state is not None:
            strain = strain + np.einsum("ijm,jm->im", self.by_state, state - self.state)
        r = q_curvature(q)
        for _ in range(60):
            law = Section(places, arm.tension, strain, q, r)
            step = apply(law.inverse, contact - law.carried)
            size = max(np.abs(step[:2]).max(), (np.abs(step[2]) / (2.0 + np.abs(strain[2]))).max())
            share = self.share(law, strain, step)
            far = share < 1.0
            step *= share
            strain = strain + step
            nu, eta, mu = strain
            flow = Flow(places, arm.speed, cos, sin, strain)
            f1, f2 = flow.force
            f_a, f_b = cos * f1 + sin * f2, cos * f2 - sin * f1
            m_slope = eta * n_a - nu * n_b
            slope = apply(law.inverse, np.array((mu * n_b - f_a, -(mu * n_a + f_b), m_slope)) - law.along_s)
            moved = q
            q = np.where(far, q, law.slope * slope[0])
            r = np.where(far, r, q_curvature(q))
            turned = np.abs((q - moved) * places.y).max()
            if size < tolerance and turned < tolerance:
                break
        self.strain, self.q, self.state = strain, q, state.copy()
        self.kept = (cos, sin, n_a, n_b, f_a, f_b, law, flow, slope)
        self.rate = (cos * nu - sin * eta, sin * nu + cos * eta)
        return np.array((mu, -f1, -f2, m_slope))

    def share(self, law, strain, step):
        """The share of a step, point by point, that neither halves nu nor closes the cable's side nor leaps."""
        y, (nu, _, mu) = self.places.y, strain
        side = nu - y / nu * mu
        closing = y / nu * step[2] + (y * law.slope * mu - 1.0) * step[0]
        least = np.minimum(1.0, 0.5 * nu / np.maximum(np.abs(step[0]), 1e-30))
        least = np.minimum(least, 0.67 * np.abs(side) / np.maximum(closing, 1e-30))
        return np.minimum(least, 0.7 / np.maximum(np.abs(step[:2]).max(axis=0), 1e-30))

    def jacobian(self, arm, by_strain_slope, by_q_slope):
        """d slopes / d state, with the change of beta' and without that of beta''.

        `by_strain_slope` and `by_q_slope` are the gradients of the section law differentiated along the arm:
        derivatives of the law's total slope by strain and by beta', as second derivatives commute.
        """
        cos, sin, n_a, n_b, f_a, f_b, law, flow, strain_slope = self.kept
        nu, eta, mu = self.strain
        zero = np.zeros_like(nu)
        g1, g2 = flow.by_angle()
        force = np.array(flow.force)
        turned = np.array((g1, g2))
        # The load by nu and eta, through the turn of the tangent and through beta.
        f_nu = turned * (-eta / flow.square) + force * flow.per_nu
        f_eta = turned * (nu / flow.square)
        fa = lambda f: cos * f[0] + sin * f[1]
        fb = lambda f: cos * f[1] - sin * f[0]
        da, db = (n_b, cos, sin), (-n_a, -sin, cos)
        contact_by_state = np.array(((*da, zero), (*db, zero), (zero, zero, zero, zero + 1.0)))
        slope_by_state = np.zeros((3, 4, len(nu)))
        for k in range(3):
            slope_by_state[0, k], slope_by_state[1, k] = mu * db[k], -mu * da[k]
            slope_by_state[2, k] = eta * da[k] - nu * db[k]
        slope_by_state[0, 0] -= f_b + fa(turned)
        slope_by_state[1, 0] -= fb(turned) - f_a
        by_strain = np.array(
            ((-fa(f_nu), -fa(f_eta), n_b), (-fb(f_nu), -fb(f_eta), -n_a), (-n_b, n_a, zero))
        ) - by_strain_slope
        w = np.einsum("ijm,jkm->ikm", law.inverse, contact_by_state)
        g = apply(law.inverse, law.by_q)
        row = law.inverse[0]
        bend = law.curvature * strain_slope[0]
        total = slope_by_state + np.einsum("ijm,jkm->ikm", by_strain, w)
        top = law.slope * (row[:, None] * total).sum(axis=0) + bend * w[0]
        reach = law.slope * (row * (apply(by_strain, g) + by_q_slope)).sum(axis=0) + bend * g[0]
        w -= g[:, None] * (top / (1.0 + reach))
        self.by_state = w
        out = np.empty((4, 4, len(nu)))
        out[0] = w[2]
        for k in range(2):
            out[k + 1] = -(f_nu[k] * w[0] + f_eta[k] * w[1])
            out[k + 1, 0] -= turned[k]
        out[3] = slope_by_state[2] + n_a * w[1] - n_b * w[0]
        return out


class Mesh:
    """A mesh's nodes, middles, and the two points between at which `solve_bvp` looks at its residual."""

    def __init__(self, nodes):
        self.nodes = nodes
        step = np.diff(nodes)
        middle = nodes[:-1] + 0.5 * step
        off = 0.5 * step * math.sqrt(3.0 / 7.0)
        self.sets = []
        for at in (nodes, middle, middle + off, middle - off):
            self.sets.append((Places(at), *weights(nodes, at)))


class Arm:
    """`paper` under one tension (N) in one stream (m/s, along the straight arm)."""

    def __init__(self, tension, speed, tolerance):
        self.tension, self.speed = tension / FORCE, speed
        self.tolerance = tolerance
        self.meshes = {}
        self.points = None

    def mesh(self, nodes):
        key = nodes.tobytes()
        if key not in self.meshes:
            self.meshes[key] = Mesh(nodes)
        return self.meshes[key]

    def take(self, nodes, strain, q):
        """Takes a mesh, with guesses of strains and beta' at its nodes."""
        self.at = self.mesh(nodes)
        self.points = [Points(places) for places, _, _ in self.at.sets]
        self.points[0].strain, self.points[0].q = strain, q

    def which(self, s):
        """The set of points that `s` is; a new mesh is taken where there is one."""
        if len(s) > 1 and s[0] == 0.0 and s[-1] == 1.0:
            if len(s) != len(self.at.nodes) or not np.array_equal(s, self.at.nodes):
                value, _ = weights(self.at.nodes, s)
                old = self.points[0]
                self.take(s.copy(), old.strain @ value.T, value @ old.q)
            return 0
        return 1 + min(range(3), key=lambda k: abs(self.at.sets[k + 1][0].s[0] - s[0]))

    def slopes(self, s, state):
        index = self.which(s)
        points, nodes = self.points[index], self.points[0]
        _, value, slope = self.at.sets[index]
        if index == 0:
            return points.evaluate(self, state, self.tolerance, lambda q: slope @ q)
        if points.strain is None:
            points.strain, points.q = nodes.strain @ value.T, value @ nodes.q
        r = slope @ nodes.q
        return points.evaluate(self, state, self.tolerance, lambda q: r)

    def gradients(self, s, state):
        index = self.which(s)
        points = self.points[index]
        if points.state is None or not np.array_equal(points.state, state):
            self.slopes(s, state)
        _, _, slope = self.at.sets[index]
        law = self.points[0].kept[6]
        by_strain = np.array(law.by_strain).reshape(9, -1) @ slope.T
        return points.jacobian(self, by_strain.reshape(3, 3, -1), law.by_q @ slope.T)

    def start(self, nodes):
        """States of the arm under its cable alone: no other force anywhere, the section law says the rest."""
        places = self.mesh(nodes).sets[0][0]
        # The axial balance k1 (1 - nu) = T nu^2 of a cable along the arm, and the bending that goes with it.
        k1, k3, pull = places.stiffness[0], places.stiffness[2], self.tension
        nu = (np.sqrt(k1 * k1 + 4.0 * pull * k1) - k1) / (2.0 * pull)
        nu = np.minimum(1.5 * nu, 1.0)
        self.take(nodes, np.array((nu, np.zeros_like(nu), pull * places.y * nu / k3)), np.zeros_like(nu))
        state = np.zeros((4, len(nodes)))
        speed, self.speed = self.speed, 0.0
        self.slopes(nodes, state)
        self.speed = speed
        mu = self.points[0].strain[2]
        state[0, 1:] = np.cumsum(0.5 * (mu[1:] + mu[:-1]) * np.diff(nodes))
        return state

    def solve(self, nodes, state, tol):
        return solve_bvp(
            self.slopes, ends, nodes, state, fun_jac=self.gradients, bc_jac=ends_by_state, tol=tol, max_nodes=5000
        )

    def cold(self, nodes, tol):
        return self.solve(nodes, self.start(nodes), tol)

    def tip(self):
        """Where the tip is, over L, by the formula of the collocation."""
        h = np.diff(self.at.nodes)
        out = []
        for end, middle in zip(self.points[0].rate, self.points[1].rate):
            out.append(float(h @ (end[:-1] + 4.0 * middle + end[1:]) / 6.0))
        return np.array(out)

    def pull(self, tension):
        """Another tension, in N."""
        self.tension = tension / FORCE

    def kept(self):
        """The mesh and its strains, for `go_back`."""
        return self.at, [(points.strain, points.q) for points in self.points]

    def go_back(self, mesh, kept):
        """Takes up a mesh and its strains again, for a warm start."""
        self.at = mesh
        self.points = [Points(places) for places, _, _ in mesh.sets]
        for points, (strain, q) in zip(self.points, kept):
            points.strain, points.q = strain, q


def ends(base, tip):
    return np.array((base[0], tip[1], tip[2], tip[3]))


LEFT = np.diag((1.0, 0.0, 0.0, 0.0))
RIGHT = np.zeros((4, 4))
RIGHT[1, 1] = RIGHT[2, 2] = RIGHT[3, 3] = 1.0


def ends_by_state(base, tip):
    return LEFT, RIGHT
