"""A controller by its name: one file each, trained policies, models, and those that ship."""
