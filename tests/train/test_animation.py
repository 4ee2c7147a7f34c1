"""The README's moving picture."""

import pytest

pytest.importorskip("pygame")
pytest.importorskip("PIL")

from PIL import Image

from train.tools.animation import MS_PER_PICTURE, SIZE, write_animation


def test_an_animation_shows_two_blades_that_differ_once_lqg_acts(tmp_path):
    write_animation(tmp_path, count=12)
    with Image.open(tmp_path / "blade.webp") as moving:
        assert moving.size == (SIZE[0], 2 * SIZE[1])
        assert moving.n_frames == 12
        moving.seek(11)
        last = moving.convert("RGB")
        assert moving.info["duration"] == MS_PER_PICTURE
    blade = (0, 80, 460, 350)
    alone, controlled = (last.crop((0, row * SIZE[1], SIZE[0], (row + 1) * SIZE[1])).crop(blade) for row in (0, 1))
    assert alone.tobytes() != controlled.tobytes()
    with Image.open(tmp_path / "blade.png") as still:
        assert still.size == (960, 540)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["blade.png", "blade.webp"]
