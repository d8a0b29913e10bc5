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
# # Snaps, hysteresis and motion
#
# The silicone arm of Renda and others, with the viscosity that they give for it: 300 Pa s over 110 kPa, a relaxation time of 2.7 ms.

# %%
import math

import matplotlib.pyplot as plt
import numpy as np

import hydrostat as hs

arm = hs.Arm.load("silicone").replace({"dynamics.relaxation_time": "2.7 ms", "flow.law": "quadratic-drag", "flow.cn": 2.5, "flow.ct": 0.005})

# %% [markdown]
# ## Up and down
#
# The base is turned against a stream and back. Each shape is the equilibrium reached from the one before; where that ends in a limit
# point the arm snaps, and its motion says where to. The answer depends on the way.

# %%
against = arm.replace(flow_speed=0.2, flow_direction=180)
angles = np.concatenate([np.arange(60, -61, -5), np.arange(-55, 61, 5)])
both_ways = hs.history(against, {"arm.base.angle": angles})
for snap in both_ways.snaps:
    print(f"at {snap.loads['arm.base.angle']:.2f} deg the tip jumps by {1e3 * snap.distance:.0f} mm, and rests after {snap.duration:.0f} s")
both_ways.figure("tip.y", title="The base turned to and fro")

# %% [markdown]
# ## In motion
#
# The left cable pulls smoothly, and lets go at 0.4 s by a jump: two rows at one time.

# %%
times = np.linspace(0.0, 0.4, 41)
pull = 0.1 * (1.0 - np.cos(math.pi * times / 0.4))
rows = np.concatenate([np.stack([times, pull], axis=1), [[0.4, 0.0]]])
motion = hs.simulate(arm, {"cable[0].tension": rows}, until=2.0, every=0.01, tol=1e-3)
strobe, over_time = hs.motion_figures(motion, title="Pulled and let go")
strobe

# %%
over_time

# %% [markdown]
# ## A control loop
#
# Every 20 ms a controller reads the tip and sets two tensions, which the cables reach along straight lines. It should hold the tip at
# y = 40 mm, and from 2 s on at -20 mm.

# %%
sim = hs.Simulation(arm, tol=1e-3)
effort, seen = 0.0, []
for step in range(200):
    at = sim.now()
    wanted = 0.04 if at.time < 2.0 else -0.02
    effort = float(np.clip(effort + 0.06 * (wanted - at.tip_y) - 0.02 * at.tip_vy, -0.3, 0.3))
    at = sim.step(0.02, tensions=[max(effort, 0.0), max(-effort, 0.0)])
    seen.append((at.time, 1e3 * at.tip_y, 1e3 * wanted))
course = np.array(seen)

figure, ax = plt.subplots(figsize=(6.4, 3.0), layout="constrained")
ax.plot(course[:, 0], course[:, 1], label="tip")
ax.plot(course[:, 0], course[:, 2], "--", label="wanted")
ax.set_xlabel("time (s)")
ax.set_ylabel("y (mm)")
_ = ax.legend()
