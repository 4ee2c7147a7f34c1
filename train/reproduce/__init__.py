"""The thesis' tables and figures, regenerated from the model and judged by stated rules: ``beamenv reproduce``."""
