"""The five problems of `crates/bvp` beside SciPy's `solve_bvp`: a table of evaluations, time and error.

    cargo run --release -p hydrostat-bvp --example table > ours.jsonl
    python validation/peers/scipy_problems.py ours.jsonl

SciPy gets analytic derivatives, vectorised right sides, the same guess on as many elements, and room for 100,000 nodes. Its tolerance bounds
relative residuals, not errors; errors are measured at the same places for both.
"""

import json
import sys
import time

import numpy as np
from scipy.integrate import solve_bvp
from scipy.special import ellipe, ellipk, erf, mathieu_a

REPEATS = 5
TOLERANCES = (1e-4, 1e-6, 1e-8, 1e-10)


class Problem:
    """One problem: `fun`, `jac`, conditions, guess and the error of a solution."""

    interval = (0.0, 1.0)
    parameters = None

    def __init__(self):
        self.evaluations = 0

    def counted(self, s, y, p=None):
        self.evaluations += s.size
        return self.fun(s, y, p)

    def counted_jac(self, s, y, p=None):
        self.evaluations += s.size
        return self.jac(s, y, p)

    def solve(self, tolerance):
        s = np.linspace(*self.interval, 9)
        guess = np.array(self.guess(s))
        if self.parameters is None:
            return solve_bvp(
                lambda s, y: self.counted(s, y),
                lambda a, b: self.conditions(a, b, None),
                s,
                guess,
                fun_jac=lambda s, y: self.counted_jac(s, y),
                tol=tolerance,
                max_nodes=100_000,
            )
        return solve_bvp(
            self.counted,
            self.conditions,
            s,
            guess,
            p=self.parameters,
            fun_jac=self.counted_jac,
            tol=tolerance,
            max_nodes=100_000,
        )

    def along(self, found, exact):
        s = np.linspace(*self.interval, 1001)
        return np.max(np.abs(found.sol(s)[0] - exact(s)))


class Bratu(Problem):
    name = "Bratu"

    def fun(self, s, y, p):
        return np.vstack((y[1], -np.exp(y[0])))

    def jac(self, s, y, p):
        out = np.zeros((2, 2, s.size))
        out[0, 1] = 1.0
        out[1, 0] = -np.exp(y[0])
        return out

    def conditions(self, a, b, p):
        return np.array([a[0], b[0]])

    def guess(self, s):
        return 16.0 * s * (1.0 - s), 16.0 * (1.0 - 2.0 * s)

    def error(self, found):
        low, high = 1.199678640257734, 20.0
        for _ in range(200):
            c = 0.5 * (low + high)
            low, high = (c, high) if 4.0 * c / np.sqrt(2.0) > np.cosh(c) else (low, c)
        return self.along(found, lambda s: 2.0 * np.log(np.cosh(c) / np.cosh(c * (1.0 - 2.0 * s))))


class Troesch(Problem):
    name = "Troesch"

    def fun(self, s, y, p):
        return np.vstack((y[1], 5.0 * np.sinh(5.0 * y[0])))

    def jac(self, s, y, p):
        out = np.zeros((2, 2, s.size))
        out[0, 1] = 1.0
        out[1, 0] = 25.0 * np.cosh(5.0 * y[0])
        return out

    def conditions(self, a, b, p):
        return np.array([a[0], b[0] - 1.0])

    def guess(self, s):
        return s, np.ones_like(s)

    def error(self, found):
        return abs(found.sol(0.0)[1] - 4.5750461406318e-2)


class Shock(Problem):
    name = "shock layer"
    interval = (-1.0, 1.0)
    epsilon = 1e-4

    def fun(self, s, y, p):
        source = -self.epsilon * np.pi**2 * np.cos(np.pi * s) - np.pi * s * np.sin(np.pi * s)
        return np.vstack((y[1], (source - s * y[1]) / self.epsilon))

    def jac(self, s, y, p):
        out = np.zeros((2, 2, s.size))
        out[0, 1] = 1.0
        out[1, 1] = -s / self.epsilon
        return out

    def conditions(self, a, b, p):
        return np.array([a[0] + 2.0, b[0]])

    def guess(self, s):
        return -np.ones_like(s), np.zeros_like(s)

    def error(self, found):
        width = np.sqrt(2.0 * self.epsilon)
        return self.along(found, lambda s: np.cos(np.pi * s) + erf(s / width) / erf(1.0 / width))


