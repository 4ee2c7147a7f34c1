"""The window of ``render_mode="human"``."""

from __future__ import annotations

from typing import Any


class Window:
    """Opens when the first picture is shown, and shows ``rate`` of them a second, never more."""

    def __init__(self, title: str, rate: float) -> None:
        self._title, self._rate = title, rate
        self._screen: Any = None
        self._clock: Any = None

    def show(self, picture: Any) -> None:
        """Show a pygame surface, and wait until the next one is due."""
        import pygame

        if self._screen is None:
            pygame.display.init()
            pygame.display.set_caption(self._title)
            self._screen = pygame.display.set_mode(picture.get_size())
            self._clock = pygame.time.Clock()
        self._screen.blit(picture, (0, 0))
        pygame.event.pump()
        pygame.display.flip()
        self._clock.tick(self._rate)

    def close(self) -> None:
        """Close it, if it is open."""
        if self._screen is not None:
            import pygame

            pygame.display.quit()
            self._screen = None
