"""Solves as functions of JAX; without it these are skipped."""

from __future__ import annotations

import numpy as np
import pytest

import hydrostat as hs

jax = pytest.importorskip("jax")
jnp = jax.numpy
KEYS = ["cable[0].tension", "cable[1].tension", "material.young", "flow.direction"]
VALUES = [0.2, 0.05, 110e3, 20.0]


@pytest.fixture(scope="module", autouse=True)
def _double() -> None:
    jax.config.update("jax_enable_x64", True)


@pytest.fixture(scope="module")
def drifting(silicone: hs.Arm) -> hs.Arm:
    return silicone.replace({"flow.law": "quadratic-drag"}, flow_speed=0.1)


def test_values_and_derivatives(drifting: hs.Arm) -> None:
    from hydrostat.jax import function

    f = function(drifting, KEYS, tol=1e-10)
    x = jnp.array(VALUES)
    arm = drifting.replace({"material.young": VALUES[2], "flow.direction": VALUES[3]}, tensions=VALUES[:2])
    shape = arm.solve(tol=1e-10)
    want = [*shape.tip, *(cable.stroke for cable in shape.cables)]
    assert np.allclose(jax.jit(f)(x), want, rtol=0, atol=1e-9)
    found = arm.sensitivities(KEYS, tol=1e-10)
    jacobian = np.concatenate([np.stack(found.tip), found.strokes])
    jacobian[:, 3] *= np.pi / 180.0
    for way in (jax.jacfwd, jax.jacrev):
        assert np.allclose(way(f)(x), jacobian, rtol=1e-5, atol=1e-9 * np.abs(jacobian).max(axis=0))
    # Against differences, to the second order.
    step = jnp.array([1e-4, 0.0, 0.0, 0.0])
    slope = (f(x + step) - f(x - step)) / 2e-4
    assert np.allclose(jax.jvp(f, (x,), (step / 1e-4,))[1], slope, rtol=1e-4, atol=1e-7)


def test_batches_are_mapped(drifting: hs.Arm) -> None:
    from hydrostat.jax import function

    f = function(drifting, KEYS)
    x = jnp.array([VALUES, [0.1, 0.0, 1e5, 0.0], [-0.1, 0.0, 1e5, 0.0], [1.4, 0.0, 1e5, 0.0]])
    rows = f(x)
    assert rows.shape == (4, 6) and np.isnan(rows[2:]).all() and not np.isnan(rows[:2]).any()
    assert np.allclose(jax.vmap(f)(x), rows, rtol=0, atol=1e-9, equal_nan=True)
    slopes = jax.vmap(jax.jacrev(f))(x[:2])
    assert slopes.shape == (2, 6, 4) and np.allclose(slopes[0], jax.jacfwd(f)(x[0]), rtol=1e-6, atol=1e-12)
    with pytest.raises(ValueError, match=r"^values: expected the shape \(..., 4\)"):
        f(x[0, :3])
    with pytest.raises(ValueError, match="flow.sped"):
        function(drifting, ["flow.sped"])
    with pytest.raises(ValueError, match="^keys: expected different"):
        function(drifting, [])


def test_a_network_learns_to_pull(silicone: hs.Arm) -> None:
    """From where the tip is to be to what pulls it there, by descent through the solves alone."""
    from hydrostat.jax import function

    f = function(silicone, ["cable[0].tension", "cable[1].tension"], tol=1e-6)
    random = np.random.default_rng(4)
    pulls = random.uniform(0.05, 0.25, (24, 2))
    goals = f(jnp.array(pulls))[:, :2] / silicone.length
    keys = jax.random.split(jax.random.key(0), 2)
    weights = [0.5 * jax.random.normal(keys[0], (2, 12)), jnp.zeros(12), 0.1 * jax.random.normal(keys[1], (12, 2)), jnp.zeros(2)]

    def pulled(weights: list, goals: object) -> object:  # type: ignore[type-arg]
        inner = jnp.tanh((goals - 0.5) @ weights[0] + weights[1])  # type: ignore[operator]
        return 0.3 * jax.nn.sigmoid(inner @ weights[2] + weights[3])

    def loss(weights: list) -> object:  # type: ignore[type-arg]
        off = f(pulled(weights, goals))[:, :2] / silicone.length - goals
        return jnp.mean(jnp.sum(off**2, axis=1))

    step = jax.value_and_grad(loss)
    moments = [(jnp.zeros_like(w), jnp.zeros_like(w)) for w in weights]
    losses = []
    for k in range(1, 61):
        value, slopes = step(weights)
        losses.append(float(value))
        # Adam.
        moments = [(0.9 * m + 0.1 * g, 0.99 * v + 0.01 * g**2) for (m, v), g in zip(moments, slopes, strict=True)]
        rates = [m / (1 - 0.9**k) / (jnp.sqrt(v / (1 - 0.99**k)) + 1e-9) for m, v in moments]
        weights = [w - 0.05 * rate for w, rate in zip(weights, rates, strict=True)]
    assert losses[-1] < 0.05 * losses[0], losses
