"""What ``beamenv tune`` tries of each trainer's settings, as TOML files of the trainers' names."""
