# ---
# jupyter:
#   jupytext:
#     text_representation:
#       extension: .py
#       format_name: percent
#   kernelspec:
#     display_name: Python 3
#     language: python
#     name: python3
# ---

# %% [markdown]
# # Design for a given shape
#
# Where should a cable run, and how thick should the arm be, so that it takes a given shape while a stream pushes against it? The
# shape follows from 13 numbers. Their gradient comes from one adjoint solve of the converged equations, and SciPy does the rest.

# %%
import matplotlib.pyplot as plt
import numpy as np
from numpy.typing import NDArray
from scipy.optimize import OptimizeResult, minimize

import hydrostat as hs

Numbers = NDArray[np.float64]

# Across the arm, with published drag coefficients.
stream = {"flow.law": "quadratic-drag", "flow.cn": 2.5, "flow.ct": 0.005, "flow.direction": -90}
arm = hs.Arm.load("silicone").replace(stream, flow_speed="10 cm/s")
length = arm.length

# %% [markdown]
# ## The shape
#
# A hook: straight from the base, then a bend of 40 mm radius around a pipe. The centreline should lie on it at 24 places.

# %%
bend = 0.040
places = np.linspace(length / 24, length, 24)


def hook(s: Numbers) -> tuple[Numbers, Numbers]:
    """x and y (m) of the hook after the length s (m): straight to 0.4, then a bend that grows to 40 mm radius at 0.6."""
    fine = np.linspace(0.0, length, 4001)
    share = np.clip((fine / length - 0.4) / 0.2, 0.0, 1.0)
    turn = np.concatenate([[0.0], np.cumsum(0.5 * (share[1:] + share[:-1]) / bend * np.diff(fine))])
    step = np.diff(fine)
    middle = 0.5 * (turn[1:] + turn[:-1])
    x = np.concatenate([[0.0], np.cumsum(step * np.cos(middle))])
    y = np.concatenate([[0.0], np.cumsum(step * np.sin(middle))])
    return np.interp(s, fine, x), np.interp(s, fine, y)


target_x, target_y = hook(places)

# %% [markdown]
# ## The design
#
# The design has the left cable's tension, the radius at six points, and the cable's offset there as a fraction of the radius. The right cable
# is its mirror image and slack. Between the points, radius and offset are the smooth tables of the arm file.

# %%
points = np.linspace(0.0, length, 6)
names = (
    ["cable[0].tension"]
    + [f"arm.radius[{k}][1]" for k in range(6)]
    + [f"cable[0].offset[{k}][1]" for k in range(6)]
)
lower = np.array([0.02, *np.full(6, 0.004), *np.full(6, 0.05)])
upper = np.array([1.50, *np.full(6, 0.012), *np.full(6, 0.70)])
# As the shipped arm, but for a tip that is not so thin.
first = np.array([0.15, *np.linspace(0.010, 0.004, 6), *np.full(6, 0.5)])


def table(values: Numbers) -> list[list[float]]:
    return np.stack([points, values], axis=1).tolist()  # type: ignore[no-any-return]


def designed(design: Numbers) -> hs.Arm:
    radius, share = design[1:7], design[7:]
    left, right = table(share * radius), table(-share * radius)
    changes = {"arm.radius": table(radius), "cable[0].offset": left, "cable[1].offset": right}
    return arm.replace(changes, tensions=[design[0], 0.0])


# %% [markdown]
# ## Objective and gradient
#
# The objective is the mean square of the distances, in mm², plus a small penalty for offsets that oscillate. `gradient` takes the derivatives of
# the objective by x and y of the places, and returns those by all parameters.

# %%
MM = 1e-3
WINDING = 0.5


def objective(design: Numbers) -> tuple[float, Numbers]:
    """The objective, and its derivatives by the design."""
    solver = hs.Solver(designed(design), tol=1e-9)
    found = solver.solution().at(places)
    off_x, off_y = (found.x - target_x) / MM, (found.y - target_y) / MM
    winding = np.diff(design[7:], 2)
    count = len(places)
    value = float((off_x @ off_x + off_y @ off_y) / count + WINDING * winding @ winding)

    by = solver.gradient(names, places, x=2 * off_x / (count * MM), y=2 * off_y / (count * MM))
    by_radius, by_offset = by[1:7], by[7:]
    # An offset is its share of the radius.
    radius, share = design[1:7], design[7:]
    out = np.concatenate([by[:1], by_radius + by_offset * share, by_offset * radius])
    for k, turned in enumerate(winding):
        out[7 + k : 10 + k] += 2 * WINDING * turned * np.array([1.0, -2.0, 1.0])
    return value, out


# %% [markdown]
# ## Is the gradient right?
#
# We compare it with central differences at decreasing steps. The difference falls with the square of the step until the rounding of the
# solves dominates; the gradient itself has no step.

# %%
value, exact = objective(first)
scale = upper - lower
steps = np.logspace(-2, -6, 9)
errors = []
for step in steps:
    differences = [
        (objective(first + step * scale * unit)[0] - objective(first - step * scale * unit)[0]) / (2 * step)
        for unit in np.eye(len(first))
    ]
    errors.append(np.abs(np.array(differences) - exact * scale).max() / np.abs(exact * scale).max())
fig, ax = plt.subplots(figsize=(5.6, 3.6), layout="constrained")
ax.loglog(steps, errors, "o-", color="#1f3b57", markersize=4, label="central differences less the adjoint gradient")
ax.loglog(steps, errors[0] * (steps / steps[0]) ** 2, "--", color="0.6", linewidth=1.0, label="square of the step")
ax.set_xlabel("step, over the range of the number")
ax.set_ylabel("largest difference, over the gradient")
ax.set_ylim(1e-10, 10)
ax.legend(frameon=False, fontsize=9)
ax.grid(alpha=0.25)
plt.show()
assert min(errors) < 1e-6

