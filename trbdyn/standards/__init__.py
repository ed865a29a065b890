"""The engineer's sheet: equivalent load, rating lives, static safety, viscosity ratio (docs/theory/ratings.md)."""
