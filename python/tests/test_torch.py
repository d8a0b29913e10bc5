"""Solves as functions of PyTorch; without it these are skipped."""

from __future__ import annotations

import numpy as np
import pytest

import hydrostat as hs

torch = pytest.importorskip("torch", minversion="2.0")
KEYS = ["cable[0].tension", "cable[1].tension", "material.young", "flow.direction"]
VALUES = [0.2, 0.05, 110e3, 20.0]


@pytest.fixture(scope="module")
def drifting(silicone: hs.Arm) -> hs.Arm:
    return silicone.replace({"flow.law": "quadratic-drag"}, flow_speed=0.1)


def test_values_and_derivatives(drifting: hs.Arm) -> None:
    from hydrostat.torch import function

    f = function(drifting, KEYS, tol=1e-10)
    x = torch.tensor(VALUES, dtype=torch.float64)
    arm = drifting.replace({"material.young": VALUES[2], "flow.direction": VALUES[3]}, tensions=VALUES[:2])
    shape = arm.solve(tol=1e-10)
    want = [*shape.tip, *(cable.stroke for cable in shape.cables)]
    assert np.allclose(f(x), want, rtol=0, atol=1e-9)
    found = arm.sensitivities(KEYS, tol=1e-10)
    jacobian = np.concatenate([np.stack(found.tip), found.strokes])
    jacobian[:, 3] *= np.pi / 180.0
    size = np.abs(jacobian).max(axis=0)
    for way in (torch.func.jacfwd, torch.func.jacrev, lambda f: lambda x: torch.autograd.functional.jacobian(f, x)):
        assert np.allclose(way(f)(x), jacobian, rtol=1e-5, atol=1e-9 * size)
    x.requires_grad_()
    with torch.no_grad():
        assert not f(x).requires_grad
    f(x)[1].backward()
    assert np.allclose(x.grad, jacobian[1], rtol=1e-5, atol=1e-9 * size)
    # Against differences, to the second order.
    step = torch.tensor([1e-4, 0.0, 0.0, 0.0], dtype=torch.float64)
    with torch.no_grad():
        slope = (f(x + step) - f(x - step)) / 2e-4
    assert np.allclose(torch.func.jvp(f, (x.detach(),), (step / 1e-4,))[1], slope, rtol=1e-4, atol=1e-7)
    for way in (torch.func.hessian, lambda f: torch.func.jacrev(torch.func.jacrev(f))):
        assert torch.isnan(way(lambda x: f(x)[0])(x.detach())).any()
    half = f(torch.tensor(VALUES, dtype=torch.float32))
    assert half.dtype == torch.float32 and np.allclose(half, want, rtol=1e-5, atol=1e-6)


def test_batches_are_mapped(drifting: hs.Arm) -> None:
    from hydrostat.torch import function

    f = function(drifting, KEYS)
    x = torch.tensor([VALUES, [0.1, 0.0, 1e5, 0.0], [-0.1, 0.0, 1e5, 0.0], [1.4, 0.0, 1e5, 0.0]], dtype=torch.float64)
    rows = f(x)
    assert rows.shape == (4, 6) and torch.isnan(rows[2:]).all() and not torch.isnan(rows[:2]).any()
    assert torch.allclose(torch.func.vmap(f)(x), rows, rtol=0, atol=1e-9, equal_nan=True)
    slopes = torch.func.vmap(torch.func.jacrev(f))(x[:2])
    assert slopes.shape == (2, 6, 4) and torch.allclose(slopes[0], torch.func.jacfwd(f)(x[0]), rtol=1e-6, atol=1e-12)
    with pytest.raises(ValueError, match=r"^values: expected the shape \(..., 4\)"):
        f(x[0, :3])
    with pytest.raises(ValueError, match="flow.sped"):
        function(drifting, ["flow.sped"])


def test_a_design_descends(silicone: hs.Arm) -> None:
    """The tensions that bring the tip to a place, by an optimiser that sees the solves alone."""
    from hydrostat.torch import function

    keys = ["cable[0].tension", "cable[1].tension"]
    f = function(silicone, keys, tol=1e-8)
    goal = f(torch.tensor([0.22, 0.04], dtype=torch.float64))[:2] / silicone.length
    # Their logarithms, so that none is below zero.
    pulls = torch.tensor([0.1, 0.1], dtype=torch.float64).log().requires_grad_()
    optimiser = torch.optim.Adam([pulls], lr=0.05)
    losses = []
    for _ in range(80):
        optimiser.zero_grad()
        loss = ((f(pulls.exp())[:2] / silicone.length - goal) ** 2).sum()
        loss.backward()
        optimiser.step()
        losses.append(loss.item())
    assert losses[-1] < 1e-2 * losses[0], losses
