"""Recipes as TOML files: their names are those of the files."""
