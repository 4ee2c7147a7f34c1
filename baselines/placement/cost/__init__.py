"""What a layout is judged by: traces of Riccati solutions, reach, damping."""
