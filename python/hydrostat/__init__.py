"""The shape of soft arms under water.

An arm is a Cosserat rod, in a plane or in space: it bends, shears and stretches, and in space it twists. Its section widens under compression, so that the
volume is kept. Cables, a stream, weight and buoyancy act on it.

Results are in SI units and radians. What is given is a number in SI units, an angle in degrees, or what carries a unit: strings, as in the arm
file (``"10 cm/s"``), DataArrays with the attribute ``units``, and Quantities of pint.

>>> import hydrostat as hs
>>> arm = hs.Arm.load("silicone")
>>> sol = arm.solve(tensions=[0.2, 0], flow_speed=0.1)
>>> round(sol.tip.x, 3), round(sol.tip.y, 3)
(0.181, 0.075)
>>> try:
...     arm.solve(tensions=[1.5, 0])
... except hs.NoEquilibriumError as no:
...     print(no.kind, round(no.load_fraction, 4), no.where)
cable_fold 0.6288 0.245
"""

import typing as _typing
from sys import modules as _modules
from types import ModuleType as _ModuleType

from hydrostat._errors import (
    ArmError,
    CableFold,
    CableFoldError,
    LimitPoint,
    LimitPointError,
    LoadJump,
    LoadJumpError,
    MeasurementsError,
    ModelWarning,
    MotionError,
    NoDerivative,
    NoDerivativeError,
    NoEquilibrium,
    NoEquilibriumError,
    NoSectionSolution,
    NoSectionSolutionError,
    NotFound,
    NotFoundError,
    SectionCrushed,
    SectionCrushedError,
)
from hydrostat._native import __version__
from hydrostat._netcdf import load
from hydrostat.arm import Arm, arms
from hydrostat.figures import (
    Figure,
    arm_figure,
    curve_figure,
    equilibria_figure,
    map_figure,
    over_figure,
    path_figure,
    path_shapes_figure,
    source_figures,
    workspace_figure,
)
from hydrostat.history import History, HistorySnap, history
from hydrostat.identification import Estimate, Fit, LeftOut, Miss
from hydrostat.many import Many, solve_many
from hydrostat.modes import Mode, Modes, modes
from hydrostat.motion import (
    Moment,
    MovingShape,
    MovingShapeInSpace,
    Simulation,
    SpatialMoment,
    motion_figures,
    simulate,
)
from hydrostat.paths import Branch, Equilibria, EquilibriumPath, Event, Path
from hydrostat.reach import (
    Bound,
    Boundary,
    BoundaryPiece,
    Followed,
    Follower,
    Reach,
    Reached,
    SpatialTarget,
    Target,
)
from hydrostat.sensitivity import (
    Ellipse,
    Ellipsoid,
    PoseChange,
    Sensitivities,
    SpatialPoseChange,
    SpatialSensitivities,
)
from hydrostat.solution import CableState, Command, FoldMargin, Note, Snap, Solution, Stations, Tip, Wrench, animate
from hydrostat.solver import Answer, Solver
from hydrostat.spatial import SpatialSolution, SpatialStations, SpatialTip, SpatialWrench
from hydrostat.sweep import sweep

__all__ = [
    "Answer",
    "Arm",
    "ArmError",
    "Bound",
    "Boundary",
    "BoundaryPiece",
    "Branch",
    "CableFold",
    "CableFoldError",
    "CableState",
    "Command",
    "Ellipse",
    "Ellipsoid",
    "Equilibria",
    "EquilibriumPath",
    "Estimate",
    "Event",
    "Figure",
    "Fit",
    "FoldMargin",
    "Followed",
    "Follower",
    "History",
    "HistorySnap",
    "LeftOut",
    "LimitPoint",
    "LimitPointError",
    "LoadJump",
    "LoadJumpError",
    "Many",
    "MeasurementsError",
    "Miss",
    "Mode",
    "ModelWarning",
    "Modes",
    "Moment",
    "MotionError",
    "MovingShape",
    "MovingShapeInSpace",
    "NoDerivative",
    "NoDerivativeError",
    "NoEquilibrium",
    "NoEquilibriumError",
    "NoSectionSolution",
    "NoSectionSolutionError",
    "NotFound",
    "NotFoundError",
    "Note",
    "Path",
    "PoseChange",
    "Reach",
    "Reached",
    "SectionCrushed",
    "SectionCrushedError",
    "Sensitivities",
    "Simulation",
    "Snap",
    "Solution",
    "Solver",
    "SpatialMoment",
    "SpatialPoseChange",
    "SpatialSensitivities",
    "SpatialSolution",
    "SpatialStations",
    "SpatialTarget",
    "SpatialTip",
    "SpatialWrench",
    "Stations",
    "Target",
    "Tip",
    "Wrench",
    "__version__",
    "animate",
    "arm_figure",
    "arms",
    "curve_figure",
    "equilibria_figure",
    "history",
    "load",
    "map_figure",
    "modes",
    "motion_figures",
    "over_figure",
    "path_figure",
    "path_shapes_figure",
    "simulate",
    "solve_many",
    "source_figures",
    "sweep",
    "workspace_figure",
]


class _Module(_ModuleType):
    """A module that says what was meant when it is called."""

    def __call__(self, *_: object, **__: object) -> None:
        name = self.__name__.rpartition(".")[2]
        raise TypeError(f"hydrostat.{name} is a module; expected a call of {_MEANT[name]}")


#: What stands for modules of the same name.
_MEANT = {
    "arm": "`hydrostat.Arm(...)` or `hydrostat.Arm.load(...)`",
    "figures": "`hydrostat.arm_figure(...)`, `hydrostat.path_figure(...)` and so on",
    "identification": "`hydrostat.Arm.identify(...)`",
    "many": "`hydrostat.solve_many(...)`",
    "motion": "`hydrostat.simulate(...)` or `hydrostat.Simulation(...)`",
    "paths": "`hydrostat.Arm.path(...)` or `hydrostat.Arm.equilibria(...)`",
    "reach": "`hydrostat.Arm.reach(...)`",
    "sensitivity": "`hydrostat.Arm.sensitivities(...)`",
    "solution": "`hydrostat.Arm.solve(...)`",
    "solver": "`hydrostat.Solver(...)`",
    "spatial": "`hydrostat.Arm.solve(...)` of an arm in space",
}

#: What stands for functions that this module does not have.
_METHODS = ("equilibria", "identify", "measurements_template", "path", "reachable", "replace", "sensitivities", "solve", "to_dict", "to_toml")
_EXTRAS = ("gym", "jax", "torch", "widget")

for _name in _MEANT:
    _modules[f"{__name__}.{_name}"].__class__ = _Module


if not _typing.TYPE_CHECKING:
    # A type checker would take it that every name exists.
    def __getattr__(name: str) -> object:
        words = f"module 'hydrostat' has no attribute {name!r}"
        if name in _METHODS:
            words += f"; expected `hydrostat.Arm.{name}`, of an arm: `hydrostat.Arm.load(...).{name}(...)`"
        elif name in _EXTRAS:
            words += f"; `import hydrostat.{name}` first"
        raise AttributeError(words, name=name)


def __dir__() -> list[str]:
    return sorted(__all__)
