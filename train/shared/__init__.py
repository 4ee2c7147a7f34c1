"""What every room needs: files, versions."""
