"""Fields of which one takes the place of the other: said together one would have no effect."""

from dataclasses import replace

import pytest

from beamenv.blade.config import BeamConfig
from beamenv.blade.files import from_dict, to_dict
from beamenv.blade.presets import blade_config
from beamenv.configuration import read
from beamenv.structure import GRAPHITE_EPOXY, BoxSection, Layup, RotatingBeam

TABLE = ((0.0, 1.0), (1.0, 0.5))
PAIRS = [("chord_table", "taper", 2.0, 1.0), ("twist_table", "pretwist_deg", 10.0, 0.0)]


@pytest.mark.parametrize(("table", "even", "value", "neutral"), PAIRS)
def test_a_table_beside_the_even_law_is_refused(table, even, value, neutral):
    said = f"beam.{even} is {value}, but must be left out, or {neutral:g}, beside {table}"
    with pytest.raises(ValueError, match=said):
        blade_config("thesis", {"beam": {table: TABLE, even: value}})
    with pytest.raises(ValueError, match=said):
        BeamConfig(**{table: TABLE, even: value})
    with pytest.raises(ValueError, match=said):
        box = BoxSection(0.2, 0.05, 0.005)
        RotatingBeam(section=box, layup=Layup.uniform(GRAPHITE_EPOXY, [0.0]), length=1.0, **{table: TABLE, even: value})


@pytest.mark.parametrize("preset", ["thesis", "airfoil-blade"])
@pytest.mark.parametrize(("table", "even", "value", "neutral"), PAIRS)
def test_what_a_preset_has_is_not_blamed_and_gives_way(preset, table, even, value, neutral):
    config = blade_config(preset, {"beam": {table: TABLE}})
    assert getattr(config.beam, even) == neutral
    assert from_dict(to_dict(config)) == config
    assert replace(config.beam, terms=12).terms == 12
    back = read(config, {"beam": {even: value}})
    assert getattr(back.beam, even) == value
    assert getattr(back.beam, table) is None
