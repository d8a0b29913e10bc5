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
# # Readings of the source
#
# The source leaves several things open (section 9 of `docs/model.md`). Each reading is one option. What does each change for the arm of the
# source's figure?

# %%
import warnings

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd

import hydrostat as hs

# This notebook shows how much depends on the tangential load, about which each of these solves warns.
warnings.filterwarnings("ignore", category=hs.ModelWarning)

arm = hs.Arm.load("paper").replace(tensions=[40, 0], flow_speed=0.5)
base = arm.solve()
base

# %% [markdown]
# ## One option at a time
#
# How far the tip moves, over the length, when one reading is replaced. The arm has no gravity: `displaced` and `hydrostatics` change nothing here. Readings in which the
# load jumps may have no solution; the verdict says so.

# %%
alternatives: dict[str, list[str]] = {
    "volume": ["circular", "none"],
    "flow_surface": ["lateral"],
    "entering_speed": ["resultant"],
    "layer_mean": ["momentum"],
    "wetted_length": ["deformed"],
    "displaced": ["section"],
    "hydrostatics": ["normal-only"],
    "support": ["unstrained-base"],
    "closure": ["literal"],
}
rows: list[tuple[str, float, float, float, str]] = []
shapes: dict[str, hs.Solution] = {}
for option, words in alternatives.items():
    for word in words:
        try:
            shape = arm.replace({f"model.{option}": word}).solve()
        except hs.NoEquilibrium as no:
            rows.append((f"{option} = {word}", np.nan, np.nan, np.nan, no.kind))
            continue
        moved = np.hypot(shape.tip.x - base.tip.x, shape.tip.y - base.tip.y) / arm.length
        turned = np.degrees(shape.tip.theta - base.tip.theta)
        rows.append((f"{option} = {word}", float(moved), float(turned), float(np.degrees(shape.tip.alpha)), ""))
        shapes[f"{option} = {word}"] = shape
columns = ["reading", "tip moves / L", "turns by (deg)", "alpha(L) (deg)", "verdict"]
table = pd.DataFrame(rows, columns=columns).set_index("reading")
table

# %%
shown = table["tip moves / L"].clip(lower=1e-6).fillna(1e-6)
fig, ax = plt.subplots(figsize=(7.2, 3.6), layout="constrained")
places = np.arange(len(table))
ax.barh(places, shown, left=0, color="#1f3b57", height=0.6)
ax.set_yticks(places, list(table.index))
for place, row in enumerate(rows):
    moved, verdict = row[1], row[4]
    text = verdict.replace("_", " ") if verdict else ("nothing" if moved < 1e-6 else f"{moved:.2g}")
    ax.text(max(float(np.nan_to_num(moved)), 1e-6) * 1.25, place, text, va="center", size=9)
ax.set_xscale("log")
ax.set_xlim(1e-6, 8)
ax.invert_yaxis()
ax.set_xlabel("how far the tip moves, over the length")
ax.spines[["top", "right"]].set_visible(False)
plt.show()

# %% [markdown]
# ## How the section swells
#
# The three volume laws at the same tension. `planar` spreads most where it is compressed, so that its area, and with it its stiffness, grows as the
# stretch falls.

# %%
fig, ax = plt.subplots(figsize=(7.4, 4.4), layout="constrained")
laws = {"planar": "#d9734e", "circular": "#4a90b8", "none": "#7aa874"}
for word, color in laws.items():
    try:
        shape = arm.replace({"model.volume": word}, tensions=[20, 0]).solve()
    except hs.NoEquilibrium as no:
        print(f"{word}: {no.kind} at {20 * no.load_fraction:.2f} N; its last good shape is drawn")
        assert no.last_good is not None
        shape = no.last_good
    pull = shape.cables[0].tension
    shape.plot(ax, color=color, sections=12, flow=False, label=f"{word}, {pull:.3g} N")
ax.legend(frameon=False, loc="upper left")
plt.show()

