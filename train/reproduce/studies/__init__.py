"""The studies, a chapter of the thesis at a time."""
