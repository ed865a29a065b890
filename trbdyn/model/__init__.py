"""What is simulated: bearing, pockets, oil, effects, loads in time, and the scene that joins them; its numbers for the core."""
