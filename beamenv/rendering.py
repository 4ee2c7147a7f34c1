"""Pictures of a blade: its deflected shape with the voltages of its patches, and what tip and voltages have done so far."""

from __future__ import annotations

from typing import Any

import numpy as np
from gymnasium.error import DependencyNotInstalled
from numpy.typing import NDArray

from beamenv.configuration import BladeConfig, build_plant, displacement_operator
from beamenv.loads import static_deflection
from beamenv.reduction import REFERENCE_LOAD

Array = NDArray[np.float64]

STATIONS = 61
WALLS = np.array([[[-0.5, 0.5], [0.5, 0.5]], [[0.5, 0.5], [0.5, -0.5]], [[0.5, -0.5], [-0.5, -0.5]], [[-0.5, -0.5], [-0.5, 0.5]]])
"""Edges of the top, right, bottom and left wall in widths and depths of the section."""
SHOWN_DEFLECTION = 0.12
"""Share of the span that the static tip deflection under the reference load is drawn as, at most."""
INK, FAINT = "#1f2933", "#9aa5b1"
BODY = np.array([0.83, 0.86, 0.89])
LIGHT = np.array([0.25, 0.90, -0.35])
"""Towards the light, in (lag, flap, span)."""


def exaggeration(config: BladeConfig) -> float:
    """How many times larger than life deflections are drawn: 1, 2 or 5 times a power of ten, fixed for a configuration."""
    plant = build_plant(config)
    tip = plant.tip_displacement @ static_deflection(plant, np.diag([REFERENCE_LOAD] * 2)).T
    wanted = SHOWN_DEFLECTION * config.beam.length / np.linalg.norm(tip, axis=0).max()
    power = 10.0 ** np.floor(np.log10(wanted))
    return float(power * max(factor for factor in (1.0, 2.0, 5.0) if factor * power <= wanted))


class BladeView:
    """The box of a blade with its deflection drawn larger, as flat quadrilaterals that a camera sees."""

    def __init__(self, config: BladeConfig) -> None:
        self.beam, self.patches = config.beam, config.patches
        self.exaggeration = exaggeration(config)
        self.span = np.linspace(0.0, self.beam.length, STATIONS)
        self._operator = displacement_operator(config, self.span)
        middle = np.radians(self.beam.presetting_deg + 0.5 * self.beam.pretwist_deg)
        side = -1.0 if np.sin(middle) > 0.0 else 1.0  # look at the side that the top wall is turned to
        towards = np.array([0.75 * side, 0.62, -0.25])
        self._towards = towards / np.linalg.norm(towards)
        across = np.cross(self._towards, [0.0, 1.0, 0.0])
        across *= np.sign(across[2]) / np.linalg.norm(across)
        up = np.cross(self._towards, across)
        self._screen = np.stack([across, up * np.sign(up[1])])

    def deflection(self, state: Array) -> Array:
        """(2, stations) lag and flap, m, as drawn."""
        drawn: Array = self.exaggeration * (self._operator @ state)
        return drawn

    def strip(self, deflection: Array, z: Array, edges: Array) -> tuple[Array, Array]:
        """Corners on the screen (len(z) − 1, 4, 2) of the quadrilaterals between two lines along the span, and their unit
        normals (len(z) − 1, 3). ``edges`` (2, 2): the lines, in widths and depths of the section.
        """
        tip = 1.0 / self.beam.taper
        scale = (tip + (1.0 - tip) * (1.0 - z / self.beam.length))[:, None]
        angle = np.radians(self.beam.presetting_deg + self.beam.pretwist_deg * z / self.beam.length)[:, None]
        x, y = scale * edges[:, 0] * self.beam.width, scale * edges[:, 1] * self.beam.depth
        lag, flap = (np.interp(z, self.span, each)[:, None] for each in deflection)
        points = np.stack(
            [
                x * np.cos(angle) - y * np.sin(angle) + lag,
                x * np.sin(angle) + y * np.cos(angle) + flap,
                np.broadcast_to(z[:, None], x.shape),
            ],
            axis=-1,
        )
        corners = np.stack([points[:-1, 0], points[:-1, 1], points[1:, 1], points[1:, 0]], axis=1)
        normals = np.cross(corners[:, 3] - corners[:, 0], corners[:, 1] - corners[:, 0])
        return corners @ self._screen.T, normals / np.linalg.norm(normals, axis=1, keepdims=True)

    def walls(self, deflection: Array) -> tuple[Array, Array]:
        """Quadrilaterals (k, 4, 2) of the walls that face the camera, and their shaded colours (k, 3)."""
        strips = [self.strip(deflection, self.span, edges) for edges in WALLS]
        corners, normals = (np.concatenate(each) for each in zip(*strips, strict=True))
        seen = normals @ self._towards > 0.0
        return corners[seen], shaded(np.broadcast_to(BODY, normals[seen].shape), normals[seen])

    def actuators(self, deflection: Array, colours: Array) -> tuple[Array, Array]:
        """The same for the actuators in the top wall, whose colours (actuators, 3) are given."""
        half = 0.5 * self.patches.width / self.beam.width
        edges = np.array([[-half, 0.5], [half, 0.5]])
        starts = self.patches.actuator_positions(self.beam.length)
        strips = [self.strip(deflection, start + self.patches.length * np.array([0.0, 1.0]), edges) for start in starts]
        corners, normals = (np.concatenate(each) for each in zip(*strips, strict=True))
        return corners, shaded(colours, normals)


