"""Pictures of the README and the pages, and how large returns are: what is made once and kept."""
