"""Which equations a blade spins up by: those of its model."""

from __future__ import annotations

from beamenv.blade.build import Blade
from beamenv.configuration import Refused
from beamenv.simulation.plants.about_rest import AboutRest
from beamenv.simulation.plants.about_steady_states import AboutSteadyStates
from beamenv.simulation.plants.spin_up import Cycloid, SpinUp


def spin_up_of(blade: Blade, course: Cycloid) -> SpinUp:
    """In the modes of the configured speed, with their damping; ``ValueError`` where the blade cannot turn so fast."""
    critical, speeds = blade.beam.critical_speed, [course.first, course.last]
    if max(speeds) >= critical:
        raise Refused("scenario.plants.spin_up", speeds, f"below the critical speed, {critical:.6g} rad/s")
    try:
        blade.beam.at(max(speeds))
    except Refused:
        raise Refused("scenario.plants.spin_up", speeds, "speeds at which the blade has a steady state") from None
    return (AboutRest if blade.config.model == "thesis" else AboutSteadyStates).of(blade, course)
