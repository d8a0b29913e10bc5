"""Solves as functions of JAX, with exact derivatives, forward and backward, in batches. Needs JAX."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from os import PathLike
from typing import Any

import numpy as np
from numpy.typing import NDArray

import jax
import jax.numpy as jnp
from hydrostat._batch import Batch
from hydrostat.arm import Arm


def function(arm: Arm | str | PathLike[str], keys: Sequence[str], *, tol: float = 1e-8) -> Callable[[jax.Array], jax.Array]:
    """The shape that `Arm.solve` gives as a function of some of the arm's numbers.

    It can be differentiated (`jax.grad`, `jax.jacfwd`, `jax.jacrev`; once, not twice), compiled and mapped; derivatives are those of
    `Solver.sensitivities`. JAX computes in single precision unless ``jax.config.update("jax_enable_x64", True)``.

    Parameters
    ----------
    arm : Arm, str or path
        The arm, or the name or file of one.
    keys : sequence of str
        The keys of the p numbers, as in `solve_many`, in SI units, angles in degrees.
    tol : float
        Tolerance on the tip position, relative to the arm's length, in [1e-12, 1e-2].

    Returns
    -------
    callable
        From arrays of shape (..., p) to arrays of shape (..., 4 + cables): x and y (m), theta and alpha (rad) of the tip, then every
        cable's stroke (m). NaN where there is no equilibrium; derivatives are NaN at limit points.

    Examples
    --------
    >>> import hydrostat.jax, jax
    >>> jax.config.update("jax_enable_x64", True)
    >>> f = hydrostat.jax.function("silicone", ["cable[0].tension", "material.young"])
    >>> values = jax.numpy.array([0.2, 110e3])
    >>> turned = jax.grad(lambda v: f(v)[2])(values)  # rad/N, rad/Pa
    >>> bool(turned[0] > 0 and turned[1] < 0)
    True
    """
    batch = Batch(arm, keys, tol)
    count, size = len(batch.keys), batch.size

    def shape(x: jax.Array, *more: int) -> jax.ShapeDtypeStruct:
        if x.ndim == 0 or x.shape[-1] != count:
            raise ValueError(f"values: expected the shape (..., {count}), one a key, found {x.shape}")
        return jax.ShapeDtypeStruct((*x.shape[:-1], size, *more), x.dtype)

    def values(x: Any) -> NDArray[Any]:
        return batch.values(np.asarray(x)).astype(x.dtype)

    def both(x: Any) -> tuple[NDArray[Any], NDArray[Any]]:
        found, jacobian = batch.differentiated(np.asarray(x))
        return found.astype(x.dtype), jacobian.astype(x.dtype)

    def plain(x: jax.Array) -> jax.Array:
        found: jax.Array = jax.pure_callback(values, shape(x), x, vmap_method="broadcast_all")
        return found

    def slope(primals: tuple[jax.Array], tangents: tuple[jax.Array]) -> tuple[jax.Array, jax.Array]:
        (x,), (change,) = primals, tangents
        found, jacobian = jax.pure_callback(both, (shape(x), shape(x, count)), x, vmap_method="broadcast_all")
        return found, jnp.einsum("...ij,...j->...i", jacobian, change)

    solve = jax.custom_jvp(plain)
    solve.defjvp(slope)

    def of(x: jax.Array) -> jax.Array:
        x = jnp.asarray(x)
        out: jax.Array = solve(x if jnp.issubdtype(x.dtype, jnp.floating) else x.astype(float))
        return out

    return of
