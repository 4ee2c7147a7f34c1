"""Moving pictures of a blade: matplotlib sets the page once, pygame draws on it what moves, and shows it in a window."""

from beamenv.rendering.batch import BatchRenderer
from beamenv.rendering.choice import renderer_of
from beamenv.rendering.history import Instant
from beamenv.rendering.model_renderer import ModelRenderer
from beamenv.rendering.renderer import BladeRenderer

__all__ = ["BatchRenderer", "BladeRenderer", "Instant", "ModelRenderer", "renderer_of"]
