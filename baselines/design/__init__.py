"""What laws are built with: the controller itself, Riccati equations, models of loads, box-constrained programs."""
