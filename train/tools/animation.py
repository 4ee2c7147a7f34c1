"""The README's moving picture: the same pulse on a blade that is left alone and on one under LQG, one above the other.

``python -m train.tools.animation`` writes ``blade.webp`` and ``blade-dark.webp``, for dark pages, into ``docs/images``, in about a
minute; a folder as argument has them written there.
"""

from __future__ import annotations

import io
import sys
from collections.abc import Sequence
from pathlib import Path

import gymnasium
import numpy as np
from numpy.typing import NDArray
from PIL import Image

import beamenv
from baselines import no_control, reference_lqg
from beamenv.configuration.writing import write_whole
from beamenv.rendering.history import Instant
from beamenv.rendering.palette import DARK, LIGHT
from train.tools.pair import PairPicture, recorded

Picture = NDArray[np.uint8]

FOLDER = Path("docs/images")
SEED = 0
PULSE = {"case": "pulse", "magnitude": 45.0, "direction_deg": 90.0, "onset": 0.005, "duration": 0.013}
"""13 ms: half a period of the first flapping mode, when a pulse does most."""
PICTURES, STEPS_PER_PICTURE, MS_PER_PICTURE = 180, 3, 70
"""One picture for every 1.5 ms of life, shown for 70: some fifty times slower."""
TITLE = f"scenario pulse  ·  {PULSE['magnitude']:.0f} N/m in flap for {1e3 * PULSE['duration']:.0f} ms  ·  seed {SEED}"  # type: ignore[operator]
QUALITY = 50
"""Of WebP's: letters are clear, and the file stays below 3 MB."""
THEMES = {"": LIGHT, "-dark": DARK}


def animation(pictures: Sequence[Picture]) -> bytes:
    """A WebP that repeats for ever."""
    file, (first, *others) = io.BytesIO(), [Image.fromarray(each) for each in pictures]
    first.save(file, "WEBP", save_all=True, append_images=others, duration=MS_PER_PICTURE, loop=0, quality=QUALITY, method=4)
    return file.getvalue()


def pictures(drawing: PairPicture, pairs: Sequence[tuple[Instant, Instant]]) -> list[Picture]:
    """One for every few of the instants, from the first on."""
    shown = []
    for step, pair in enumerate(pairs):
        (drawing.record if step else drawing.begin)(pair)
        if step % STEPS_PER_PICTURE == 0:
            shown.append(drawing.draw())
    return shown


def write_animation(folder: Path, count: int = PICTURES) -> None:
    """Write ``blade.webp`` and ``blade-dark.webp`` of ``count`` pictures, whole or not at all."""
    env = gymnasium.make(beamenv.ENV_ID, scenario="pulse", dtype="float64")
    task = env.unwrapped.task  # type: ignore[attr-defined]
    laws = {"no control": no_control(task.plant), "LQG": reference_lqg(task.design.full_plant)}
    length = STEPS_PER_PICTURE * (count - 1) + 1
    episodes = {name: recorded(law, env, SEED, PULSE, length) for name, law in laws.items()}
    for ending, theme in THEMES.items():
        drawing = PairPicture(task, TITLE, episodes, theme)
        pairs = list(zip(*episodes.values(), strict=True))
        write_whole(folder / f"blade{ending}.webp", animation(pictures(drawing, pairs)))


if __name__ == "__main__":
    write_animation(Path(sys.argv[1]) if len(sys.argv) > 1 else FOLDER)
