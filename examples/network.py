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
# # A network that pulls, trained through the solves
#
# `hydrostat.jax.function` makes the shape a function of JAX with exact derivatives, so that what stands before it can be trained: here a small
# network that is asked for a place of the tip and answers with tensions. No pairs of tensions and places are given; the loss is how far the solved tip is from the
# place, and its gradient goes through the solves. Needs JAX.

# %%
from typing import Any

import jax
import jax.numpy as jnp
import matplotlib.pyplot as plt
import numpy as np

import hydrostat as hs
import hydrostat.jax

Layers = list[tuple[Any, Any]]

jax.config.update("jax_enable_x64", True)
arm = hs.Arm.load("silicone")
most = 0.3  # N
solved = hydrostat.jax.function(arm, ["cable[0].tension", "cable[1].tension"], tol=1e-6)

# %% [markdown]
# ## Places to reach
#
# Tips of random tensions, so that every place can be reached: 48 to learn from, and 200 that the network never sees.

# %%
random = np.random.default_rng(2)


def places(count: int) -> Any:
    """Places of the tip over the length, shape (count, 2)."""
    pulls = random.uniform(0.02, 0.9, (count, 2)) * most
    return jnp.asarray(solved(jnp.asarray(pulls))[:, :2] / arm.length)


learned, unseen = places(48), places(200)

# %% [markdown]
# ## The network
#
# Two layers of 24, and tensions between zero and the most. Adam goes 150 steps downhill; each is 48 solves with their derivatives.

# %%
keys = jax.random.split(jax.random.key(0), 3)
sizes = (2, 24, 24, 2)
weights: Layers = [
    (jax.random.normal(key, (before, after)) / np.sqrt(before), jnp.zeros(after))
    for key, before, after in zip(keys, sizes[:-1], sizes[1:], strict=True)
]
middle, width = learned.mean(axis=0), learned.std(axis=0)


def pulled(weights: Layers, goals: Any) -> Any:
    """Tensions for places, N."""
    values = (goals - middle) / width
    for matrix, shift in weights[:-1]:
        values = jnp.tanh(values @ matrix + shift)
    matrix, shift = weights[-1]
    return most * jax.nn.sigmoid(values @ matrix + shift)


def off(weights: Layers, goals: Any) -> Any:
    """How far the tip is from the places, over the length."""
    return jnp.linalg.norm(solved(pulled(weights, goals))[:, :2] / arm.length - goals, axis=1)


def loss(weights: Layers) -> Any:
    """The mean square of that."""
    return jnp.mean(off(weights, learned) ** 2)


slope = jax.jit(jax.value_and_grad(loss))
tree = jax.tree_util.tree_map
first, second = tree(jnp.zeros_like, weights), tree(jnp.zeros_like, weights)
before = np.asarray(off(weights, unseen))
losses = []
for step in range(1, 151):
    value, change = slope(weights)
    losses.append(float(value))
    first = tree(lambda m, g: 0.9 * m + 0.1 * g, first, change)
    second = tree(lambda v, g: 0.999 * v + 0.001 * g**2, second, change)
    rate = 0.03 * min(1.0, (151 - step) / 75)
    weights = tree(
        lambda w, m, v, k=step, r=rate: w - r * (m / (1 - 0.9**k)) / (jnp.sqrt(v / (1 - 0.999**k)) + 1e-8), weights, first, second
    )

# %% [markdown]
# ## What it has learned
#
# `Arm.reach` solves the same question for one place, exactly, from several starts, and gives the answer of least effort first; the network answers at once, and
# misses by a little, most at the edge of what it has learned from. A solve with its tensions says by how much.

# %%
after = np.asarray(off(weights, unseen))
for name, found in (("before", before), ("after", after)):
    print(f"{name:6}: places that it has not seen are missed by {1e3 * arm.length * np.median(found):.2f} mm in the middle, {1e3 * arm.length * found.max():.2f} mm at worst")
one = unseen[0] * arm.length
exact = arm.reach((float(one[0]), float(one[1])), max_tension=most)[0]
answer = np.asarray(pulled(weights, unseen[:1]))[0]
print("tensions (N):", answer.round(4), "of the network,", exact.tensions.round(4), "of `reach`")

# %%
figure, (learning, space) = plt.subplots(1, 2, figsize=(9.6, 3.8), layout="constrained")
learning.semilogy(100 * np.sqrt(losses))
learning.set_xlabel("step")
learning.set_ylabel("off the place (% of the length, root mean square)")
marks = space.scatter(*(1e3 * arm.length * np.asarray(unseen).T), c=1e3 * arm.length * after, s=14, cmap="viridis")
figure.colorbar(marks, label="off the place (mm)")
arm.solve(tensions=answer).plot(space_axis := plt.subplots(figsize=(6.0, 3.6), layout="constrained")[1], label="of the network")
space_axis.plot(*(1e3 * np.asarray(one)), "+", markersize=12, color="black")
space.set_xlabel("x (mm)")
space.set_ylabel("y (mm)")
plt.show()
