"""Twist and chord by tables."""

import numpy as np

from beamenv.blade.presets import blade_config


def test_tables_of_twist_and_size_are_the_even_laws_where_they_are_straight():
    """One piece exactly; two of which neither changes anything within 1e-4, for their sizes are others."""
    beam = {"taper": 1.7, "pretwist_deg": 20.0}
    even = blade_config("thesis", {"beam": beam}).beam.build().natural_frequencies(200.0, 8)
    halfway = 0.5 * (1.0 + 1.0 / 1.7)
    one = {"chord_table": [[0.0, 1.0], [1.0, 1.0 / 1.7]], "twist_table": [[0.0, 0.0], [1.0, 20.0]]}
    two = {"chord_table": [[0.0, 1.0], [0.5, halfway], [1.0, 1.0 / 1.7]], "twist_table": [[0.0, 0.0], [0.25, 5.0], [1.0, 20.0]]}
    for tables, within in ((one, 1e-12), (two, 1e-4)):
        found = blade_config("thesis", {"beam": tables}).beam.build().natural_frequencies(200.0, 8)
        np.testing.assert_allclose(found, even, rtol=within)


def test_a_step_in_twist_rate_is_between_the_blades_of_either_rate():
    def first_torsion(table):
        modes = blade_config("thesis", {"beam": {"twist_table": table}}).beam.build().modes(200.0, 6)
        return float(modes.natural_frequencies[modes.families.index("twist")])

    slow, fast = first_torsion([[0.0, 0.0], [1.0, 10.0]]), first_torsion([[0.0, 0.0], [1.0, 40.0]])
    both = first_torsion([[0.0, 0.0], [0.5, 5.0], [1.0, 25.0]])
    assert min(slow, fast) < both < max(slow, fast)
