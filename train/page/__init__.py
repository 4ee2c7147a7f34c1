"""One self-contained page, ``report.html``, about controllers and how they did."""

from train.figures.heat_map import HeatMap
from train.figures.panels import LearningCurves
from train.page.lead import Lead
from train.page.page import PageContent, write_page
from train.page.recording import RecordedEpisode, Recording, record, record_episode
from train.page.table import Cell, Table

__all__ = [
    "Cell",
    "HeatMap",
    "Lead",
    "LearningCurves",
    "PageContent",
    "RecordedEpisode",
    "Recording",
    "Table",
    "record",
    "record_episode",
    "write_page",
]
