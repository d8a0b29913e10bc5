"""Chebyshev collocation on pieces of the arm: one Newton system for states and strains, no part of it lagged.

A piece has polynomials through its Chebyshev points. The differential equations hold at all of them but one, where
the piece joins its neighbour; the section law holds at all. beta' is the slope of the polynomial through beta, with no
condition of its own, which leaves the smooth solution alone (docs/model.md, section 8, item 1).
"""

import numpy as np
from numpy.polynomial import chebyshev
from scipy.sparse import coo_matrix
from scipy.sparse.linalg import splu

from arm import Places
from equations import UNKNOWNS, Signs, beta_of, cables, residuals

STEP = 1e-30


def points(degree):
    """Chebyshev points on [0, 1], rising, with the matrix that differentiates there."""
    x = -np.cos(np.pi * np.arange(degree + 1) / degree)
    c = np.ones(degree + 1)
    c[0] = c[-1] = 2.0
    c *= (-1.0) ** np.arange(degree + 1)
    gap = x[:, None] - x[None, :] + np.eye(degree + 1)
    slope = np.outer(c, 1.0 / c) / gap
    slope -= np.diag(slope.sum(axis=1))
    return 0.5 * (x + 1.0), 2.0 * slope


def interpolate(nodes, values, at):
    """The polynomials through `values` (..., points) at `at`, within [0, 1]."""
    weights = (-1.0) ** np.arange(len(nodes))
    weights[0] *= 0.5
    weights[-1] *= 0.5
    gap = at[:, None] - nodes[None, :]
    exact = np.abs(gap) < 1e-15
    ratio = weights / np.where(exact, 1.0, gap)
    ratio[exact.any(axis=1)] = exact[exact.any(axis=1)]
    return values @ (ratio / ratio.sum(axis=1, keepdims=True)).T


class Grid:
    def __init__(self, arm, ends, degree):
        self.arm, self.ends, self.degree = arm, np.asarray(ends), degree
        self.nodes, self.slope = points(degree)
        self.steps = np.diff(self.ends)
        self.s = (self.ends[:-1, None] + self.steps[:, None] * self.nodes).ravel()
        middle = np.repeat(0.5 * (self.ends[:-1] + self.ends[1:]), degree + 1)
        self.places = Places(arm, self.s, middle)
        self.pieces = len(self.steps)

    def along(self, values):
        """Slopes of polynomials through `values` (points of all pieces)."""
        shaped = values.reshape(self.pieces, -1)
        return ((shaped @ self.slope.T) / self.steps[:, None]).ravel()

    def at(self, u, s):
        """Unknowns at `s`, of the piece to the left where two meet."""
        piece = np.clip(np.searchsorted(self.ends, s, side="left") - 1, 0, self.pieces - 1)
        out = np.empty((len(u), len(s)))
        shaped = u.reshape(len(u), self.pieces, -1)
        for k in np.unique(piece):
            chosen = piece == k
            local = (s[chosen] - self.ends[k]) / self.steps[k]
            out[:, chosen] = interpolate(self.nodes, shaped[:, k], local)
        return out

    def conditions(self, u, shares):
        """Residuals of the conditions at base and tip, one for each of the first four unknowns, by u at both ends."""
        arm = self.arm
        theta, n1, n2, m = u[:4]
        tip = -1
        cos, sin = np.cos(theta[tip]), np.sin(theta[tip])
        lengths = (arm.force, arm.force, arm.force * arm.length)
        force = [arm.tip_force[0] + arm.follower[0] * cos - arm.follower[1] * sin]
        force += [arm.tip_force[1] + arm.follower[0] * sin + arm.follower[1] * cos]
        given = [force[0] / lengths[0], force[1] / lengths[1], arm.tip_moment / lengths[2]]
        unmet = [v - shares[0] * g for v, g in zip((n1[tip], n2[tip], m[tip]), given)]
        turned = theta[0] - arm.base[2]
        if not arm.unstrained:
            return [turned, *unmet], unmet
        # nu = beta = 1, eta = mu = 0 at the base, and beta' = 0 in the cables' tangents there.
        first = lambda v: np.array([v[0]])
        one, zero = first(np.ones(1)) + 0j, np.zeros(1)
        strain = (one, one * 0.0, one * 0.0)
        at_base = Places(arm, zero, np.array([1e-9]))
        pulled = cables(arm, at_base, strain, 0.0, shares[1] * arm.tensions / arm.force)
        own = [at_base.stiffness[k] * ((1.0, 0.0, 0.0)[k] - at_base.reference[k]) + pulled[k] for k in range(3)]
        cos, sin = np.cos(theta[0]), np.sin(theta[0])
        want = [cos * own[0][0] - sin * own[1][0], sin * own[0][0] + cos * own[1][0], own[2][0]]
        return [turned, *(v - w for v, w in zip((n1[0], n2[0], m[0]), want))], unmet


