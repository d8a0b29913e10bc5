"""The equations of docs/model.md, sections 2 to 7, at many points at once.

Written for complex numbers: derivatives are imaginary parts of steps of 1e-30 i. Unknown at a point are theta,
n_f . e1, n_f . e2, m_f, nu, eta, mu, and with them beta', which is the slope of the polynomial through beta.
"""

import numpy as np

UNKNOWNS = 7


def beta_of(arm, nu):
    if arm.volume == "planar":
        return 1.0 / nu
    return nu**-0.5 if arm.volume == "circular" else np.ones_like(nu)


class Signs:
    """Where each absolute value of the stream's load is on its branch: at each point by itself, or as a whole piece.

    A piece that keeps to one branch has a smooth load, even where its ends are a little off the kink.
    """

    def __init__(self, fixed=None):
        self.fixed, self.met, self.count = fixed, [], 0

    def of(self, v):
        """The sign of v, 0 where it is zero: at each point, or that of the piece."""
        sign = np.sign(v.real) if self.fixed is None else self.fixed[self.count]
        self.met.append(v.real)
        self.count += 1
        return sign


def frame(cos, sin, x, y):
    """Unit vector along x a + y b, in space, and the one to its left."""
    over = (x * x + y * y) ** -0.5
    u = ((cos * x - sin * y) * over, (sin * x + cos * y) * over)
    return u, (-u[1], u[0])


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1]


def stream_on(arm, places, beta, wet, u, outward, hit, signs):
    """The load of the stream on one surface. `hit` is what counts of its normal speed, as a speed into the surface."""
    u_t, u_n = dot(arm.stream, u), dot(arm.stream, outward)
    sign = signs.of(u_t)
    u_n = u_n * hit
    into = -u_n if arm.lateral else signs.fixed[1] * u_n
    if arm.drag is not None:
        along, across = places.along * beta * sign * u_t * u_t, places.across * beta * into * u_n
    else:
        s, v = places.wetted * beta, arm.layer * u_t
        speed = sign * v
        along = s * ((speed + into) ** 2 * sign if arm.resultant else (speed + 2.0 * into) * v)
        across = s * into * u_n
    return [wet * (along * u[k] + across * outward[k]) for k in range(2)]


def loads(arm, places, theta, strain, q, signs):
    """Stream, weight and buoyancy per length. `signs.met` then has what changes sign at kinks and jumps."""
    nu, eta, mu = strain
    beta = beta_of(arm, nu)
    cos, sin = np.cos(theta), np.sin(theta)
    wet = (nu * nu + eta * eta) ** 0.5 if arm.deformed else 1.0
    along, across = frame(cos, sin, nu, eta)
    total = [np.zeros_like(nu), np.zeros_like(nu)]
    normals = [(1.0, across)]
    if arm.lateral:
        widening = q * places.radius + beta * places.radius_slope
        sides = [frame(cos, sin, nu - o * beta * places.radius * mu, eta + o * widening) for o in (1.0, -1.0)]
        outward = [tuple(o * c for c in w) for o, (_, w) in zip((1.0, -1.0), sides)]
        hits = [dot(arm.stream, w) for w in outward]
        # The side with the smaller U . u_n is windward; 0 is a tie, of which each side has a half.
        left = 0.5 - 0.5 * signs.of(hits[0] - hits[1])
        shares = (left, 1.0 - left)
        normals = list(zip(shares, outward))
        if any(arm.stream):
            for share, (u, _), w, hit in zip(shares, sides, outward, hits):
                faces = 0.5 - 0.5 * signs.of(hit)
                part = stream_on(arm, places, beta, wet, u, w, faces, signs)
                total = [total[k] + share * part[k] for k in range(2)]
    elif any(arm.stream):
        # Both sides have the centreline's tangent: the normal speed counts whatever its sign.
        sign = signs.of(dot(arm.stream, across))
        u_n = dot(arm.stream, across)
        inner = Signs([signs.of(dot(arm.stream, along)), sign])
        total = stream_on(arm, places, beta, wet, along, across, 1.0, inner)
    if arm.section:
        ratio = nu * beta * beta
    else:
        ratio = nu if arm.volume == "none" else 1.0
    h = [places.weight[k] - places.displaced[k] * ratio for k in range(2)]
    if arm.normal_only:
        whole, h = h, [0.0, 0.0]
        for share, w in normals:
            h = [h[k] + share * dot(whole, w) * w[k] for k in range(2)]
    return [total[k] + h[k] for k in range(2)]


def cables(arm, places, strain, q, tensions, runs=None):
    """What the cables carry along a, b and about k: the sums of T t_c and of -T y beta (t_c . a)."""
    nu, eta, mu = strain
    beta = beta_of(arm, nu)
    total = [np.zeros_like(nu) for _ in range(3)]
    for (y, slope), run, tension in zip(places.offsets, runs or places.runs, tensions):
        x, z = nu - y * beta * mu, eta + slope * beta + y * q
        pull = tension * run * (x * x + z * z) ** -0.5
        total = [total[0] + pull * x, total[1] + pull * z, total[2] - pull * y * beta * x]
    return total


def residuals(arm, places, u, q, shares, signs):
    """Slopes of theta, n_f, m_f, and the section law's residuals, with loads and tensions by their `shares`."""
    theta, n1, n2, m, nu, eta, mu = u
    cos, sin = np.cos(theta), np.sin(theta)
    f = loads(arm, places, theta, (nu, eta, mu), q, signs)
    x, y = cos * nu - sin * eta, sin * nu + cos * eta
    slopes = [mu, -shares[0] * f[0], -shares[0] * f[1], y * n1 - x * n2]
    area = beta_of(arm, nu) ** 2
    body = [places.stiffness[k] * (u[4 + k] - places.reference[k]) * area for k in range(3)]
    pulled = cables(arm, places, (nu, eta, mu), q, shares[1] * arm.tensions / arm.force)
    carried = (cos * n1 + sin * n2, cos * n2 - sin * n1, m)
    return slopes, [body[k] + pulled[k] - carried[k] for k in range(3)]
