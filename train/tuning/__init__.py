"""The settings of a recipe, searched for on validation seeds."""
