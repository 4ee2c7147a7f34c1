"""``beamenv explore``: a page on this computer whose sliders redraw what the model says of a blade."""

from train.explore.blade import Settings, View, view
from train.explore.server import serve

__all__ = ["Settings", "View", "serve", "view"]
