"""``beamenv compare``: every controller on the same held-out episodes."""
