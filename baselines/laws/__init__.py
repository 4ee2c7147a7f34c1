"""The control laws, one a file."""
