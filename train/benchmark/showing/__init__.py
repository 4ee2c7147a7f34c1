"""The table as files, pictures and pages."""
