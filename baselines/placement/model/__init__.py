"""The reduced plant as a function of where the patches are."""
