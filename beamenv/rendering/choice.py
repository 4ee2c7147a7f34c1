"""Which pictures a task has: a blade's, or a model's time histories."""

from __future__ import annotations

from beamenv.blade.model_blade import ModelBlade
from beamenv.rendering.episode_renderer import EpisodeRenderer
from beamenv.rendering.model_renderer import ModelRenderer
from beamenv.rendering.renderer import BladeRenderer
from beamenv.task import Task


def renderer_of(task: Task, rate: float | None = None) -> EpisodeRenderer:
    """What draws the task's episodes; ``rate`` (1/s) opens a window."""
    return ModelRenderer(task, rate) if isinstance(task.blade, ModelBlade) else BladeRenderer(task, rate)
