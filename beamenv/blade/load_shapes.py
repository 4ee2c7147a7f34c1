"""Where further loads act on a blade, and the generalised forces they are: points, lines, and the motion of the clamp."""

from __future__ import annotations

from typing import Annotated, Any

import numpy as np
from numpy.typing import NDArray

from beamenv.configuration import Choice, Number, Numbers, Range, Refused, check_heeded, configuration
from beamenv.configuration.heeded import Heeded
from beamenv.plant.signals import Signal
from beamenv.sensors.kinds import LARGEST, Point, Vector, check_direction
from beamenv.sensors.points import along, point_rows
from beamenv.structure import RotatingBeam
from beamenv.structure.beam import EXTRA_STATIONS
from beamenv.structure.geometrically_exact.kinematics import INCREMENT, MOVE, SPIN

Array = NDArray[np.float64]
Pair = tuple[float, float]

SHAPES = ("point", "line", "base")
UNITS = {"point": "N", "line": "N/m", "base": "m/s²"}

Profile = Annotated[tuple[float, ...], Numbers(Number(ge=-LARGEST, le=LARGEST), least=2, most=2)]


_HEEDED: Heeded = (
    ("position", "shape", ("point",)),
    ("span", "shape", ("line",)),
    ("profile", "shape", ("line",)),
    ("point", "shape", ("point", "line")),
)


@configuration("blade.loads")
class LoadShape:
    """Where a load acts, and along which direction; how large it is, and when, a scenario says."""

    shape: Annotated[str, Choice(SHAPES)] = "point"
    """A force at a "point", N; a "line" load over part of the span, N/m; or the acceleration of the "base" to which the clamp is
    fixed, m/s²: the blade then lags behind by its inertia, what is said of displacements is against the clamp, and accelerometers
    feel that of the base, too."""
    position: Annotated[float | None, Number(ge=0.0, unit="m")] = None
    """m along the span from the clamp, of a point; None: the tip."""
    span: Annotated[Pair | None, Range(0.0, unit="m")] = None
    """m from and to which a line load reaches; None: all of the span."""
    profile: Profile = (1.0, 1.0)
    """How large a line load is at its beginning and its end over its size; linear between."""
    point: Point = (0.0, 0.0)
    """m: x and y in the section, which turns with the pretwist, from the pitch axis: where a force or a line load acts."""
    direction: Vector = (0.0, 1.0, 0.0)
    """Along lag, flap and span; of any length."""

    def __post_init__(self) -> None:
        check_place(self)

    @property
    def signal(self) -> Signal:
        """Its name and unit as a disturbance."""
        return Signal(self.shape, UNITS[self.shape])


def check_place(load: Any) -> None:
    """``Refused`` where the fields of a ``LoadShape``, or of what has these fields too, do not go together."""
    check_direction(load.direction)
    check_heeded(load, _HEEDED)
    if load.span is not None and not load.span[1] > load.span[0]:
        raise Refused("span", load.span, "a range [from, to] of some length (m)")


def shape_force(beam: RotatingBeam, shape: LoadShape, name: str) -> Array:
    """(N,): the generalised force per N, N/m or m/s²; ``ValueError`` that calls it by ``name`` where it is not on the blade."""
    direction = along(shape.direction)
    if shape.shape == "base":
        return _inertia(beam, direction, name)
    if shape.shape == "point":
        return np.asarray(direction @ point_rows(beam, shape.position, shape.point, name).moved)
    low, high = (0.0, beam.length) if shape.span is None else shape.span
    if high > beam.length * (1.0 + 1e-9):
        raise Refused(f"{name}.span", [low, high], f"within 0 and {beam.length:g} m, the span")
    stations = beam.space.stations(np.array([low, min(high, beam.length)]), beam.space.order + EXTRA_STATIONS)
    first, last = shape.profile
    size = first + (last - first) * (stations.z - low) / (high - low)
    each = [direction @ point_rows(beam, z, shape.point, name).moved for z in stations.z.tolist()]
    return np.asarray((stations.weight * size) @ np.array(each))


def _inertia(beam: RotatingBeam, direction: Array, name: str) -> Array:
    """−∫ρ n·(u + ϑ × r) dV: the work of the inertia of a blade whose base is accelerated along n."""
    if beam.model == "thesis":
        raise Refused(f"{name}.shape", "base", "'point' or 'line' in the thesis' model")
    at = beam.exact.at_stations
    sections = at.inertia(at.unloaded)
    force = np.zeros((len(sections.mass), INCREMENT))
    force[:, MOVE] = -sections.mass[:, None] * direction
    force[:, SPIN] = -np.cross(sections.first, direction)
    return at.force(force)


def usual_size(beam: RotatingBeam, shape: LoadShape, reference: float) -> float:
    """What stands for a reference line load (N/m): itself; the force that bends a uniform cantilever's tip as far, 3 w L/8; the
    acceleration at which its inertia is as much.
    """
    if shape.shape == "line":
        return reference
    if shape.shape == "point":
        return 0.375 * reference * beam.length
    at = beam.exact.at_stations
    return reference * beam.length / float(at.weight @ at.inertia(at.unloaded).mass)
