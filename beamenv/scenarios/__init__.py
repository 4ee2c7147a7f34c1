"""What may happen to a blade in an episode."""