class Mathieu(Problem):
    name = "Mathieu"
    interval = (0.0, np.pi)
    parameters = (16.0,)

    def fun(self, s, y, p):
        return np.vstack((y[1], -(p[0] - 10.0 * np.cos(2.0 * s)) * y[0]))

    def jac(self, s, y, p):
        by_state, by_parameter = np.zeros((2, 2, s.size)), np.zeros((2, 1, s.size))
        by_state[0, 1] = 1.0
        by_state[1, 0] = -(p[0] - 10.0 * np.cos(2.0 * s))
        by_parameter[1, 0] = -y[0]
        return by_state, by_parameter

    def conditions(self, a, b, p):
        return np.array([a[0] - 1.0, a[1], b[1]])

    def guess(self, s):
        return np.cos(4.0 * s), -4.0 * np.sin(4.0 * s)

    def error(self, found):
        return abs(found.p[0] - mathieu_a(4, 5.0))


class Elastica(Problem):
    name = "elastica"
    parameters = ((np.pi / 2.0) ** 2,)
    tip = np.radians(120.0)

    def fun(self, s, y, p):
        return np.vstack((y[1], -p[0] * np.sin(y[0]), np.cos(y[0]), np.sin(y[0])))

    def jac(self, s, y, p):
        by_state, by_parameter = np.zeros((4, 4, s.size)), np.zeros((4, 1, s.size))
        by_state[0, 1] = 1.0
        by_state[1, 0] = -p[0] * np.cos(y[0])
        by_state[2, 0] = -np.sin(y[0])
        by_state[3, 0] = np.cos(y[0])
        by_parameter[1, 0] = -np.sin(y[0])
        return by_state, by_parameter

    def conditions(self, a, b, p):
        return np.array([a[0], a[2], a[3], b[0] - self.tip, b[1]])

    def guess(self, s):
        x = 0.5 * np.pi * s
        return self.tip * np.sin(x), self.tip * 0.5 * np.pi * np.cos(x), s, np.zeros_like(s)

    def error(self, found):
        square = np.sin(0.5 * self.tip) ** 2
        first, second = ellipk(square), ellipe(square)
        _, _, x, y = found.sol(1.0)
        exact = (first**2, 2.0 * second / first - 1.0, 2.0 * np.sqrt(square) / first)
        return max(abs(a - b) for a, b in zip((found.p[0], x, y), exact))


def peer(kind, tolerance):
    """Evaluations, microseconds and error; no error where it failed."""
    fastest = np.inf
    for _ in range(REPEATS):
        problem = kind()
        start = time.perf_counter()
        found = problem.solve(tolerance)
        fastest = min(fastest, time.perf_counter() - start)
    error = problem.error(found) if found.success else None
    return problem.evaluations, 1e6 * fastest, error, found.x.size - 1


def main():
    ours = {}
    with open(sys.argv[1], encoding="utf-8") as lines:
        for line in lines:
            row = json.loads(line)
            ours[row["problem"], row["tolerance"]] = row
    print("| Problem | Tolerance | Evaluations | SciPy | Time, us | SciPy | Error | SciPy |")
    print("|---|---|---|---|---|---|---|---|")
    for kind in (Bratu, Troesch, Shock, Mathieu, Elastica):
        for tolerance in TOLERANCES:
            row = ours.get((kind.name, tolerance))
            evaluations, took, error, _ = peer(kind, tolerance)
            shown = "failed" if error is None else f"{error:.0e}"
            own = ("-", "-", "-")
            if row:
                own = (f"{row['evaluations']}", f"{row['microseconds']:.0f}", f"{row['error']:.0e}")
            print(
                f"| {kind.name} | {tolerance:.0e} | {own[0]} | {evaluations} | {own[1]} | {took:.0f} "
                f"| {own[2]} | {shown} |"
            )


if __name__ == "__main__":
    main()
