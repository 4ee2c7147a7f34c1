"""Moving pictures of a blade: matplotlib sets the page once, pygame draws on it what moves, and shows it in a window."""

from beamenv.rendering.batch import BatchRenderer
from beamenv.rendering.choice import renderer_of
from beamenv.rendering.episode_renderer import EpisodeRenderer
from beamenv.rendering.history import Instant, gains
from beamenv.rendering.model_renderer import ModelRenderer
from beamenv.rendering.renderer import BladeRenderer
from beamenv.rendering.titles import of_episode

__all__ = ["BatchRenderer", "BladeRenderer", "EpisodeRenderer", "Instant", "ModelRenderer", "gains", "of_episode", "renderer_of"]