# %% [markdown]
# ## The best tension alone
#
# A fair start: the shipped arm with the tension that fits best.

# %%


def with_others(pull: Numbers) -> tuple[float, Numbers]:
    value, by = objective(np.concatenate([pull, first[1:]]))
    return value, by[:1]


pulled = minimize(with_others, first[:1], jac=True, method="L-BFGS-B", bounds=[(lower[0], upper[0])])
before = np.concatenate([pulled.x, first[1:]])
print(f"{before[0]:.4f} N: {np.sqrt(objective(before)[0]):.2f} mm off, root of the mean square")

# %% [markdown]
# ## All thirteen

# %%
history = [objective(before)[0]]


def note(intermediate_result: OptimizeResult) -> None:
    history.append(float(intermediate_result.fun))


# In twentieths of the ranges: the numbers are alike, and the first step, which is one long, is careful.
unit = scale / 20


def in_units(x: Numbers) -> tuple[float, Numbers]:
    try:
        value, by = objective(lower + x * unit)
    except hs.NoEquilibrium:
        # A step too far: the line search comes back.
        return 1e6, np.zeros_like(x)
    return value, by * unit


result = minimize(
    in_units,
    (before - lower) / unit,
    jac=True,
    method="L-BFGS-B",
    bounds=[(0.0, 20.0)] * len(first),
    callback=note,
    options={"maxiter": 200, "ftol": 1e-9, "gtol": 1e-5},
)
after = lower + result.x * unit
print(f"{len(history) - 1} iterations, {result.nfev} solves with gradients: {result.message}")
print(f"{np.sqrt(history[0]):.2f} mm off before, {np.sqrt(history[-1]):.3f} mm after")
assert history[-1] < 0.02 * history[0]

# %%
fig, ax = plt.subplots(figsize=(7.6, 5.0), layout="constrained")
turn = np.linspace(0.0, 2 * np.pi, 200)
end_x, end_y = hook(np.linspace(0.0, length, 400))
# The pipe that the hook goes round: the centre of its last bend.
heading = np.arctan2(end_y[-1] - end_y[-2], end_x[-1] - end_x[-2])
centre = np.array([end_x[-1], end_y[-1]]) + bend * np.array([-np.sin(heading), np.cos(heading)])
for design, shade, label in ((before, "#c9d3da", "before"), (after, "#d9734e", "after")):
    shape = designed(design).solve()
    shape.plot(ax, color=shade, sections=0, flow=label == "after", label=f"{label}: {design[0]:.3g} N")
ax.plot(1e3 * end_x, 1e3 * end_y, color="#1b7f5c", linewidth=1.4, linestyle=(0, (5, 2)), zorder=7, label="asked for")
ax.plot(1e3 * target_x, 1e3 * target_y, "o", color="#1b7f5c", markersize=3.5, zorder=8)
inside = bend - 0.0055
ax.fill(*(1e3 * (centre[:, None] + inside * np.stack([np.cos(turn), np.sin(turn)]))), color="0.9", zorder=0)
ax.text(1e3 * centre[0], 1e3 * centre[1], "pipe", ha="center", va="center", color="0.5")
ax.legend(frameon=False, fontsize=9, loc="lower right")
plt.show()

# %% [markdown]
# The course of the search, and its result: thick where the hook is straight, thin where it bends, with a cable that approaches the centreline.

# %%
fig, (left, right) = plt.subplots(1, 2, figsize=(9.6, 3.6), layout="constrained")
left.semilogy(np.sqrt(history), color="#1f3b57", linewidth=1.6)
left.set_xlabel("iteration")
left.set_ylabel("root of the objective (mm)")
left.grid(alpha=0.25)
s = np.linspace(0.0, length, 300)
for design, shade, label in ((before, "0.6", "before"), (after, "#d9734e", "after")):
    straight = designed(design).replace(tensions=[0.0, 0.0], flow_speed=0.0).solve()
    top, bottom = straight.surfaces(s)
    right.fill_between(1e3 * s, 1e3 * bottom[:, 1], 1e3 * top[:, 1], color=shade, alpha=0.25, linewidth=0)
    right.plot(1e3 * s, 1e3 * straight.cable_path(0, s)[:, 1], color=shade, linewidth=1.8, label=f"cable {label}")
right.set_xlabel("s (mm)")
right.set_ylabel("across the straight arm (mm)")
right.legend(frameon=False, fontsize=9, loc="upper right")
right.grid(alpha=0.25)
plt.show()

# %% [markdown]
# The design is for one stream. How does it perform in others? In slower ones it still fits; from 0.15 m/s on, the stream bends the arm the other
# way.

# %%
fig, ax = plt.subplots(figsize=(7.6, 4.6), layout="constrained")
found = designed(after)
for speed in (0.0, 0.05, 0.1, 0.15, 0.2):
    shape = found.solve(flow_speed=speed)
    at = shape.at(places)
    off = np.sqrt(np.mean((at.x - target_x) ** 2 + (at.y - target_y) ** 2)) / MM
    color = plt.colormaps["viridis"](speed / 0.22)
    shape.plot(ax, color=color, sections=0, cables=False, flow=speed == 0.1, label=f"{speed:g} m/s: {off:.1f} mm off")
ax.plot(1e3 * end_x, 1e3 * end_y, color="#1b7f5c", linewidth=1.4, linestyle=(0, (5, 2)), zorder=7)
ax.legend(frameon=False, fontsize=9, loc="lower left")
plt.show()
