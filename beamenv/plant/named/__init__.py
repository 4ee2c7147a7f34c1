"""Plants as files: their names are those of the files. Each says in ``origin`` where its numbers come from."""

from importlib.resources import files

ENDING = ".npz"

NAMES: tuple[str, ...] = tuple(
    sorted(entry.name.removesuffix(ENDING) for entry in files(__name__).iterdir() if entry.name.endswith(ENDING))
)
