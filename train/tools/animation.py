"""The README's moving picture: the same pulse on a blade that is left alone and on one under LQG, one above the other.

``python -m train.tools.animation`` writes ``blade.webp`` and a still from it, ``blade.png``, into ``docs/images``, in about a
minute; a folder as argument has them written there.
"""

from __future__ import annotations

import io
import sys
from collections.abc import Sequence
from itertools import islice
from pathlib import Path

import gymnasium
import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw, ImageFont

import beamenv
from baselines import Controller, no_control, reference_lqg
from baselines.evaluation.loop import instants
from beamenv.configuration.writing import write_whole

Picture = NDArray[np.uint8]

FOLDER = Path("docs/images")
SEED = 0
PULSE = {"case": "pulse", "magnitude": 45.0, "direction_deg": 90.0, "onset": 0.005, "duration": 0.013}
"""13 ms: half a period of the first flapping mode, when a pulse does most."""
PICTURES, STEPS_PER_PICTURE, MS_PER_PICTURE = 180, 3, 70
"""One picture for every 1.5 ms of life, shown for 70: some fifty times slower."""
STILL = 24
"""The picture that is written as a still: 36 ms after the start, 18 ms after the pulse."""
SIZE = (720, 405)
"""px, of each of the two."""
QUALITY = 50
"""Of WebP's: letters are clear, and the file stays below 3 MB."""
TITLE_AT, TITLE_SIZE, INK = (330, 15), 22, "#1f2933"


def pictures(controller: Controller, count: int) -> list[Picture]:
    """``count`` pictures (540, 960, 3) of one episode under a controller."""
    env = gymnasium.make(beamenv.ENV_ID, render_mode="rgb_array", dtype="float64")
    episode = instants(controller, env, [SEED], {"load": PULSE})
    shown = [np.asarray(env.render()) for _ in islice(episode, 0, STEPS_PER_PICTURE * (count - 1) + 1, STEPS_PER_PICTURE)]
    env.close()
    return shown


def sheet(titled: Sequence[tuple[str, Picture]]) -> Image.Image:
    """Pictures one above the other, each with its title."""
    from matplotlib import get_data_path

    font = ImageFont.truetype(f"{get_data_path()}/fonts/ttf/DejaVuSans-Bold.ttf", TITLE_SIZE)
    together = Image.new("RGB", (SIZE[0], len(titled) * SIZE[1]))
    for row, (title, picture) in enumerate(titled):
        image = Image.fromarray(picture)
        ImageDraw.Draw(image).text(TITLE_AT, title, INK, font=font)
        together.paste(image.resize(SIZE, Image.Resampling.LANCZOS), (0, row * SIZE[1]))
    return together


def animation(sheets: Sequence[Image.Image]) -> bytes:
    """A WebP that repeats for ever."""
    file = io.BytesIO()
    sheets[0].save(
        file, "WEBP", save_all=True, append_images=sheets[1:], duration=MS_PER_PICTURE, loop=0, quality=QUALITY, method=4
    )
    return file.getvalue()


def write_animation(folder: Path, count: int = PICTURES) -> None:
    """Write ``blade.webp`` of ``count`` pictures and ``blade.png``, whole or not at all."""
    design = gymnasium.make(beamenv.ENV_ID).unwrapped.design  # type: ignore[attr-defined]
    laws = (("no control", no_control(design.plant)), ("LQG", reference_lqg(design.full_plant)))
    episodes = [(title, pictures(law, count)) for title, law in laws]
    write_whole(folder / "blade.webp", animation([sheet([(title, shown[k]) for title, shown in episodes]) for k in range(count)]))
    still = io.BytesIO()
    Image.fromarray(episodes[-1][1][min(STILL, count - 1)]).save(still, "PNG", optimize=True)
    write_whole(folder / "blade.png", still.getvalue())


if __name__ == "__main__":
    write_animation(Path(sys.argv[1]) if len(sys.argv) > 1 else FOLDER)
