"""Arm files as the numbers that the equations of docs/model.md need, in units of L and of C3 A0 / L^2 at the base."""

import math
import tomllib
from dataclasses import dataclass

import numpy as np
from scipy.interpolate import PchipInterpolator


@dataclass
class Profile:
    """Values at both ends or at points, with the slope along the arm. Lengths of `s` are in metres."""

    points: list

    @staticmethod
    def of(value, length, default=0.0):
        value = default if value is None else value
        if isinstance(value, dict):
            return Profile([[0.0, value["base"]], [length, value["tip"]]])
        if isinstance(value, list):
            return Profile(value)
        return Profile([[0.0, value], [length, value]])

    def knots(self):
        return [s for s, _ in self.points[1:-1]]

    def at(self, s):
        """Value and slope per metre."""
        (s0, first), (s1, last) = self.points[0], self.points[-1]
        if len(self.points) == 2:
            slope = (last - first) / (s1 - s0)
            return first + slope * (s - s0), np.full_like(s, slope)
        curve = PchipInterpolator(*zip(*self.points))
        return curve(s), curve(s, 1)


class Arm:
    """An arm file with the options that the reference cases use: no strokes, no friction."""

    def __init__(self, text):
        file = tomllib.loads(text)
        arm, material = file["arm"], file["material"]
        self.length = length = arm["length"]
        profile = lambda value, default=0.0: Profile.of(value, length, default)
        self.radius, self.inner = profile(arm["radius"]), profile(arm.get("inner_radius"))
        self.sealed = arm.get("cavity", "flooded") == "sealed"
        self.density = arm.get("density", 1000.0)
        base = arm.get("base", {})
        self.base = (base.get("x", 0.0), base.get("y", 0.0), math.radians(base.get("angle", 0.0)))
        self.young = material.get("young")
        if self.young is None:
            self.coefficients = [profile(material[key]) for key in ("c1", "c2", "c3")]
        else:
            self.shear = material.get("shear_factor", 1.0) / (2.0 * (1.0 + material["poisson"]))
        reference = file.get("reference", {})
        self.reference = [profile(reference.get(key), default) for key, default in (("nu", 1.0), ("eta", 0.0), ("mu", 0.0))]
        cables = file.get("cable", [])
        self.offsets = [profile(cable["offset"]) for cable in cables]
        self.tensions = np.array([cable["tension"] for cable in cables], float)
        self.ends = [cable.get("end", 1.0) for cable in cables]
        flow, gravity, tip = file.get("flow", {}), file.get("gravity"), file.get("tip", {})
        psi, self.water = math.radians(flow.get("direction", 0.0)), flow.get("density", 1000.0)
        speed = flow.get("speed", 0.0) if self.water else 0.0
        self.stream = (speed * math.cos(psi), speed * math.sin(psi))
        self.drag = (flow["cn"], flow["ct"]) if flow.get("law") == "quadratic-drag" else None
        self.gravity = (0.0, 0.0)
        if gravity is not None:
            down = math.radians(gravity.get("direction", -90.0))
            size = gravity.get("acceleration", 9.81)
            self.gravity = (size * math.cos(down), size * math.sin(down))
        self.tip_force, self.tip_moment = tip.get("force", (0.0, 0.0)), tip.get("moment", 0.0)
        self.follower = tip.get("follower", (0.0, 0.0))
        model = file.get("model", {})
        literal = model.get("closure") == "literal"
        word = lambda key, default, letter: model.get(key, letter if literal else default)
        self.volume = model.get("volume", "planar")
        self.lateral = word("flow_surface", "centreline", "lateral") == "lateral"
        self.resultant = word("entering_speed", "tangential", "resultant") == "resultant"
        self.layer = math.sqrt(8.0 / 15.0) if model.get("layer_mean") == "momentum" else 2.0 / 3.0
        self.deformed = model.get("wetted_length") == "deformed"
        self.normal_only = word("hydrostatics", "archimedes", "normal-only") == "normal-only"
        self.section = model.get("displaced", "volume") == "section"
        self.unstrained = model.get("support") == "unstrained-base"
        zero = np.zeros(1)
        self.force = (self.stiffness(zero)[2] / length**2)[0]

    def wall(self, s):
        """pi (R^2 - R_in^2)."""
        return math.pi * (self.radius.at(s)[0] ** 2 - self.inner.at(s)[0] ** 2)

    def stiffness(self, s):
        """C1 A0, C2 A0 (N) and C3 A0 (N m2)."""
        area = self.wall(s)
        if self.young is None:
            return np.array([c.at(s)[0] * area for c in self.coefficients])
        squares = self.radius.at(s)[0] ** 2 + self.inner.at(s)[0] ** 2
        return np.array([self.young * area, self.shear * self.young * area, 0.25 * self.young * squares * area])

    def breaks(self):
        """Places in (0, 1) where a profile has a knot or a cable ends."""
        profiles = [self.radius, self.inner, *self.reference, *self.offsets]
        profiles += self.coefficients if self.young is None else []
        knots = [s / self.length for profile in profiles for s in profile.knots()]
        return sorted({round(s, 14) for s in knots + self.ends if 0.0 < s < 1.0})


class Places:
    """What the arm is at the points `s` (over L), `middle` being the middle of the piece that each is in."""

    def __init__(self, arm, s, middle):
        at, length, force = s * arm.length, arm.length, arm.force
        stiffness = arm.stiffness(at)
        self.stiffness = stiffness / np.array([force, force, force * length**2])[:, None]
        self.reference = np.array([p.at(at)[0] for p in arm.reference]) * np.array([1.0, 1.0, length])[:, None]
        radius, slope = arm.radius.at(at)
        self.radius, self.radius_slope = radius / length, slope
        self.offsets = [(y / length, y_slope) for y, y_slope in (offset.at(at) for offset in arm.offsets)]
        self.runs = [(middle < end).astype(float) for end in arm.ends]
        per = length / force
        self.wetted = math.pi * arm.water * radius * per
        wall = arm.wall(at)
        outline = math.pi * radius**2 if arm.sealed else wall
        self.weight = [arm.density * wall * g * per for g in arm.gravity]
        self.displaced = [arm.water * outline * g * per for g in arm.gravity]
        if arm.drag is not None:
            cn, ct = arm.drag
            self.across = 0.5 * arm.water * cn * 2.0 * radius * per
            self.along = 0.5 * arm.water * ct * 2.0 * math.pi * radius * per
