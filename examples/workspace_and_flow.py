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
# # Workspace and stream
#
# Where an arm with two cables can put its tip, what a stream does to that, and where there is no equilibrium.

# %%
import matplotlib.pyplot as plt
import numpy as np

import hydrostat as hs

# Published drag coefficients of such an arm in place of the source's momentum law.
drag = {"flow.law": "quadratic-drag", "flow.cn": 2.5, "flow.ct": 0.005}
arm = hs.Arm.load("silicone").replace(drag)

# %% [markdown]
# ## The workspace in still water
#
# `solve_many` broadcasts like NumPy: here a grid of the two tensions, solved on all processors.

# %%
pulls = np.linspace(0.0, 0.45, 46)
left, right = np.meshgrid(pulls, pulls, indexing="ij")
many = hs.solve_many(arm, tensions=np.stack([left, right], axis=-1), stations=40)
print(many)

fig, ax = plt.subplots(figsize=(6.6, 6.0), layout="constrained")
for k in range(0, 46, 9):
    for i, j in ((k, 0), (0, k)):
        ax.plot(1e3 * many["x"][i, j], 1e3 * many["y"][i, j], color="0.75", linewidth=1.0, zorder=1)
stiff = (left + right).ravel()
dots = ax.scatter(1e3 * many.tip_x.ravel(), 1e3 * many.tip_y.ravel(), c=stiff, s=9, cmap="plasma", zorder=2)
fig.colorbar(dots, label="sum of the tensions (N)", shrink=0.8)
ax.set_aspect("equal")
ax.set_xlabel("x of the tip (mm)")
ax.set_ylabel("y of the tip (mm)")
ax.set_title("two cables, still water", loc="left")
plt.show()

# %% [markdown]
# ## Pull against stream
#
# A sweep varies any keys of the arm file and gives an xarray dataset with these as coordinates. Where a row has no equilibrium, its verdict
# says why: above 0.94 N the cable folds the tip shut.

# %%
ds = hs.sweep(arm, {"flow.speed": "0:0.5:21", "cable[0].tension": "0:1:26"})
fig, (map_ax, curves) = plt.subplots(1, 2, figsize=(11.4, 4.0), width_ratios=(1.0, 1.5), layout="constrained")
turned = np.degrees(ds.tip_theta)
filled = map_ax.contourf(
    ds.cable_0_tension, ds.flow_speed, np.ma.masked_invalid(turned.values), levels=20, cmap="cividis"
)
map_ax.set_facecolor("#e9e4da")
map_ax.text(0.98, 0.25, "folded", rotation=90, ha="center", va="center", color="#7a4b2a")
fig.colorbar(filled, ax=map_ax, label="the tip's turn (deg)")
map_ax.set_xlabel("tension of the left cable (N)")
map_ax.set_ylabel("speed of the stream (m/s)")
for speed in (0.0, 0.1, 0.2, 0.3, 0.5):
    row = ds.sel(flow_speed=speed, method="nearest")
    color = plt.colormaps["viridis"](speed / 0.55)
    curves.plot(1e3 * row.tip_x, 1e3 * row.tip_y, "-", color=color, linewidth=1.7, label=f"{speed:g} m/s")
curves.set_aspect("equal")
curves.set_xlabel("x of the tip (mm)")
curves.set_ylabel("y of the tip (mm)")
curves.legend(frameon=False, fontsize=9)
curves.grid(alpha=0.25)
curves.set_title("where the tip goes as the pull rises", loc="left", size=10)
plt.show()
print(ds.verdict.to_series().value_counts())

# %% [markdown]
# ## Streams from both sides
#
# The arm at rest and pulled, in a stream of 0.15 m/s from the base's side. Against streams from the tip's side the arm has several
# equilibria, see the first notebook.

# %%
directions = np.arange(-90.0, 91.0, 30.0)
fig, axes = plt.subplots(1, 2, figsize=(10.0, 4.4), layout="constrained", sharex=True, sharey=True)
for ax, pull in zip(axes, (0.0, 0.1), strict=True):
    for degrees in directions:
        shape = arm.replace(flow_direction=degrees, flow_speed=0.15, tensions=[pull, 0.0]).solve()
        color = plt.colormaps["twilight_shifted"]((degrees + 180.0) / 360.0)
        shape.plot(ax, color=color, sections=0, cables=False, flow=False, label=f"{degrees:+.0f} deg")
    ax.set_title(f"left cable pulled with {pull:g} N", loc="left", size=10)
fig.legend(*axes[1].get_legend_handles_labels(), frameon=False, title="stream towards", loc="outside right center")
plt.show()

# %% [markdown]
# ## What the base has to hold
#
# The drag that the base feels grows with the square of the speed while the arm stands across the stream, and more slowly once it lies down.

# %%
speeds = np.linspace(0.0, 0.5, 26)
across = hs.solve_many(arm, flow_speed=speeds, vary={"flow.direction": 90.0}, fold_margin=True)
held = np.asarray(across["base_force_y"], dtype=float)
fig, ax = plt.subplots(figsize=(6.0, 3.8), layout="constrained")
ax.plot(speeds, -1e3 * held, linewidth=1.8, label="bends and lies down")
stiff_law = held[1] * (speeds / speeds[1]) ** 2
ax.plot(speeds, -1e3 * stiff_law, "--", color="0.5", linewidth=1.2, label="if it stayed straight")
ax.set_ylim(0, 1.15 * float(np.nanmax(-1e3 * held)) * 1.6)
ax.set_xlabel("speed across the arm (m/s)")
ax.set_ylabel("drag on the arm (mN)")
ax.legend(frameon=False)
ax.grid(alpha=0.25)
plt.show()
