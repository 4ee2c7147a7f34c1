"""What acts on a blade and on its sensors: loads, noise, faults, hysteresis."""
