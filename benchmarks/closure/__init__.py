"""Energy closures over a grid of operating points."""
