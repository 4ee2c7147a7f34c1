"""The thesis' configurations, its printed numbers as data, and what chapters 2 and 3 study, as pure functions of the structure."""

from beamenv.thesis.configurations import Model
from beamenv.thesis.printed import printed_table

__all__ = ["Model", "printed_table"]