def system(grid, u, shares, fixed):
    """Residuals and their matrix, and the signs that the load met."""
    arm, n, pieces = grid.arm, grid.degree + 1, grid.pieces
    q = grid.along(beta_of(arm, u[4]))
    evaluate = lambda u, q, signs: residuals(arm, grid.places, u, q, shares, signs)
    signs = Signs(fixed)
    slopes, law = evaluate(u.astype(complex), q.astype(complex), signs)
    by = np.empty((7, UNKNOWNS + 1, u.shape[1]))
    for k in range(UNKNOWNS + 1):
        moved, moved_q = u.astype(complex), q.astype(complex)
        if k < UNKNOWNS:
            moved[k] += 1j * STEP
        else:
            moved_q = moved_q + 1j * STEP
        out = evaluate(moved, moved_q, Signs(fixed))
        by[:, k] = np.array([v.imag / STEP for v in (*out[0], *out[1])])
    beta_nu = beta_of(arm, u[4] + 1j * STEP).imag / STEP
    # Rows and columns in the order piece, point, unknown.
    shaped = by.reshape(7, UNKNOWNS + 1, pieces, n)
    matrix = np.zeros((pieces, n, 7, n, UNKNOWNS))
    own = np.arange(n)
    differ = grid.slope[None] / grid.steps[:, None, None]
    matrix[:, own, :, own, :] = shaped[:, :UNKNOWNS].transpose(3, 2, 0, 1)
    through_beta = differ * beta_nu.reshape(pieces, 1, n)
    matrix[:, :, :, :, 4] += np.einsum("rpj,pjk->pjrk", shaped[:, UNKNOWNS], through_beta)
    matrix[:, :, :4] *= -1.0
    residual = np.empty((pieces, n, 7))
    for k in range(4):
        matrix[:, :, k, :, k] += differ
        residual[:, :, k] = grid.along(u[k]).reshape(pieces, n) - slopes[k].real.reshape(pieces, n)
    for k in range(3):
        residual[:, :, 4 + k] = law[k].real.reshape(pieces, n)
    # Joints: theta is carried from the base to the tip, the rest from the tip to the base.
    start = [True] + [arm.unstrained] * 3
    joints = []
    ends = u.reshape(UNKNOWNS, pieces, n)
    number = lambda piece, point, k: (piece * n + point) * UNKNOWNS + k
    conditions = by_ends(grid, u, shares)
    for k in range(4):
        row_point = 0 if start[k] else n - 1
        matrix[:, row_point, k] = 0.0
        for piece in range(pieces):
            row = number(piece, row_point, k)
            other = piece - 1 if start[k] else piece + 1
            if 0 <= other < pieces:
                there = n - 1 if start[k] else 0
                residual[piece, row_point, k] = ends[k, piece, row_point] - ends[k, other, there]
                joints += [(row, number(piece, row_point, k), 1.0), (row, number(other, there, k), -1.0)]
            else:
                value, entries = conditions[k]
                residual[piece, row_point, k] = value
                joints += [(row, number(piece, row_point, j), v) for j, v in entries]
    block = np.arange(n * UNKNOWNS)
    offset = np.arange(pieces)[:, None, None] * n * UNKNOWNS
    rows = np.broadcast_to(offset + block[None, :, None], (pieces, len(block), len(block)))
    columns = np.broadcast_to(offset + block[None, None, :], rows.shape)
    flat = matrix.reshape(pieces, len(block), len(block))
    kept = flat != 0.0
    extra = np.array(joints)
    data = np.concatenate((flat[kept], extra[:, 2]))
    row = np.concatenate((rows[kept], extra[:, 0].astype(int)))
    column = np.concatenate((columns[kept], extra[:, 1].astype(int)))
    count = pieces * len(block)
    return residual.ravel(), coo_matrix((data, (row, column)), (count, count)).tocsc(), signs.met


