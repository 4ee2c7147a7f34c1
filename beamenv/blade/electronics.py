"""The electronics of a blade as a user describes them: what its true plant has, and its design plant does not."""

from __future__ import annotations

from typing import Annotated

from beamenv.configuration import Count, Number, configuration


@configuration("blade.electronics")
class ElectronicsConfig:
    """Amplifiers and anti-aliasing filters, linear; ``None`` switches either off. The thesis' model has none.

    Not in here: an amplifier's current limit. A patch of 85 × 57 mm has some 14 nF (0.30 nF/cm², data sheet of the MFC's P1 type),
    so that 20 mA let its voltage rise by no more than 1.4 V/µs: ±1500 V can be swept up to 150 Hz, and a step of 700 V takes the
    whole default interval. A stronger amplifier, 50 mA say, reaches 2.5 times as far.
    """

    amplifier_bandwidth: Annotated[float | None, Number(ge=1e-3, le=1e9, unit="Hz")] = 7.5e3
    """Hz: −3 dB of its one pole; typical of small amplifiers of ±2 kV and 20 mA for small signals."""
    filter_order: Annotated[int, Count(1, 8)] = 2
    """Of the anti-aliasing filters, Butterworth's: of low order, as is typical of control. The sharp digital ones of instruments
    for vibration (delta-sigma converters such as NI's 9234) come many samples late."""
    filter_cutoff: Annotated[float | None, Number(ge=1e-4, le=100.0)] = 0.4
    """−3 dB frequency over the sampling rate: 800 Hz at 2 kHz. A mode of 435 Hz passes with 0.96 of its size, 48° late;
    so mild a filter lets 0.54 pass at the Nyquist frequency, 1000 Hz, and 0.41 at 1200 Hz, which sampling folds to 800 Hz."""
