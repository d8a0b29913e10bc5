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
# # First steps
#
# A silicone arm of 245 mm with two cables, in water: solve it, look at it, pull too hard, command strokes in place of tensions, and turn it
# against the stream until it snaps.

# %%
import warnings

import matplotlib.pyplot as plt
import numpy as np

import hydrostat as hs

arm = hs.Arm.load("silicone")
arm

# %% [markdown]
# ## One shape
#
# Tensions are in N, speeds in m/s, lengths in m, angles of results in rad.

#
# `sol.warnings` has the warnings about a solution; each is also a Python warning of the class `hs.ModelWarning`. Here the shape depends
# strongly on the tangential load of the source's flow law, which is far above measured values. We have read that, and silence it.

# %%
warnings.filterwarnings("ignore", category=hs.ModelWarning)
sol = arm.solve(tensions=[0.12, 0], flow_speed=0.05)
print(sol)
for cable in sol.cables:
    print(f"{cable.name:>5}: {cable.tension:.2f} N, reeled in by {1e3 * cable.stroke:+.2f} mm")
print("base reaction", sol.base_reaction)
print("stable:", sol.stable, " error of the tip:", sol.error_estimate, "m")

# %%
sol.plot()
plt.show()

# %% [markdown]
# The fields along the arm are NumPy arrays that share the solution's memory; `to_xarray` and `to_pandas` convert them.

# %%
sol.to_xarray()

# %% [markdown]
# ## More tension
#
# The same arm under six tensions. The tip curls first: it is the thinnest.

# %%
fig, ax = plt.subplots(figsize=(7.2, 4.6), layout="constrained")
colors = plt.colormaps["viridis"](np.linspace(0.05, 0.9, 6))
for pull, color in zip([0.0, 0.04, 0.08, 0.12, 0.18, 0.25], colors, strict=True):
    shape = arm.solve(tensions=[pull, 0], flow_speed=0.05)
    shape.plot(ax, color=color, sections=0, cables=False, flow=pull == 0.0, label=f"{pull:.2f} N")
ax.legend(frameon=False, ncols=2, loc="lower left")
plt.show()

# %%
strains = None
for pull in [0.04, 0.08, 0.12]:
    strains = arm.solve(tensions=[pull, 0], flow_speed=0.05).plot_strains(label=f"{pull:.2f} N", figure=strains)
plt.show()

# %% [markdown]
# ## Too much tension
#
# Not every arm has an equilibrium. The exception says which limit was met, at which fraction of the loads and where. It also has the last
# good shape.

# %%
try:
    arm.solve(tensions=[1.5, 0])
except hs.NoEquilibrium as no:
    print(f"{no.kind} at s = {1e3 * (no.where or 0):.0f} mm, at {no.load_fraction:.4f} of the tensions")
    print("try:", no.advice)
    last_good = no.last_good
assert last_good is not None
print(f"the left cable carried {last_good.cables[0].tension:.4f} N")
last_good.plot(sections=60)
plt.show()

# %% [markdown]
# ## Strokes in place of tensions
#
# A motor commands the stroke of a cable, that is, how far it is reeled in; the tension follows. A cable that would have to push is slack.

# %%
strokes = np.linspace(0.0, 0.02, 9)
shapes = [arm.solve(strokes=[stroke, -stroke]) for stroke in strokes]
fig, (left, right) = plt.subplots(1, 2, figsize=(8.4, 3.4), layout="constrained")
for name, index in (("left", 0), ("right", 1)):
    left.plot(1e3 * strokes, [shape.cables[index].tension for shape in shapes], "o-", label=name, markersize=4)
left.set_xlabel("left reeled in, right paid out (mm)")
left.set_ylabel("tension (N)")
left.legend(frameon=False)
left.grid(alpha=0.25)
shapes[-1].plot(right)
plt.show()

# %% [markdown]
# ## Inverse kinematics
#
# Which tensions bring the tip to a target? `reach` finds them, within bounds. Near a shape, exact derivatives give the effect of each cable.
# The ellipse encloses all displacements of the tip that a change of the two tensions of the given size can cause.

# %%
reached = arm.reach((0.19, 0.07), max_tension=0.6)
print(reached[0], "stable" if reached[0].stability == "stable" else "")
fig, (left, right) = plt.subplots(1, 2, figsize=(9.6, 3.8), layout="constrained")
reached.plot(left)
at = arm.replace(tensions=reached[0].tensions.tolist()).sensitivities(["cable[0].tension", "cable[1].tension", "flow.speed"])
at.plot_manipulability(right)
plt.show()
at.to_xarray()

# %% [markdown]
# ## Snapping
#
# The stream comes towards the base. The base is turned, so that the arm passes from one side of the stream to the other. At a limit point the
# path turns back: the arm snaps.

# %%
facing = arm.replace(flow_speed=0.2, flow_direction=180)
path = facing.path("arm.base.angle", 90, -90)
print(path, [f"{event.name} at {event.value:.2f} deg" for event in path.branches[0].events])
path.plot("tip_y")
plt.show()

# %% [markdown]
# At zero degrees five shapes are in equilibrium, three of them stable.

# %%
found = facing.equilibria()
print(found)
found.plot()
plt.show()

# %% [markdown]
# The library also has its own figures, as SVG, PDF and PNG.

# %%
hs.arm_figure(sol)
