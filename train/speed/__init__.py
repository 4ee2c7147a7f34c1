"""How fast batches of tensors step on a device: ``python -m train.speed --device cuda``."""
