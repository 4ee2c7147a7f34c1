"""A model from a measurement: voltages and sensor readings in, a state-space model with its noise and its spread out."""
