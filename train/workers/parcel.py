"""A piece of work as bytes, with the files that it names: what a machine needs that has none of them."""

from __future__ import annotations

import io
import pickle
from collections.abc import Iterable, Mapping
from functools import cache
from pathlib import Path
from tempfile import mkdtemp
from typing import Any

from train.shared.digests import digest


def packed(content: Any, files: Iterable[Path] = ()) -> bytes:
    """The content with the files: where it names one, or a folder that holds one, by path or text, it names what is carried."""
    import cloudpickle  # comes with the extra for training, which one process does without

    carried = {str(path): path.read_bytes() for path in files}
    places = _places(carried)

    class Packing(cloudpickle.Pickler):  # type: ignore[misc]
        def persistent_id(self, given: Any) -> str | None:
            if not isinstance(given, (str, Path)) or str(given) not in places:
                return None
            return f"{'text' if isinstance(given, str) else 'path'} {places.index(str(given))}"

    stream = io.BytesIO()
    Packing(stream).dump(content)
    return pickle.dumps((stream.getvalue(), carried))


def _places(carried: Mapping[str, bytes]) -> list[str]:
    """Names of files and of their folders."""
    return sorted({*carried, *(str(Path(each).parent) for each in carried)})


def unpacked(parcel: bytes) -> Any:
    """The content, where files of these names are not the same here with paths of copies."""
    content, carried = pickle.loads(parcel)
    return _Unpacking(io.BytesIO(content), carried).load()


class _Unpacking(pickle.Unpickler):
    def __init__(self, content: io.BytesIO, carried: dict[str, bytes]) -> None:
        super().__init__(content)
        self._carried = carried

    def persistent_load(self, told: str) -> Any:
        kind, number = told.split()
        place = self._place(_places(self._carried)[int(number)])
        return place if kind == "path" else str(place)

    def _place(self, name: str) -> Path:
        inside = {each: content for each, content in self._carried.items() if name in (each, str(Path(each).parent))}
        if all(_is_here(Path(each), content) for each, content in inside.items()):
            return Path(name)
        home = _home(name, digest(*inside.values()))
        for each, content in inside.items():
            (home / Path(each).name).write_bytes(content)
        return home / Path(name).name if name in inside else home


def _is_here(path: Path, content: bytes) -> bool:
    try:
        return path.read_bytes() == content
    except OSError:
        return False


@cache
def _home(name: str, contents: str) -> Path:
    """A folder of this process for the files of one name and these contents."""
    return Path(mkdtemp(prefix="beamenv-"))
