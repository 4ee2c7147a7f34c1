"""What figures consist of, and how they are drawn on paper and on the screen."""
