"""At which strain sheets break, and with them the blades that carry them."""

from dataclasses import replace

import numpy as np
import pytest

from beamenv import RotatingBeamEnv, blade_config
from beamenv.patches.material import MFC, PATCH_MATERIALS, PIC255, PZT
from beamenv.simulation.plants.bank import Bank
from beamenv.task import resolve_task


def test_macro_fibre_bears_what_it_is_rated_for_and_ceramic_its_bending_strength():
    assert MFC.failure_strain == 0.0045
    for sheet in (PZT, PIC255):
        assert sheet.failure_strain * sheet.lamina.E1 == pytest.approx(140.4e6)
    assert all(0.001 < each.failure_strain <= 0.0045 for each in PATCH_MATERIALS.values())


def test_the_least_of_a_blade_s_sheets_counts():
    patches = blade_config("aluminium-cantilever").patches
    assert patches.failure_strain == PIC255.failure_strain
    for side in ("actuators", "sensors"):
        fibres = tuple(replace(group, material="MFC") for group in getattr(patches, side))
        assert replace(patches, **{side: fibres}).failure_strain == PIC255.failure_strain
    own = replace(MFC, failure_strain=1e-3)
    brittle = replace(patches, actuators=(replace(patches.actuators[0], material=own),))
    assert brittle.failure_strain == 1e-3
    assert blade_config("thesis").patches.failure_strain == 0.0045


@pytest.mark.parametrize("share", [0.9, 1.1])
def test_a_strip_fails_where_its_ceramic_breaks(share):
    """A step that bends it in its first mode to 0.9 and 1.1 of the limit."""
    probe = RotatingBeamEnv("aluminium-cantilever", scenario="quiet")
    load = {"case": "step", "magnitude": 1.0, "direction_deg": 90.0, "onset": 0.0}

    def episode(magnitude):
        probe.reset(seed=0, options={"load": {**load, "magnitude": magnitude}})
        strains, failed = [], False
        while not failed and len(strains) < 200:
            failed = probe.step(np.zeros(1))[2]
            strains.append(np.abs(probe.plant.strain @ probe.state).max())
        return max(strains), failed

    most, _ = episode(1.0)
    strain, failed = episode(share * PIC255.failure_strain / most)
    assert strain == pytest.approx(share * PIC255.failure_strain, rel=0.2)
    assert failed == (share > 1.0)


def test_a_batch_of_blades_of_different_sheets_bears_what_each_does():
    task = resolve_task("aluminium-cantilever", scenario="quiet")
    fibres = replace(task.config.patches.actuators[0], material="MFC"), replace(task.config.patches.sensors[0], material="MFC")
    other = resolve_task(blade=replace(task.config, patches=replace(task.config.patches, actuators=fibres[:1], sensors=fibres[1:])))
    assert Bank.joined([task.bank, other.bank]).failure_strain.tolist() == [PIC255.failure_strain, 0.0045]


def test_a_spin_up_and_a_state_are_held_to_the_sheets_limit():
    chosen = {"preset": "spin-up", "plants": {"spin_up": [60.0, 72.0]}}
    config = blade_config("airfoil-blade")
    ceramic = tuple(
        tuple(replace(group, material="PZT") for group in config.patches.groups(side)) for side in ("actuators", "sensors")
    )
    blade = replace(config, strain_limit="vibration", patches=replace(config.patches, actuators=ceramic[0], sensors=ceramic[1]))
    bank = resolve_task(blade=blade, scenario=chosen, duration=0.01).bank
    np.testing.assert_allclose(bank.failure_strain, PZT.failure_strain, rtol=1e-12)
    env = RotatingBeamEnv(blade=blade)
    row = env.plant.strain[np.abs(env.plant.strain).max(axis=1).argmax()]
    with pytest.raises(ValueError, match="must be finite and stay below 0.00113"):
        env.reset(options={"initial_state": 1.05 * PZT.failure_strain * row / (row @ row)})
