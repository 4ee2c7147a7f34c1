"""A controller by its name: contenders, trained policies, those that ship."""
