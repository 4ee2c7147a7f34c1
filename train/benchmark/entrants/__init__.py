"""Who takes part, and where a controller comes from."""
