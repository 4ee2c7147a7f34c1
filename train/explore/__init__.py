"""``beamenv explore``: a page on this computer whose sliders redraw what the model says of a blade."""

from train.explore.blade import View, view
from train.explore.loop import Loop, loop
from train.explore.server import serve
from train.explore.settings import Settings

__all__ = ["Loop", "Settings", "View", "loop", "serve", "view"]