def by_ends(grid, u, shares):
    """Value of each end condition with its derivatives by the unknowns at its end."""
    arm = grid.arm
    value, _ = grid.conditions(u.astype(complex), shares)
    out = []
    for k in range(4):
        end = 0 if (k == 0 or arm.unstrained) else -1
        entries = []
        for j in range(4):
            moved = u.astype(complex)
            moved[j, end] += 1j * STEP
            by = grid.conditions(moved, shares)[0][k].imag / STEP
            if by != 0.0:
                entries.append((j, by))
        out.append((value[k].real, entries))
    return out


def newton(grid, u, shares, fixed=None, tolerance=1e-12, rounds=25):
    """States where the residuals vanish, or None. Steps that leave the range of the strains are shortened."""
    smallest, grown = np.inf, 0
    for _ in range(rounds):
        residual, matrix, _ = system(grid, u, shares, fixed)
        if not np.isfinite(residual).all():
            return None
        try:
            step = splu(matrix).solve(-residual).reshape(-1, UNKNOWNS).T
        except RuntimeError:
            return None
        if not np.isfinite(step).all():
            return None
        shrunk = np.max(np.abs(step[4]) / (0.4 * u[4]))
        turned = max(np.abs(step[0]).max() / 0.8, np.abs(step[5]).max() / 0.4)
        share = 1.0 / max(1.0, shrunk, turned)
        u = u + share * step
        scale = np.maximum(1.0, np.abs(u).max(axis=1))
        sizes = np.max(np.abs(step) / scale[:, None], axis=1)
        off = sizes.max()
        # On pieces as short as 1e-3 strains carry the rounding of beta', which does not reach the shape.
        if share == 1.0 and (off < tolerance or (sizes[:4].max() < 10.0 * tolerance and off < 1e6 * tolerance)):
            return u
        # Rounding is reached where steps no longer shrink.
        if share == 1.0 and off < 1e-9 and off > 0.3 * smallest:
            return u
        grown = grown + 1 if off > smallest else 0
        if grown > 6:
            return None
        smallest = min(smallest, off)
    return None


def tails(grid, u):
    """How large the last coefficients of the polynomials of each piece are, over the largest of the arm."""
    shaped = u.reshape(UNKNOWNS, grid.pieces, -1)
    x = 2.0 * grid.nodes - 1.0
    to = np.linalg.inv(chebyshev.chebvander(x, grid.degree))
    coefficients = np.abs(shaped @ to.T)
    scale = np.maximum(np.abs(u).max(axis=1), [1.0, 1e-3, 1e-3, 1e-3, 1.0, 1e-2, 1.0])[:, None]
    return (coefficients[:, :, -2:].max(axis=2) / scale).max(axis=0)


def integral(grid, values):
    """Integrals over each piece from its start to each point, as a matrix product, summed over pieces."""
    n = grid.degree + 1
    x = 2.0 * grid.nodes - 1.0
    to = np.linalg.inv(chebyshev.chebvander(x, grid.degree))
    rule = np.stack([chebyshev.chebval(x, chebyshev.chebint(to[:, k], lbnd=-1)) * 0.5 for k in range(n)], axis=1)
    parts = (values.reshape(grid.pieces, n) @ rule.T) * grid.steps[:, None]
    starts = np.concatenate(([0.0], np.cumsum(parts[:, -1])[:-1]))
    return (parts + starts[:, None]).ravel()
