"""What ``beamenv speed`` measures, in rows, and what is to be reached."""

from __future__ import annotations

BATCHES = (256, 4096, 16384)

TARGETS = {
    "single_over_cartpole": 0.7,
    "batch_4096_over_cartpole": 0.4,
    "batch_of_32_bits_over_cartpole": 0.6,
    "pictures": 30.0,
    "assembly_ms": 15.0,
    "further_speed_ms": 5.0,
    "plant_ms": 60.0,
    "import_s": 1.0,
}
"""Rates are to be at least, times at most this."""

OVER_CARTPOLE = {
    "single": "cartpole",
    **dict.fromkeys(("batch_4096", "batch_of_32_bits", "plants_1024", "plants_1024_of_32_bits", "tensors_4096"), "cartpole_4096"),
}
"""What is told as a ratio to CartPole's steps, and to which."""

ROWS = (
    ("cartpole", "CartPole-v1, gym.make", "steps/s"),
    ("single", "RotatingBeam-v0, gym.make", "steps/s"),
    ("single_over_cartpole", "the second over the first", ""),
    ("cartpole_4096", "CartPole-v1, batch of 4096", "steps/s"),
    *((f"batch_{size}", f"RotatingBeam-v0, batch of {size}", "steps/s") for size in BATCHES),
    ("batch_4096_over_cartpole", "a batch of 4096 over CartPole's", ""),
    ("batch_of_32_bits", 'the same of 4096 with dtype="float32"', "steps/s"),
    ("batch_of_32_bits_over_cartpole", "that over CartPole's", ""),
    ("plants_1024", "batch of 1024, each at a speed of its own", "steps/s"),
    ("plants_1024_over_cartpole", "that over CartPole's", ""),
    ("plants_1024_of_32_bits", 'the same with dtype="float32"', "steps/s"),
    ("plants_1024_of_32_bits_over_cartpole", "that over CartPole's", ""),
    ("tensors_4096", "batch of 4096 tensors, processor, 32 bits", "steps/s"),
    ("tensors_4096_over_cartpole", "that over CartPole's", ""),
    ("history_4096", "batch of 4096 with 12 instants of history", "steps/s"),
    ("pictures", "a picture of 960 × 540 for each step", "pictures/s"),
    ("import_s", "import beamenv", "s"),
    ("assembly_ms", "assembly of the default beam", "ms"),
    ("assembly_of_known_sections_ms", "the same with its sections known", "ms"),
    ("further_speed_ms", "matrices at a further speed", "ms"),
    ("frequencies_ms", "the same with whirling frequencies", "ms"),
    ("plant_ms", "reduced plant, all from the laminate on", "ms"),
)


def met(name: str, value: float) -> bool | None:
    """Whether a measurement meets its target; None if it has none."""
    if name not in TARGETS:
        return None
    return value <= TARGETS[name] if name.endswith(("_s", "_ms")) else value >= TARGETS[name]