# %%
strains = None
for word in laws:
    try:
        shape = arm.replace({"model.volume": word}, tensions=[3, 0]).solve()
    except hs.NoEquilibrium as no:
        print(f"{word} has no equilibrium at 3 N: {no.kind}")
        continue
    strains = shape.plot_strains(label=f"{word}, 3 N", figure=strains)
plt.show()

# %% [markdown]
# ## The support
#
# `unstrained-base` reads the source's closing line as conditions on the solution and integrates to the tip, whose balance is then unmet. At a
# clamped base the arm bends more with more pull and less in a faster stream, as the source's figure shows; without flow the other reading does not bend
# at all.

# %%
fig, axes = plt.subplots(1, 2, figsize=(9.6, 3.8), layout="constrained", sharey=True)
for ax, support in zip(axes, ("clamped", "unstrained-base"), strict=True):
    for speed in (0.0, 0.5, 1.0, 2.0):
        shade = plt.colormaps["cividis"](speed / 2.2)
        try:
            shape = arm.replace({"model.support": support}, tensions=[10, 0], flow_speed=speed).solve()
        except hs.NoEquilibrium as no:
            print(f"{support} at {speed:g} m/s: {no.kind}")
            continue
        line = shape.resampled(200)
        ax.plot(1e3 * line.x, 1e3 * line.y, color=shade, linewidth=2.0, label=f"{speed:g} m/s")
        if shape.unmet is not None:
            print(f"{support} at {speed:g} m/s leaves {np.hypot(*shape.unmet.force):.3g} N unmet at the tip")
    ax.set_title(support, loc="left", size=10)
    ax.set_xlabel("x (mm)")
    ax.grid(alpha=0.25)
    ax.legend(frameon=False, fontsize=9)
axes[0].set_ylabel("y (mm)")
plt.show()

# %% [markdown]
# ## Two laws of drag
#
# The source's momentum law corresponds to a tangential coefficient of 4/9; published arms have 0.005 to 0.03. Quadratic drag with coefficients is the
# alternative. A soft arm across a stream shows the difference.

# %%
soft = hs.Arm.load("silicone").replace(flow_direction=90)
laws_of_drag: dict[str, dict[str, object]] = {
    "momentum": {"flow.law": "momentum"},
    "quadratic, C_n 2.5, C_t 0.005": {"flow.law": "quadratic-drag", "flow.cn": 2.5, "flow.ct": 0.005},
    "quadratic, C_n pi, C_t 4/9": {"flow.law": "quadratic-drag", "flow.cn": np.pi, "flow.ct": 4 / 9},
}
speeds = np.linspace(0.0, 0.4, 33)
fig, (left, right) = plt.subplots(1, 2, figsize=(9.6, 4.0), layout="constrained")
for (name, changes), color in zip(laws_of_drag.items(), ("#d9734e", "#1f3b57", "#7aa874"), strict=True):
    many = hs.solve_many(soft.replace(changes), flow_speed=speeds)
    left.plot(speeds, np.degrees(many.tip_theta), color=color, linewidth=1.8, label=name)
    line = soft.replace(changes, flow_speed=0.15).solve().resampled(200)
    right.plot(1e3 * line.x, 1e3 * line.y, color=color, linewidth=2.2)
left.set_xlabel("speed of the stream (m/s)")
left.set_ylabel("the tip's turn (deg)")
left.legend(frameon=False, fontsize=9)
left.grid(alpha=0.25)
right.set_aspect("equal", adjustable="datalim")
right.set_title("centrelines at 0.15 m/s", loc="left", size=10)
right.set_xlabel("x (mm)")
right.set_ylabel("y (mm)")
right.grid(alpha=0.25)
plt.show()

# %% [markdown]
# ## What the source says of its figure
#
# The library remakes the three parts and holds the text against the numbers.

# %%
figures, claims = hs.source_figures(hs.Arm.load("paper"))
for statement, finding, evidence in claims:
    print(f"{finding:>18}: {statement}\n{'':>20}{evidence}")

# %%
figures["fig1c"]
