"""Speed measurements and the moving picture of the README."""
