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

# %% [markdown]
# # A policy that follows a target
#
# `hydrostat.gym.ReachEnv` is an environment of Gymnasium: the tip has to follow a target that moves in a stream of unknown speed, and each
# action changes the tensions by at most a tenth of the most. Here a small policy learns it by the cross-entropy method, in NumPy alone, in about
# half a minute of processor time. It is a baseline to beat, no controller: what it reaches stands beside what pulling nothing, pulling at random, and a controller that
# knows the arm reach. Needs Gymnasium and SciPy.

# %%
import matplotlib.pyplot as plt
import numpy as np
from numpy.typing import NDArray
from scipy.optimize import lsq_linear

import hydrostat as hs
from hydrostat.gym import ReachEnv

Numbers = NDArray[np.float64]

steps, most = 60, 0.3  # N
env = ReachEnv("silicone", max_tension=most, flow_speed=(0.0, "2 cm/s"), steps=steps, period=steps)
cables = env.action_space.shape[0]

# %% [markdown]
# ## The policy
#
# The change of the tensions is linear in what the tip misses its target by, in how the target moves, in the tensions, and in one, and
# cut off at the bounds: 14 numbers for two cables. It knows nothing of the arm.


# %%
def seen(observation: Numbers) -> Numbers:
    """Tip to target, its motion, tensions and one, of an observation."""
    tip, target, change, tensions = observation[:2], observation[4:6], observation[6:8], observation[8:]
    return np.concatenate([5.0 * (target - tip), 20.0 * change, tensions, [1.0]])


size = cables * len(seen(np.zeros(8 + cables)))


def act(weights: Numbers, observation: Numbers) -> Numbers:
    """The change of every tension, from -1 to 1."""
    return np.clip(weights.reshape(cables, -1) @ seen(observation), -1.0, 1.0)


def missed(weights: Numbers | None, seed: int, random: np.random.Generator | None = None) -> Numbers:
    """How far the tip is from the target at each step of an episode, over the length; without weights at random, or nothing is pulled."""
    observation, _ = env.reset(seed=seed)
    out = []
    for _ in range(steps):
        pull = np.zeros(cables) if random is None else random.uniform(-1.0, 1.0, cables)
        observation, _, ended, _, about = env.step(pull if weights is None else act(weights, observation))
        out.append(about["distance"])
        if ended:
            # An arm that folds misses by five lengths from then on.
            out += [5.0] * (steps - len(out))
            break
    return np.array(out)


# %% [markdown]
# ## Learning
#
# Each round draws 24 policies around the best so far, tries all of them on the same two episodes, and moves to the best six. Episodes are new in
# every round.

# %%
draws = np.random.default_rng(1)
middle, width = np.zeros(size), np.full(size, 1.0)
history = []
for generation in range(14):
    drawn = middle + width * draws.standard_normal((24, size))
    episodes = [2 * generation, 2 * generation + 1]
    costs = np.array([np.mean([missed(weights, seed).mean() for seed in episodes]) for weights in drawn])
    best = drawn[np.argsort(costs)[:6]]
    middle, width = best.mean(axis=0), best.std(axis=0) + 0.05
    history.append((float(costs.min()), float(np.median(costs))))

# %% [markdown]
# ## What it reaches
#
# Twelve episodes that it has not seen, with streams and courses of their own. The first ten steps, in which every policy still goes to the target from
# slack cables, count for all alike. The controller that knows the arm takes its Jacobian (`Arm.sensitivities`, in still water) and goes to the next place of the
# target by least squares within the bounds.


# %%
def knowing(seed: int) -> Numbers:
    """The same of the controller that knows the arm, but not the stream."""
    observation, _ = env.reset(seed=seed)
    arm = hs.Arm.load("silicone")
    keys = [f"cable[{k}].tension" for k in range(cables)]
    out = []
    for _ in range(steps):
        tip, target, change, tensions = observation[:2], observation[4:6], observation[6:8], observation[8:]
        slopes = arm.replace(tensions=(most * tensions).tolist()).sensitivities(keys, tol=1e-6).jacobian(["tip.x", "tip.y"])
        rate = 0.1 * most
        bounds = (np.maximum(-rate, -most * tensions), np.minimum(rate, most * (1.0 - tensions)) + 1e-9)
        wanted = lsq_linear(slopes / arm.length, target + change - tip, bounds).x
        observation, _, _, _, about = env.step(wanted / rate)
        out.append(about["distance"])
    return np.array(out)


unseen = range(1000, 1012)
rows = {
    "nothing is pulled": [missed(None, seed) for seed in unseen],
    "pulled at random": [missed(None, seed, draws) for seed in unseen],
    "learned": [missed(middle, seed) for seed in unseen],
    "knows the arm": [knowing(seed) for seed in unseen],
}
for name, found in rows.items():
    later = 100 * np.array(found)[:, 10:]
    print(f"{name:18}: off by {later.mean():5.1f} % of the length on average, {later.mean(axis=1).max():5.1f} % in the worst episode")

# %%
figure, (learning, following) = plt.subplots(1, 2, figsize=(9.6, 3.6), layout="constrained")
learning.plot(100 * np.array(history), label=["best", "median"])
learning.set_xlabel("round")
learning.set_ylabel("off the target (% of the length)")
learning.set_yscale("log")
learning.legend(frameon=False)
for name, found in rows.items():
    following.plot(100 * np.mean(found, axis=0), label=name)
following.set_xlabel("step")
following.set_yscale("log")
following.legend(frameon=False)
plt.show()
