"""How fast blades step: beside CartPole on this machine, as ``beamenv speed`` has it; on a device: ``python -m train.speed``."""