def shaded(colours: Array, normals: Array) -> Array:
    """Colours (k, 3) as surfaces with these normals show them."""
    light = LIGHT / np.linalg.norm(LIGHT)
    brightness = 0.62 + 0.38 * np.clip(normals @ light, 0.0, 1.0)
    return np.asarray(colours * brightness[:, None])


class BladeRenderer:
    """Draws one blade's episode: ``begin``, then ``record`` after every step, and ``draw`` whenever a picture is wanted.

    ``duration`` (s) is what the time axes show. Raises DependencyNotInstalled without matplotlib.
    """

    def __init__(self, config: BladeConfig, duration: float) -> None:
        try:
            from matplotlib import colormaps
            from matplotlib.backends.backend_agg import FigureCanvasAgg
            from matplotlib.figure import Figure
        except ImportError as error:
            raise DependencyNotInstalled('Pictures need matplotlib: pip install "beamenv[train]".') from error
        self._plant, self._interval, self._duration = build_plant(config), config.control_interval, duration
        self._limit = float(np.abs(self._plant.voltage_limits).max())
        self._view = BladeView(config)
        self._colours, self._line_colours = colormaps["RdBu_r"], colormaps["viridis"]
        self._figure = Figure(figsize=(9.6, 6.0), dpi=100, facecolor="white")
        self._canvas = FigureCanvasAgg(self._figure)
        self._lay_out_scene()
        self._lay_out_tip()
        self._lay_out_voltages()
        self._background: Any = None  # all that seldom changes, drawn once: axes cost ten times what moves on them
        self.begin(np.zeros(len(self._plant.A)))

    def _lay_out_scene(self) -> None:
        from matplotlib.collections import PolyCollection

        scene = self._scene = self._figure.add_axes((0.0, 0.40, 1.0, 0.60))
        scene.set_axis_off()
        still, span = np.zeros((2, STATIONS)), self._view.beam.length
        strips = [self._view.strip(still, self._view.span, edges)[0] for edges in WALLS]
        for corners in strips:
            scene.plot(*corners[:, 0].T, color=FAINT, linewidth=0.7, linestyle=(0, (4, 3)))
        root, tip = (np.array([corners[end] for corners in strips]) for end in ((0, 0), (-1, 3)))
        scene.fill(*root.T, facecolor=INK, edgecolor=INK, linewidth=3.0, joinstyle="round")
        scene.fill(*tip.T, facecolor="none", edgecolor=FAINT, linewidth=0.7)
        points = np.concatenate(strips).reshape(-1, 2)
        middle = 0.5 * (points.min(axis=0) + points.max(axis=0))
        half = 0.53 * span * np.array([-1.0, 1.0])
        scene.set(xlim=middle[0] + half, ylim=middle[1] + 0.375 * half)  # the axes' own proportions: no distortion
        self._body: Any
        self._patches: Any
        self._body, self._patches = (
            scene.add_collection(PolyCollection([], linewidths=0.4, zorder=height, animated=True), autolim=False)
            for height in (3, 4)
        )
        note = f"deflection drawn {self._view.exaggeration:,.0f} times larger · dashes: at rest · actuators coloured by voltage"
        scene.text(0.03, 0.855, note, transform=scene.transAxes, color=FAINT, fontsize=9, va="top")
        self._note = scene.text(0.03, 0.93, "", transform=scene.transAxes, color=INK, fontsize=12, va="top", animated=True)

    def _lay_out_tip(self) -> None:
        self._tip_axes = self._panel((0.08, 0.09, 0.37, 0.27), "tip displacement, µm")
        self._tip_lines = [
            self._tip_axes.plot([], [], color=colour, linewidth=1.2, label=name, animated=True)[0]
            for colour, name in (("#c2571a", "lag"), ("#2b6cb0", "flap"))
        ]
        self._tip_axes.legend(loc="lower right", bbox_to_anchor=(1.0, 0.97), ncols=2, frameon=False, fontsize=8)

    def _lay_out_voltages(self) -> None:
        axes = self._voltage_axes = self._panel((0.56, 0.09, 0.37, 0.27), "voltage, V")
        axes.set_ylim(-1.08 * self._limit, 1.08 * self._limit)
        colours = self._line_colours(np.linspace(0.85, 0.0, self._plant.B.shape[1]))
        self._voltage_lines = [
            axes.plot([], [], color=colour, linewidth=1.0, label=f"{number}", animated=True)[0]
            for number, colour in enumerate(colours, start=1)
        ]
        axes.legend(loc="lower right", bbox_to_anchor=(1.0, 0.97), ncols=len(colours), frameon=False, fontsize=8, handlelength=1.2)
        key = self._figure.add_axes((0.945, 0.09, 0.012, 0.27))
        key.imshow(self._colours(np.linspace(1.0, 0.0, 64))[:, None], aspect="auto", extent=(0.0, 1.0, -self._limit, self._limit))
        key.set(ylim=axes.get_ylim())
        key.set_axis_off()

    def _panel(self, place: tuple[float, float, float, float], label: str) -> Any:
        axes = self._figure.add_axes(place)
        axes.set(xlim=(0.0, 1e3 * self._duration))
        axes.set_xlabel("time, ms", fontsize=9, color=INK)
        axes.set_title(label, loc="left", fontsize=9, color=INK)
        axes.tick_params(labelsize=8, colors=INK)
        axes.axhline(0.0, color=FAINT, linewidth=0.6)
        axes.spines[["top", "right"]].set_visible(False)
        return axes

    def begin(self, state: Array) -> None:
        """Start an episode in ``state`` (n,)."""
        self._states = [state]
        self._volts = [np.zeros(self._plant.B.shape[1])]

    def record(self, state: Array, volts: Array) -> None:
        """Take down the state (n,) after ``volts`` (m,) were held over one interval."""
        self._states.append(state)
        self._volts.append(volts)

    def draw(self) -> NDArray[np.uint8]:
        """The picture at the last instant recorded: (600, 960, 3)."""
        self._show_shape()
        self._show_history()
        if self._background is None:
            self._canvas.draw()
            self._background = self._canvas.copy_from_bbox(self._figure.bbox)
        self._canvas.restore_region(self._background)
        for artist in (self._body, self._patches, self._note, *self._tip_lines, *self._voltage_lines):
            artist.axes.draw_artist(artist)
        return np.asarray(self._canvas.buffer_rgba())[..., :3].copy()

    def _show_shape(self) -> None:
        deflection = self._view.deflection(self._states[-1])
        actuators = len(self._view.patches.actuator_positions(self._view.beam.length))
        volts = np.broadcast_to(self._volts[-1], (actuators,))  # ganged actuators share one voltage
        colours = self._colours(0.5 + 0.5 * volts / self._limit)[:, :3]
        surfaces = (self._view.walls(deflection), self._view.actuators(deflection, colours))
        for collection, (corners, shades) in zip((self._body, self._patches), surfaces, strict=True):
            collection.set_verts(list(corners))
            collection.set(facecolors=shades, edgecolors=shades if collection is self._body else INK)

    def _show_history(self) -> None:
        time = 1e3 * self._interval * np.arange(len(self._states))
        tip = 1e6 * np.stack(self._states) @ self._plant.tip_displacement.T
        for line, values in zip(self._tip_lines, tip.T, strict=True):
            line.set_data(time, values)
        for line, values in zip(self._voltage_lines, np.stack(self._volts).T, strict=True):
            line.set_data(time, values)
        self._note.set_text(f"t = {time[-1]:.1f} ms    tip: lag {tip[-1, 0]:+.0f} µm, flap {tip[-1, 1]:+.0f} µm")
        most = _round_above(1.05 * np.abs(tip).max())
        if self._tip_axes.get_ylim() != (-most, most):
            self._tip_axes.set_ylim(-most, most)
            self._background = None


def _round_above(value: float) -> float:
    """The least of 10, 20, 50, 100, 200, … that is not below ``value``."""
    steps = (factor * 10.0**power for power in range(1, 20) for factor in (1.0, 2.0, 5.0))
    return next((step for step in steps if step >= value), value)
