"""Solves as functions of PyTorch, with exact derivatives, forward and backward, in batches. Needs PyTorch."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from os import PathLike
from typing import Any

import torch
from hydrostat._batch import Batch
from hydrostat.arm import Arm


def function(arm: Arm | str | PathLike[str], keys: Sequence[str], *, tol: float = 1e-8) -> Callable[[torch.Tensor], torch.Tensor]:
    """The shape that `Arm.solve` gives as a function of some of the arm's numbers.

    It can be differentiated once, by ``backward`` and by ``torch.func`` (`grad`, `jacrev`, `jacfwd`, `vmap`); derivatives are those of
    `Solver.sensitivities`, second derivatives are NaN. Solves are in double precision on the processor; the answer has the type and device of the argument.

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
        From tensors of shape (..., p) to tensors of shape (..., 4 + cables): x and y (m), theta and alpha (rad) of the tip, then every
        cable's stroke (m). NaN where there is no equilibrium; derivatives are NaN at limit points.

    Examples
    --------
    >>> import hydrostat.torch, torch
    >>> f = hydrostat.torch.function("silicone", ["cable[0].tension", "material.young"])
    >>> values = torch.tensor([0.2, 110e3], dtype=torch.float64, requires_grad=True)
    >>> f(values)[2].backward()
    >>> bool(values.grad[0] > 0 and values.grad[1] < 0)  # of the tip's rotation, rad/N and rad/Pa
    True
    """
    batch = Batch(arm, keys, tol)
    count = len(batch.keys)

    def of(x: torch.Tensor) -> torch.Tensor:
        x = torch.as_tensor(x)
        if x.ndim == 0 or x.shape[-1] != count:
            raise ValueError(f"values: expected the shape (..., {count}), one a key, found {tuple(x.shape)}")
        x = x if x.is_floating_point() else x.to(torch.get_default_dtype())
        tangent = torch.autograd.forward_ad.unpack_dual(x).tangent
        slopes = tangent is not None or (x.requires_grad and torch.is_grad_enabled())
        found: torch.Tensor = _Solve.apply(x, batch, slopes)[0]
        return found

    return of


class _Solve(torch.autograd.Function):  # type: ignore[misc]
    """Rows and their derivatives; the latter only where they will be asked for."""

    @staticmethod
    def forward(x: torch.Tensor, batch: Batch, slopes: bool) -> tuple[torch.Tensor, torch.Tensor]:
        rows = x.detach().cpu().numpy()
        found, jacobian = batch.differentiated(rows) if slopes else (batch.values(rows), None)
        kept = x.new_zeros(x.shape[:-1]) if jacobian is None else torch.from_numpy(jacobian).to(x)
        return torch.from_numpy(found).to(x), kept

    @staticmethod
    def setup_context(ctx: Any, inputs: tuple[Any, ...], output: tuple[torch.Tensor, torch.Tensor]) -> None:
        ctx.save_for_backward(output[1])
        ctx.save_for_forward(output[1])

    @staticmethod
    def backward(ctx: Any, slope: torch.Tensor, second: torch.Tensor) -> tuple[torch.Tensor, None, None]:
        (jacobian,) = ctx.saved_tensors
        # What depends on the derivatives' own change is not known.
        unknown = torch.where(second == 0.0, 0.0, torch.nan).sum(-2)
        return torch.einsum("...ij,...i->...j", jacobian, slope) + unknown, None, None

    @staticmethod
    def jvp(ctx: Any, change: torch.Tensor, *_: Any) -> tuple[torch.Tensor, torch.Tensor]:
        (jacobian,) = ctx.saved_tensors
        return torch.einsum("...ij,...j->...i", jacobian, change), torch.full_like(jacobian, torch.nan)

    @staticmethod
    def vmap(info: Any, dims: tuple[int | None, ...], x: torch.Tensor, batch: Batch, slopes: bool) -> Any:
        # The rows of all are one batch.
        return _Solve.apply(x if dims[0] is None else x.movedim(dims[0], 0), batch, slopes), (0, 0)
