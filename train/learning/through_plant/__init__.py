"""Policies trained by back-propagation through the plant."""
