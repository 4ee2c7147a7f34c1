"""Controllers written for other machines: ``export``, from what the sensors show to the voltages, as C, ONNX or MATLAB files."""

from train.export.exported import PRECISIONS, Exported, exported
from train.export.writing import FORMATS, export

__all__ = ["FORMATS", "PRECISIONS", "Exported", "export", "exported"]
