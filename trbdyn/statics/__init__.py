"""What a scene tells before any step: equilibrium of ring and rollers, path of the ring, state at the start, creep."""
