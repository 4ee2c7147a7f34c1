"""The thesis' configurations, its printed numbers as data, and what chapters 2 and 3 study, as pure functions of the structure."""

from train.reproduce.thesis.configurations import Model
from train.reproduce.thesis.printed import printed_table

__all__ = ["Model", "printed_table"]
