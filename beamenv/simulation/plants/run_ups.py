"""Which equations a blade runs up by: those of its model."""

from __future__ import annotations

from beamenv.blade.build import Blade
from beamenv.configuration import Refused
from beamenv.simulation.plants.about_rest import AboutRest
from beamenv.simulation.plants.about_steady_states import AboutSteadyStates
from beamenv.simulation.plants.run_up import Cycloid, RunUp


def run_up_of(blade: Blade, course: Cycloid) -> RunUp:
    """In the modes of the configured speed, with their damping; ``ValueError`` past the critical speed."""
    critical, speeds = blade.beam.critical_speed, [course.first, course.last]
    if max(speeds) >= critical:
        raise Refused("scenario.plants.spin_up", speeds, f"below the critical speed, {critical:.6g} rad/s")
    return (AboutRest if blade.config.model == "thesis" else AboutSteadyStates).of(blade, course)
