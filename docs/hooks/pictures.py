"""How pages show pictures: in the page's own colours, and as large as they are meant.

A picture that has another beside it for dark pages, ``…-dark.png``, is shown in the one that fits. One with many dots an inch,
as its file tells, is shown at its size on paper, 100 pixels an inch. Pages name the light picture alone; where this hook does not
run, as in a view of the repository, that one is shown.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

DOCS = Path(__file__).resolve().parents[1]
PICTURE = re.compile(r"(?P<words>!\[[^\]]*\])\((?P<place>[^)\s#:]+)\)(?:\{(?P<attributes>[^}\n]*)\})?")
PIXELS = 100.0
"""An inch."""


def on_page_markdown(markdown: str, page: Any, **_: Any) -> str:
    """Each such picture twice, of which the theme hides one."""
    return PICTURE.sub(lambda found: shown(found, (DOCS / page.file.src_uri).parent), markdown)


def shown(found: re.Match[str], folder: Path) -> str:
    """The picture of a match with its width, and after it the dark one, if there is one."""
    words, light = found["words"], Path(found["place"])
    given = f"{(found['attributes'] or '').strip()} {width(folder / light)}".strip()
    attributes = f"{{ {given} }}" if given else ""
    dark = light.with_stem(f"{light.stem}-dark")
    if not (folder / dark).is_file():
        return f"{words}({light.as_posix()}){attributes}"
    pair = ((light, "only-light"), (dark, "only-dark"))
    return "".join(f"{words}({place.as_posix()}#{theme}){attributes}" for place, theme in pair)


def width(file: Path) -> str:
    """The attribute, for a PNG that tells how many dots it has an inch; empty otherwise."""
    from PIL import Image

    if file.suffix != ".png" or not file.is_file():
        return ""
    with Image.open(file) as picture:
        dots = picture.info.get("dpi", (0.0, 0.0))[0]
        return f"width={picture.width * PIXELS / dots:.0f}" if dots > PIXELS else ""
